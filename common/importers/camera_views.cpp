#include "common/importers/camera_views.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "common/importers/json_values.h"
#include "common/layout/tables.h"

namespace chorus::importers {
namespace {

/// How a body is made from landmarks: of rays only, or of fitted points.
struct Form {
  bool rays;
  Lateral lateral;
};

/// The bodies of one frame; none when nobody was detected.  `unfitted` counts detections that fit
/// no body.
std::vector<BodyFrame> bodies_of(const LandmarkFrame& frame, Timestamp captured,
                                 const Intrinsics& intrinsics, const Form& form,
                                 std::size_t& unfitted) {
  if (!frame.detected) return {};
  const auto landmarks = form.rays ? Result<Landmarks>(landmark_rays(*frame.detected, intrinsics))
                                   : fit_landmarks(*frame.detected, intrinsics, form.lateral);
  if (!landmarks) {
    ++unfitted;
    return {};
  }
  BodyFrame body{kOnlyBody, captured, {layout::joints_of(layout::kMediapipe, *landmarks)}};
  const auto turn = fit_head(*frame.detected, intrinsics);
  if (turn) body.skeleton[JointId::Head].orientation = *turn;
  if (!form.rays) {
    for (Joint& joint : body.skeleton.joints) joint.covariance = fit_error(joint);
  }
  return {std::move(body)};
}

Result<Landmarks> read_truth_landmarks(const nlohmann::json& points, const std::string& at) {
  if (!points.is_array() || points.size() != kLandmarkCount)
    return fail(ErrorCode::Malformed, at, fmt::format("must hold {} landmarks.", kLandmarkCount));
  Landmarks landmarks;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    if (points[i].is_null()) continue;  // Too few cameras saw the landmark.
    std::array<double, 3> x{};
    const auto read = read_numbers(points[i], x, kMaxImported, fmt::format("{}[{}]", at, i));
    if (!read) return pass(read);
    landmarks[i] = {world_from_z_up() * Eigen::Vector3d(x[0], x[1], x[2]), JointState::Tracked};
  }
  return landmarks;
}

record::FrameRecording header_of(const std::filesystem::path& file, const CalibratedCamera& camera,
                                 const ImportOptions& options) {
  record::FrameRecording recording;
  recording.sensor = camera.sensor;
  recording.device = "camera with MediaPipe Pose landmarks";
  recording.intrinsics = camera.intrinsics;
  recording.floor = options.floor;
  recording.notes = {
      {"origin", file.filename().string()},
      {"time", fmt::format("seconds in the file count from its first frame; moved to {}",
                           to_iso8601(options.start))},
      {"space", options.rays
                    ? "rays of the landmarks' pixels; no depth"
                    : "perspective-n-point of 33 landmarks, lateral place from each landmark's "
                      "pixel; depth is as good as the detector's guess of the person's size"}};
  return recording;
}

}  // namespace

Result<record::FrameRecording> read_camera_view(const std::filesystem::path& file,
                                                const std::vector<CalibratedCamera>& cameras,
                                                const ImportOptions& options, Lateral lateral) {
  const auto view = read_landmark_view(file, options.limits);
  if (!view) return pass(view);
  const auto camera = std::find_if(cameras.begin(), cameras.end(), [&](const CalibratedCamera& c) {
    return c.sensor.str() == view->camera;
  });
  if (camera == cameras.end())
    return fail(ErrorCode::NotFound, file.string(),
                fmt::format("cameras.json has no camera \"{}\".", view->camera));
  record::FrameRecording recording = header_of(file, *camera, options);
  std::size_t unfitted = 0;
  for (const LandmarkFrame& frame : view->frames) {
    const Timestamp captured = options.start + frame.at;
    recording.frames.push_back(
        {recording.sensor, recording.frames.size() + 1, captured, captured,
         bodies_of(frame, captured, camera->intrinsics, {options.rays, lateral}, unfitted),
         options.floor});
  }
  if (unfitted > 0)
    recording.notes["unfitted"] = fmt::format("{} frames fit no body and have none", unfitted);
  return recording;
}

Result<std::vector<TruthFrame>> read_triangulation(const std::filesystem::path& file,
                                                   const ImportLimits& limits) {
  const auto document = read_json(file, limits.max_json_bytes);
  if (!document) return pass(document);
  const auto frames = member(*document, "frames", file.string());
  if (!frames) return pass(frames);
  if (!(*frames)->is_array())
    return fail(ErrorCode::Malformed, file.string(), "\"frames\" must be an array.");
  std::vector<TruthFrame> truth;
  for (std::size_t i = 0; i < (*frames)->size(); ++i) {
    const std::string at = fmt::format("{}: frames[{}]", file.string(), i);
    const auto landmarks = read_truth_landmarks((**frames)[i], at);
    if (!landmarks) return pass(landmarks);
    truth.push_back({i, {layout::joints_of(layout::kMediapipe, *landmarks)}});
  }
  return truth;
}

}  // namespace chorus::importers
