#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/importers/landmark_fit.h"
#include "common/importers/landmarks.h"
#include "common/layout/tables.h"
#include "common/sensor/body_placer.h"
#include "common/sensor/pixel_ray.h"
#include "tests/bench/camera/four_views.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using importers::kLandmarkCount;
using importers::Landmarks;

constexpr double kPixelSigma = 8.0;  // In pictures of 1080 x 1920.

struct Told {
  Skeleton<SensorSpace> rays;
  Skeleton<SensorSpace> shape;
};

/// What a runner would report for these landmarks.
Told told_by(const importers::DetectedLandmarks& detected, const Intrinsics& camera) {
  const Eigen::Matrix3d turn = importers::sensor_from_opencv();
  Landmarks rays = importers::landmark_rays(detected, camera);
  Landmarks shape;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    shape[i] = {turn * detected.in_body[i], rays[i].state};
    if (rays[i].state == JointState::NotTracked) continue;
    const Eigen::Matrix3d covariance = ray_covariance(turn * rays[i].position, camera, kPixelSigma);
    rays[i].covariance = Covariance(covariance).turned(turn);
  }
  return {{layout::joints_of(layout::kMediapipe, rays)},
          {layout::joints_of(layout::kMediapipe, shape)}};
}

/// How far people placed by one camera are off, along its rays.
struct Depths {
  std::vector<double> off;     ///< Of joints, without sign [m].
  std::vector<double> bodies;  ///< Of whole bodies, relative to the distance; with sign.
  double nees = 0.0;           ///< Sum over joints of squared errors over stated variances.

  void add(const Skeleton<SensorSpace>& placed, const Skeleton<SensorSpace>& truth);
  void report(Report& report, const std::string& name) const;
};

void Depths::add(const Skeleton<SensorSpace>& placed, const Skeleton<SensorSpace>& truth) {
  std::vector<double> shares;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!placed.joints[j].seen() || !truth.joints[j].seen()) continue;
    const double distance = truth.joints[j].position.norm();
    const Eigen::Vector3d ray = truth.joints[j].position / distance;
    const double along = ray.dot(placed.joints[j].position) - distance;
    off.push_back(std::abs(along));
    shares.push_back(along / distance);
    nees += along * along / ray.dot(placed.joints[j].covariance.matrix() * ray);
  }
  if (!shares.empty()) bodies.push_back(percentile(shares, 0.5));
}

void Depths::report(Report& report, const std::string& name) const {
  double mean = 0.0;
  double square = 0.0;
  for (const double one : bodies) mean += one / static_cast<double>(bodies.size());
  for (const double one : bodies)
    square += (one - mean) * (one - mean) / static_cast<double>(bodies.size());
  report.row(name, "along_median_mm", to_mm(percentile(off, 0.5)), "mm");
  report.row(name, "along_p90_mm", to_mm(percentile(off, 0.9)), "mm");
  report.row(name, "distance_off_percent", 100.0 * mean, "%");
  report.row(name, "distance_wanders_percent", 100.0 * std::sqrt(square), "%");
  report.row(name, "along_nees", nees / std::max(1.0, static_cast<double>(off.size())), "1");
}

/// The camera's frames, their rays turned into points.  `learned`: with bone lengths learned over
/// all pictures; otherwise each picture is placed on its own.
Result<std::vector<SensorFrame>> placed_frames(const record::FrameRecording& recording,
                                               bool learned) {
  const auto view =
      importers::read_landmark_view(fmt::format("{}/{}.json", kFourViews, recording.sensor.str()));
  if (!view) return pass(view);
  std::vector<SensorFrame> frames = recording.frames;
  BodyPlacer placer;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto& detected = view->frames.at(i).detected;
    if (!detected) continue;
    const Told told = told_by(*detected, *recording.intrinsics);
    frames[i].bodies.front().skeleton = told.rays;
    if (!learned) placer = {};
    placer.place(frames[i].bodies, std::vector{told.shape}, {});
  }
  return frames;
}

Result<std::vector<SensorFrame>> measure(Report& report, const record::FrameRecording& recording,
                                         const importers::ImportedSet& set, bool learned) {
  auto frames = placed_frames(recording, learned);
  if (!frames) return frames;
  const Eigen::Isometry3d sensor_from_world = set.world_from_sensor.at(recording.sensor).inverse();
  Depths depths;
  for (std::size_t i = 0; i < std::min(frames->size(), set.truth.size()); ++i) {
    const auto& bodies = (*frames)[i].bodies;
    if (!bodies.empty())
      depths.add(bodies.front().skeleton, to_sensor(sensor_from_world, set.truth[i].skeleton));
  }
  depths.report(
      report, fmt::format("distance-{}-{}", recording.sensor.str(), learned ? "learned" : "alone"));
  return frames;
}

}  // namespace

Result<void> placed_people(Report& report) {
  importers::ImportOptions options;
  options.rays = true;
  const auto set = importers::import_files(importers::FileFormat::Pose2Sim, {kFourViews}, options);
  if (!set) return pass(set);
  std::vector<registration::WalkTrack> points;
  std::vector<registration::WalkTrack> rays;
  for (const auto& recording : set->recordings) {
    if (auto alone = measure(report, recording, *set, false); !alone) return pass(alone);
    auto learned = measure(report, recording, *set, true);
    if (!learned) return pass(learned);
    points.push_back({recording.sensor, std::move(*learned)});
    rays.push_back({recording.sensor, recording.frames});
  }
  for (const std::size_t cameras : {1u, 2u, 4u}) {
    const auto some = [&](const auto& tracks) {
      return std::vector(tracks.begin(), tracks.begin() + static_cast<std::ptrdiff_t>(cameras));
    };
    const auto placed = fused(some(points), *set);
    if (!placed) return pass(placed);
    placed->report(report, fmt::format("distance-fused-points-{}", cameras));
    if (cameras == 1) continue;
    const auto bearing = fused(some(rays), *set);
    if (!bearing) return pass(bearing);
    bearing->report(report, fmt::format("distance-fused-rays-{}", cameras));
  }
  report.note(
      "distance: MediaPipe's shapes placed on its landmarks, beside the published triangulation.  "
      "alone: each image on its own; learned: with bone lengths learned over the images.");
  return {};
}

}  // namespace chorus::bench
