// The bundled real recording: four synchronised cameras, one person balancing on a beam for 1.67 s.
//
// A camera knows a joint's direction to 15-35 mm but its depth only to 0.1-0.3 m, and the published
// truth is the triangulation of the same landmarks.  So the small errors below mean that
// inverse-variance fusion reproduces the triangulation, not that it is accurate to a few
// millimetres.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "common/importers/formats.h"
#include "fusion-server/pipeline/offline.h"

namespace chorus::pipeline {
namespace {

using fusion::Method;
using registration::RegistrationConfig;
using registration::WalkTrack;

constexpr double kFrameRate = 60.0;
constexpr double kPlainMean = 0.104;        // [m] median joint error of the plain mean, data README
constexpr double kBestSingleCamera = 0.14;  // [m] the same of the best single camera

struct Recording {
  std::vector<WalkTrack> tracks;
  Registration published;
  std::vector<importers::TruthFrame> truth;
};

Recording load(bool rays = false) {
  Recording recording;
  importers::ImportOptions options;
  options.rays = rays;
  const auto set = importers::import_files(importers::FileFormat::Pose2Sim,
                                           {"tests/data/pose2sim_mediapipe"}, options);
  if (!set) return recording;
  for (const auto& view : set->recordings) recording.tracks.push_back({view.sensor, view.frames});
  for (const auto& [id, place] : set->world_from_sensor) {
    recording.published.sensors[id].world_from_sensor = place;
  }
  recording.truth = set->truth;
  return recording;
}

/// Settings for single cameras: inaccurate depth; bodies up to 1 m apart are one person.
OfflineConfig camera_config() {
  OfflineConfig config;
  config.rate_hz = kFrameRate;
  config.pipeline.fusion.noise = {.along = 0.25, .across = 0.03, .inferred_factor = 3.0};
  config.pipeline.association.gate = 1.0;
  config.pipeline.association.cluster = 1.0;
  return config;
}

RegistrationConfig camera_registration() {
  RegistrationConfig config;
  config.joints = registration::JointChoice::All;
  config.along_ratio = 8.0;
  config.use_floor = false;
  // The person balances on the spot, so the points spread only over the body.
  config.min_spread = 0.0;
  config.max_edge_rms = 0.5;  // depth differs by decimetres
  config.max_speed = 10.0;    // depth jitters at 60 Hz
  config.max_position = 1.5;  // as accurate as such cameras are
  return config;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_error(const std::vector<Snapshot>& snapshots, const Recording& recording) {
  std::vector<double> errors;
  for (const Snapshot& snapshot : snapshots) {
    const double at = seconds(snapshot.instant - importers::kDefaultStart) * kFrameRate;
    const auto index = static_cast<std::size_t>(std::lround(std::max(0.0, at)));
    if (index >= recording.truth.size()) continue;
    for (const FusedBody& body : snapshot.bodies) {
      for (std::size_t i = 0; i < kJointCount; ++i) {
        const Joint& found = body.skeleton.joints[i];
        const Joint& truth = recording.truth[index].skeleton.joints[i];
        if (found.seen() && truth.seen()) {
          errors.push_back((found.position - truth.position).norm());
        }
      }
    }
  }
  return median(std::move(errors));
}

TEST(FourRealCameras, WithPublishedExtrinsicsFusionBeatsTheMeanAndEverySingleCamera) {
  const Recording recording = load();
  ASSERT_EQ(recording.tracks.size(), 4u);
  OfflineConfig config = camera_config();
  for (const Method method :
       {Method::Otto, Method::Mean, Method::BestView, Method::InverseVariance}) {
    config.pipeline.fusion.method = method;
    const auto fused = fuse_offline(recording.tracks, recording.published, config);
    ASSERT_TRUE(fused) << fused.error().message;
    EXPECT_GE(fused->snapshots.size(), 99u);
    for (const Snapshot& snapshot : fused->snapshots) EXPECT_LE(snapshot.bodies.size(), 1u);
    const double error = median_error(fused->snapshots, recording);
    RecordProperty("median_mm_" + std::string(fusion::name_of(method)),
                   static_cast<int>(to_mm(error)));
    if (method != Method::InverseVariance) continue;
    EXPECT_LT(error, 0.3 * kPlainMean);
    EXPECT_LT(error, kBestSingleCamera);
  }
}

/// Fuses only the directions of the landmarks, without depth from perspective-n-point.
TEST(FourRealCameras, AsRaysFusionFindsTheTriangulationAndTwoCamerasAreEnough) {
  Recording recording = load(true);
  ASSERT_EQ(recording.tracks.size(), 4u);
  OfflineConfig config;
  config.rate_hz = kFrameRate;
  config.pipeline.fusion.method = Method::PointsAndRays;
  for (; recording.tracks.size() >= 2; recording.tracks.pop_back()) {
    const auto fused = fuse_offline(recording.tracks, recording.published, config);
    ASSERT_TRUE(fused) << fused.error().message;
    std::size_t with_one = 0;
    for (const Snapshot& snapshot : fused->snapshots) with_one += snapshot.bodies.size() == 1;
    const double error = median_error(fused->snapshots, recording);
    const auto cameras = std::to_string(recording.tracks.size());
    RecordProperty("median_mm_x10_of_" + cameras, static_cast<int>(to_mm(10.0 * error)));
    EXPECT_GE(with_one, 95u) << cameras << " cameras";
    EXPECT_LT(error, recording.tracks.size() == 4 ? 0.015 : 0.06) << cameras << " cameras";
  }
}

TEST(FourRealCameras, RegisterFromThePersonAlone) {
  const Recording recording = load();
  ASSERT_EQ(recording.tracks.size(), 4u);
  Registration found =
      registration::solve(recording.tracks, importers::kDefaultStart, camera_registration());
  EXPECT_EQ(found.verdict, Verdict::Provisional);
  ASSERT_EQ(found.sensors.size(), 4u) << ::testing::PrintToString(found.reasons);
  const auto& published = recording.published.sensors;
  const Eigen::Isometry3d published_from_found =
      published.at(found.master).world_from_sensor *
      found.sensors.at(found.master).world_from_sensor.inverse();
  for (const auto& [id, place] : found.sensors) {
    const Eigen::Isometry3d off = published.at(id).world_from_sensor.inverse() *
                                  published_from_found * place.world_from_sensor;
    const double angle =
        angular_distance(Eigen::Quaterniond(off.linear()), Eigen::Quaterniond::Identity());
    RecordProperty("position_mm_" + id.str(), static_cast<int>(to_mm(off.translation().norm())));
    RecordProperty("angle_deg_x10_" + id.str(), static_cast<int>(10.0 * to_deg(angle)));
    EXPECT_LT(off.translation().norm(), 0.45) << id.str();
    EXPECT_LT(angle, deg(6)) << id.str();
  }
}

TEST(FourRealCameras, AdjustingTogetherHelpsTheWorstCamera) {
  const Recording recording = load();
  ASSERT_EQ(recording.tracks.size(), 4u);
  const auto worst = [&](bool together) {
    RegistrationConfig config = camera_registration();
    config.adjust_together = together;
    const Registration found =
        registration::solve(recording.tracks, importers::kDefaultStart, config);
    const auto& published = recording.published.sensors;
    double most = 0.0;
    for (const auto& [id, place] : found.sensors) {
      const Eigen::Isometry3d off = published.at(id).world_from_sensor.inverse() *
                                    published.at(found.master).world_from_sensor *
                                    found.sensors.at(found.master).world_from_sensor.inverse() *
                                    place.world_from_sensor;
      most = std::max(most, off.translation().norm());
    }
    return most;
  };
  EXPECT_LT(worst(true), 0.6 * worst(false));
}

double between(const Registration& registration, const SensorId& a, const SensorId& b) {
  return (registration.sensors.at(a).world_from_sensor.translation() -
          registration.sensors.at(b).world_from_sensor.translation())
      .norm();
}

/// Median length of the left thigh [m].
double thigh(const std::vector<Snapshot>& snapshots) {
  std::vector<double> lengths;
  for (const Snapshot& snapshot : snapshots) {
    for (const FusedBody& body : snapshot.bodies)
      lengths.push_back(
          (body.skeleton[JointId::HipLeft].position - body.skeleton[JointId::KneeLeft].position)
              .norm());
  }
  return median(std::move(lengths));
}

TEST(FourRealCameras, OneMeasuredDistanceScalesPlacesAndPeopleWithNothingElseConfigured) {
  const Recording recording = load();
  ASSERT_EQ(recording.tracks.size(), 4u);
  OfflineConfig config;
  config.rate_hz = kFrameRate;
  const auto unknown = fuse_offline(recording.tracks, std::nullopt, config);
  ASSERT_TRUE(unknown) << unknown.error().message;
  EXPECT_EQ(unknown->registration.verdict, Verdict::Provisional);
  EXPECT_THAT(unknown->registration.reasons,
              ::testing::Contains(::testing::HasSubstr("scale unknown")));

  const SensorId a = recording.tracks[0].sensor;
  const SensorId b = recording.tracks[2].sensor;
  const double apart = between(recording.published, a, b);
  config.registration.known_distances = {{a, b, apart}};
  const auto known = fuse_offline(recording.tracks, std::nullopt, config);
  ASSERT_TRUE(known) << known.error().message;
  EXPECT_NEAR(between(known->registration, a, b), apart, 1e-6);
  const double scale = known->registration.sensors.at(a).scale;
  EXPECT_NEAR(scale, apart / between(unknown->registration, a, b), 1e-6);
  EXPECT_NEAR(thigh(known->snapshots) / thigh(unknown->snapshots), scale, 0.005);
}

}  // namespace
}  // namespace chorus::pipeline
