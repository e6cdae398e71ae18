#include "tests/bench/model/table1.h"

#include <limits>
#include <vector>

#include "common/geometry/rotation.h"
#include "tests/bench/model/model_walks.h"

namespace chorus::bench {
namespace {

using namespace synthetic;
using registration::WalkTrack;

constexpr double kDistance = 2.5;   // sensor to the middle of the walk [m]
constexpr double kSlow = 0.5;       // "the user has to walk slowly" (5.2.4) [m/s]
constexpr double kWidestGap = 0.1;  // widest gap between frames that is interpolated [s]
constexpr auto kWalk = std::chrono::seconds(10);

SensorFrame between(const SensorFrame& before, const SensorFrame& after, Timestamp instant) {
  SensorFrame frame = before;
  frame.captured = instant;
  BodyFrame& body = frame.bodies.front();
  body.captured = instant;
  const double share =
      seconds(instant - before.captured) / seconds(after.captured - before.captured);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Eigen::Vector3d& end = after.bodies.front().skeleton.joints[i].position;
    Eigen::Vector3d& position = body.skeleton.joints[i].position;
    position += share * (end - position);
  }
  return frame;
}

bool brackets(const SensorFrame& before, const SensorFrame& after, Timestamp instant) {
  return before.captured <= instant && instant < after.captured &&
         seconds(after.captured - before.captured) <= kWidestGap && !before.bodies.empty() &&
         !after.bodies.empty();
}

Scene pair_scene(const TableOneSetting& setting, std::uint64_t walk) {
  Scene scene;
  scene.people = {stroller(walk, {0.0, 0.0}, kSlow)};
  const Eigen::Isometry3d first = stand_sensor({0, 1.2, -kDistance}, 0.0, deg(5));
  scene.world_from_sensor = {first, Eigen::Isometry3d(about_y(setting.angle)) * first};
  return scene;
}

/// Place of the second sensor according to one walk, seen from the first, levelled [m].
std::optional<Eigen::Vector2d> place_of(const kinect::Profile& profile,
                                        const TableOneSetting& setting, int run) {
  const Scene scene = pair_scene(setting, setting.seed * 1000 + static_cast<std::uint64_t>(run));
  // The sensors and their errors stay the same; only the walk and its time differ.
  const Timestamp begin = kSomeTime + std::chrono::minutes(run);
  std::vector<WalkTrack> tracks;
  for (std::size_t i = 0; i < 2; ++i) {
    const SensorId id = *SensorId::parse(i == 0 ? "s1" : "s2");
    tracks.push_back({id, kinect::record(scene, {id, i, profile, setting.seed, setting.seed, true},
                                         begin, begin + kWalk)});
  }
  if (setting.in_step) bring_in_step(tracks[0], tracks[1]);
  registration::RegistrationConfig config;
  config.method = registration::PairMethod::IcpOnly;
  config.joints = registration::JointChoice::Neck;
  const auto edge = register_pair(tracks[0], tracks[1], config);
  if (!edge) return std::nullopt;
  const Eigen::Vector3d place =
      scene.world_from_sensor[0].linear() * edge->target_from_source.translation();
  return Eigen::Vector2d(place.x(), place.z());
}

}  // namespace

void bring_in_step(WalkTrack& target, WalkTrack& source) {
  std::vector<SensorFrame> kept;
  std::vector<SensorFrame> matched;
  std::size_t at = 0;
  for (const SensorFrame& frame : target.frames) {
    while (at + 1 < source.frames.size() && source.frames[at + 1].captured <= frame.captured) ++at;
    if (at + 1 >= source.frames.size() || frame.bodies.empty()) continue;
    const SensorFrame& before = source.frames[at];
    const SensorFrame& after = source.frames[at + 1];
    if (!brackets(before, after, frame.captured)) continue;
    kept.push_back(frame);
    matched.push_back(between(before, after, frame.captured));
  }
  target.frames = std::move(kept);
  source.frames = std::move(matched);
}

double repeatability(const kinect::Profile& profile, const TableOneSetting& setting) {
  std::vector<Eigen::Vector2d> places;
  for (int run = 0; run < setting.runs; ++run) {
    if (const auto place = place_of(profile, setting, run)) places.push_back(*place);
  }
  if (places.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto count = static_cast<double>(places.size());
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const auto& place : places) centre += place / count;
  double sum = 0.0;
  for (const auto& place : places) sum += (place - centre).norm();
  return sum / count;
}

}  // namespace chorus::bench
