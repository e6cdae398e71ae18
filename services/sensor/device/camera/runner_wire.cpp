#include "services/sensor/device/camera/runner_wire.h"

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
  RunnerHello out{std::move(*hello), *side};
  out.hello.camera.reset();
  if (!out.hello.pixel_sigma) out.hello.pixel_sigma = kSigmaShare * *side;
  return out;
}

std::string image_header(const Question& question) {
  const auto& [width, height] = question.size;
  return fmt::format(
      "{{\"type\":\"image\",\"sequence\":{},\"captured\":\"{}\",\"width\":{},"
      "\"height\":{},\"format\":\"rgb24\",\"bytes\":{}}}\n",
      question.sequence, to_unix_ns(question.captured), width, height, 3L * width * height);
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

}  // namespace chorus::camera
