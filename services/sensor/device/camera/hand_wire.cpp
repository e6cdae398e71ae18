#include "services/sensor/device/camera/hand_wire.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "services/sensor/device/bridge/json_value.h"

namespace chorus::camera {
namespace {

using bridge::At;
using nlohmann::json;

constexpr JsonLimits kHandLimits{.bytes = 256 * 1024, .nesting = 6};
constexpr std::size_t kMostHands = 16;
constexpr bridge::Bounds kHandSides{16.0, 4096.0};
constexpr bridge::Bounds kShare{0.0, 1.0};
constexpr bridge::Bounds kPlace{-bridge::kMaxPixels, bridge::kMaxPixels};

Result<json> message_of(std::string_view line, const char* type) {
  auto message = parse_json(line, kHandLimits);
  constexpr std::size_t kShown = 60;
  if (!message)
    return fail(message.error().code, "the runner",
                fmt::format("{}; its line begins with \"{}\"", to_string(message.error()),
                            line.substr(0, kShown)));
  const json* kind = message->is_object() ? bridge::find(*message, "type") : nullptr;
  if (kind == nullptr || *kind != json(type))
    return fail(ErrorCode::Malformed, "type",
                fmt::format("must be \"{}\" here (proto/runner.md)", type));
  return message;
}

Result<double> share_at(const json& hand, const char* key, const At& at) {
  const json* value = bridge::find(hand, key);
  if (value == nullptr) return bridge::wrong(at[key], "a number from 0 to 1");
  const At place = at[key];
  return bridge::read_number(*value, kShare, place);
}

/// A place has two numbers, or three: the third is a depth, which is not used.
Result<hand::Pixel> read_place(const json& value, const At& at) {
  if (!value.is_array() || value.size() < 2 || value.size() > 3)
    return bridge::wrong(at, "two numbers, or three");
  hand::Pixel out;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto number = bridge::read_number(value[i], kPlace, at);
    if (!number) return pass(number);
    out[static_cast<Eigen::Index>(i)] = *number;
  }
  return out;
}

Result<hand::SeenHand> read_hand(const json& value, const At& at) {
  if (!value.is_object()) return bridge::wrong(at, "an object");
  hand::SeenHand out;
  const auto score = share_at(value, "score", at), side_score = share_at(value, "sideScore", at);
  if (!score) return pass(score);
  if (!side_score) return pass(side_score);
  out.score = *score;
  out.side_score = *side_score;
  const json* side = bridge::find(value, "side");
  if (side == nullptr || (*side != json("left") && *side != json("right")))
    return bridge::wrong(at["side"], "\"left\" or \"right\"");
  out.side = *side == json("left") ? hand::Side::Left : hand::Side::Right;
  const json* pixels = bridge::find(value, "pixels");
  const At places = at["pixels"];
  if (pixels == nullptr || !pixels->is_array() || pixels->size() != hand::kHandJoints)
    return bridge::wrong(places, "21 places, in the order of hand_21");
  for (std::size_t i = 0; i < hand::kHandJoints; ++i) {
    const auto place = read_place((*pixels)[i], places[i]);
    if (!place) return pass(place);
    out.joints[i] = *place;
  }
  return out;
}

}  // namespace

Result<HandRunnerHello> read_hand_hello(std::string_view line) {
  const auto message = message_of(line, "hello");
  if (!message) return pass(message);
  const json* gives = bridge::find(*message, "gives");
  const bool hands = gives != nullptr && gives->is_array() &&
                     std::ranges::find(*gives, json("hands")) != gives->end();
  if (!hands)
    return fail(
        ErrorCode::Unsupported, "gives",
        "lacks \"hands\": this runner finds people only; the one that comes with Chorus finds "
        "hands with --model hands");
  HandRunnerHello out;
  if (const json* name = bridge::find(*message, "name"); name != nullptr && name->is_string())
    out.name = name->get<std::string>();
  const json* image = bridge::find(*message, "image");
  const json* side =
      image != nullptr && image->is_object() ? bridge::find(*image, "maxSide") : nullptr;
  if (side == nullptr) return out;
  const At at = At{}["image"];
  const auto number = bridge::read_number(*side, kHandSides, at["maxSide"]);
  if (!number) return pass(number);
  out.max_side = static_cast<int>(*number);
  return out;
}

Result<std::vector<hand::SeenHand>> read_hand_answer(std::string_view line,
                                                     const Question& question) {
  const auto message = message_of(line, "frame");
  if (!message) return pass(message);
  const json* sequence = bridge::find(*message, "sequence");
  if (sequence == nullptr || *sequence != json(question.sequence))
    return fail(ErrorCode::Conflict, "sequence",
                fmt::format("must be {}, that of the image", question.sequence));
  const json* hands = bridge::find(*message, "hands");
  const At at = At{}["hands"];
  if (hands == nullptr || !hands->is_array() || hands->size() > kMostHands)
    return bridge::wrong(at, fmt::format("a list of at most {} hands", kMostHands));
  std::vector<hand::SeenHand> out;
  for (std::size_t i = 0; i < hands->size(); ++i) {
    auto one = read_hand((*hands)[i], at[i]);
    if (!one) return pass(one);
    out.push_back(std::move(*one));
  }
  return out;
}

}  // namespace chorus::camera
