#include "common/importers/landmarks.h"

#include <cmath>

#include <fmt/format.h>

#include "common/importers/import_options.h"
#include "common/importers/json_values.h"
#include "common/importers/uniform_clock.h"

namespace chorus::importers {
namespace {

constexpr int kMaxHz = 1000;

/// Reads 33 arrays of three numbers each.
Result<void> read_triples(const nlohmann::json& array, double bound, const std::string& at,
                          std::array<std::array<double, 3>, kLandmarkCount>& out) {
  if (!array.is_array() || array.size() != kLandmarkCount)
    return fail(ErrorCode::Malformed, at, fmt::format("must hold {} landmarks.", kLandmarkCount));
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const auto read = read_numbers(array[i], out[i], bound, fmt::format("{}[{}]", at, i));
    if (!read) return pass(read);
  }
  return {};
}

Result<DetectedLandmarks> read_detected(const nlohmann::json& image, const nlohmann::json& world,
                                        const std::string& at) {
  std::array<std::array<double, 3>, kLandmarkCount> seen{};
  std::array<std::array<double, 3>, kLandmarkCount> metres{};
  if (const auto read = read_triples(image, kMaxPixel, at + ".image", seen); !read)
    return pass(read);
  if (const auto read = read_triples(world, kMaxImported, at + ".world", metres); !read)
    return pass(read);
  DetectedLandmarks detected;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    detected.pixel[i] = {seen[i][0], seen[i][1]};
    detected.visibility[i] = seen[i][2];
    detected.in_body[i] = {metres[i][0], metres[i][1], metres[i][2]};
  }
  return detected;
}

/// The time of a frame.  The files round t_s to microseconds; if t_s is within 2 us of the instant
/// of a whole frame, that instant is used.
Duration frame_time(double t_s, int hz) {
  constexpr double kRounding = 2e-6;
  const double index = std::round(t_s * hz);
  if (std::abs(t_s - index / hz) > kRounding) return from_seconds(t_s);
  return uniform_instant(Timestamp{}, static_cast<std::size_t>(index), hz) - Timestamp{};
}

Result<LandmarkFrame> read_landmark_frame(const nlohmann::json& frame, int hz,
                                          const std::string& at) {
  const auto time = member(frame, "t_s", at);
  if (!time) return pass(time);
  if (!(*time)->is_number() || !((*time)->get<double>() >= 0.0) ||
      (*time)->get<double>() > kMaxSeconds)
    return fail(ErrorCode::Malformed, at, "\"t_s\" must be seconds since the start, 0 or more.");
  LandmarkFrame out{frame_time((*time)->get<double>(), hz), std::nullopt};
  const auto image = member(frame, "image", at);
  if (!image) return pass(image);
  if ((*image)->is_null() || (*image)->empty()) return out;
  const auto world = member(frame, "world", at);
  if (!world) return pass(world);
  const auto detected = read_detected(**image, **world, at);
  if (!detected) return pass(detected);
  out.detected = *detected;
  return out;
}

Result<int> read_rate(const nlohmann::json& document, const std::string& at) {
  const auto fps = member(document, "fps", at);
  if (!fps) return pass(fps);
  if (!(*fps)->is_number_integer() || *(*fps) < 1 || *(*fps) > kMaxHz)
    return fail(ErrorCode::Malformed, at, fmt::format("\"fps\" must be 1 to {}.", kMaxHz));
  return (*fps)->get<int>();
}

}  // namespace

Result<LandmarkView> read_landmark_view(const std::filesystem::path& file,
                                        const ImportLimits& limits) {
  const std::string at = file.string();
  const auto document = read_json(file, limits.max_json_bytes);
  if (!document) return pass(document);
  const auto camera = member(*document, "camera", at);
  if (!camera) return pass(camera);
  const auto hz = read_rate(*document, at);
  if (!hz) return pass(hz);
  const auto frames = member(*document, "frames", at);
  if (!frames) return pass(frames);
  if (!(*camera)->is_string() || !(*frames)->is_array() || (*frames)->empty())
    return fail(ErrorCode::Malformed, at, "needs \"camera\", a name, and \"frames\", an array.");
  LandmarkView view{(*camera)->get<std::string>(), {}};
  for (std::size_t i = 0; i < (*frames)->size(); ++i) {
    const auto frame =
        read_landmark_frame((**frames)[i], *hz, fmt::format("{}: frames[{}]", at, i));
    if (!frame) return pass(frame);
    if (!view.frames.empty() && frame->at <= view.frames.back().at)
      return fail(ErrorCode::Malformed, fmt::format("{}: frames[{}]", at, i),
                  "\"t_s\" must grow from frame to frame.");
    view.frames.push_back(*frame);
  }
  return view;
}

}  // namespace chorus::importers
