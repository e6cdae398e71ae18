#include "services/sensor/device/camera/runner_wire.h"

#include <algorithm>
#include <array>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "services/sensor/device/bridge/json_value.h"

namespace chorus::camera {
namespace {

using bridge::At;

constexpr JsonLimits kLineLimits{.bytes = 64 * 1024, .nesting = 4};
constexpr bridge::Bounds kSides{16.0, 4096.0};
// Standard deviation as a share of the longest side, if the runner states none.
constexpr double kSigmaShare = 0.01;

Result<int> read_max_side(std::string_view line) {
  const auto message = parse_json(line, kLineLimits);
  if (!message) return pass(message);
  const nlohmann::json* image = bridge::find(*message, "image");
  const nlohmann::json* side =
      image != nullptr && image->is_object() ? bridge::find(*image, "maxSide") : nullptr;
  if (side == nullptr) return RunnerHello{}.max_side;
  const At at = At{}["image"];
  return bridge::read_number(*side, kSides, at["maxSide"]).map([](double number) {
    return static_cast<int>(number);
  });
}

bool gives_masks(std::string_view line) {
  const auto message = parse_json(line, kLineLimits);
  const nlohmann::json* gives = message ? bridge::find(*message, "gives") : nullptr;
  return gives != nullptr && gives->is_array() &&
         std::find(gives->begin(), gives->end(), nlohmann::json("masks")) != gives->end();
}

Result<Size> read_mask_size(const nlohmann::json& mask, const At& at) {
  constexpr bridge::Bounds kCells{1.0, 1024.0};
  std::array<int, 2> out{};
  constexpr std::array kKeys{"width", "height"};
  for (std::size_t i = 0; i < kKeys.size(); ++i) {
    const nlohmann::json* value = bridge::find(mask, kKeys[i]);
    const At place = at[kKeys[i]];
    if (value == nullptr) return bridge::wrong(place, "a number of cells");
    const auto number = bridge::read_number(*value, kCells, place);
    if (!number) return pass(number);
    out[i] = static_cast<int>(*number);
  }
  return Size{out[0], out[1]};
}

tl::unexpected<Error> not_said(const char* wanted) {
  return fail(ErrorCode::Malformed, "type",
              fmt::format("must be \"{}\" here (proto/runner.md)", wanted));
}

}  // namespace

Result<RunnerHello> read_runner_hello(std::string_view line) {
  auto read = bridge::read_push_message(line, nullptr);
  if (!read) {
    constexpr std::size_t kShown = 60;
    return fail(read.error().code, "the runner's hello",
                fmt::format("{}; the first line is \"{}\" (proto/runner.md, section 1)",
                            to_string(read.error()), line.substr(0, kShown)));
  }
  auto* hello = std::get_if<bridge::Hello>(&*read);
  if (hello == nullptr) return not_said("hello");
  const auto side = read_max_side(line);
  if (!side) return pass(side);
  RunnerHello out{std::move(*hello), *side, gives_masks(line)};
  out.hello.camera.reset();
  if (!out.hello.pixel_sigma) out.hello.pixel_sigma = kSigmaShare * *side;
  return out;
}

std::string image_header(const Question& question) {
  const auto& [width, height] = question.size;
  return fmt::format(
      "{{\"type\":\"image\",\"sequence\":{},\"captured\":\"{}\",\"width\":{},"
      "\"height\":{},\"format\":\"rgb24\",\"bytes\":{}{}}}\n",
      question.sequence, to_unix_ns(question.captured), width, height, 3L * width * height,
      question.mask ? ",\"wants\":[\"mask\"]" : "");
}

Result<bridge::PushedFrame> read_runner_answer(std::string_view line, const Question& question,
                                               const bridge::Hello& hello) {
  auto read = bridge::read_push_message(line, &hello);
  if (!read) {
    constexpr std::size_t kShown = 40;
    const bool json = line.starts_with('{');
    return fail(read.error().code, "the runner's answer",
                fmt::format("{}; the line begins with \"{}\"{} (proto/runner.md, section 3)",
                            to_string(read.error()), line.substr(0, kShown),
                            json ? ""
                                 : ": its standard output is for answers alone, so print "
                                   "everything else to the standard error"));
  }
  auto* frame = std::get_if<bridge::PushedFrame>(&*read);
  if (frame == nullptr) return not_said("frame");
  if (frame->sequence != question.sequence || frame->captured != question.captured) {
    return fail(ErrorCode::Conflict, "sequence",
                fmt::format("must be {}, with the captured of that image: each image is answered "
                            "once, before the next",
                            question.sequence));
  }
  return std::move(*frame);
}

Result<std::optional<PersonMask>> read_runner_mask(std::string_view line) {
  constexpr JsonLimits kMaskLimits{.bytes = 256 * 1024, .nesting = 8};
  const auto message = parse_json(line, kMaskLimits);
  if (!message) return pass(message);
  const nlohmann::json* mask = message->is_object() ? bridge::find(*message, "mask") : nullptr;
  if (mask == nullptr) return std::optional<PersonMask>();
  const At top{};
  const At at = top["mask"];
  const nlohmann::json* runs = mask->is_object() ? bridge::find(*mask, "runs") : nullptr;
  if (runs == nullptr || !runs->is_array())
    return bridge::wrong(at, "an object with width, height and runs");
  const auto size = read_mask_size(*mask, at);
  if (!size) return pass(size);
  const std::size_t total =
      static_cast<std::size_t>(size->width) * static_cast<std::size_t>(size->height);
  PersonMask out{*size, {}};
  out.cells.reserve(total);
  for (std::size_t i = 0; i < runs->size(); ++i) {
    const auto length = bridge::read_whole((*runs)[i], at);
    if (!length) return pass(length);
    if (*length > total - out.cells.size())
      return bridge::wrong(at, "runs of width x height cells");
    out.cells.insert(out.cells.end(), *length, i % 2 == 0 ? 0 : 255);
  }
  if (out.cells.size() != total) return bridge::wrong(at, "runs of width x height cells");
  return std::optional(std::move(out));
}

}  // namespace chorus::camera
