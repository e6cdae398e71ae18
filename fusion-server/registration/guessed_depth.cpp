#include "fusion-server/registration/guessed_depth.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace chorus::registration {
namespace {

constexpr double kGuessedShare = 0.04;      // of the distance; depth sensors state less than 2 %
constexpr double kGuessedRatio = 3.0;       // along to across; of depth sensors at most 2
constexpr std::size_t kEnoughVotes = 2000;  // joints; the frames of one sensor are alike

// From the two real takes of docs/benchmarks/registration.md, which name what they do not show.
constexpr double kGuessedAlong = 20.0;
constexpr double kCameraBias = mm(12);  // of joints that a network finds in pictures
// As in tests/data/pose2sim_mediapipe/fusion.json, which gives the reasons.
constexpr double kCameraRms = 0.5;        // [m]
constexpr double kCameraSpeed = 10.0;     // [m/s]
constexpr double kCameraDistance = 12.0;  // [m] pictures show people as far as that
constexpr double kCameraPosition = 2.0;   // [m] 95 %, of a whole room

bool guessed(const Joint& joint) {
  const double range = joint.position.norm();
  if (!joint.covariance.known() || !(range > 0.0)) return false;
  const Eigen::Vector3d ray = joint.position / range;
  const Eigen::Matrix3d error = joint.covariance.matrix();
  const double along = ray.dot(error * ray);
  const double across = 0.5 * (error.trace() - along);
  return along >= std::pow(kGuessedShare * range, 2) &&
         along >= kGuessedRatio * kGuessedRatio * across;
}

bool saw_somebody(const WalkTrack& track) {
  return std::ranges::any_of(track.frames,
                             [](const SensorFrame& frame) { return !frame.bodies.empty(); });
}

}  // namespace

bool guesses_depth(const WalkTrack& track) {
  std::size_t votes = 0;
  std::size_t guesses = 0;
  for (const SensorFrame& frame : track.frames) {
    for (const BodyFrame& body : frame.bodies) {
      for (const Joint& joint : body.skeleton.joints) {
        if (!joint.seen()) continue;
        ++votes;
        guesses += guessed(joint) ? 1 : 0;
      }
    }
    if (votes >= kEnoughVotes) break;
  }
  return 2 * guesses > votes;
}

RegistrationConfig suited_to(const std::vector<WalkTrack>& walk, const RegistrationConfig& config) {
  const auto measures = [](const WalkTrack& track) {
    return saw_somebody(track) && !guesses_depth(track);
  };
  const bool nobody = std::ranges::none_of(walk, saw_somebody);
  if (nobody || config.method != PairMethod::TimedRobust || std::ranges::any_of(walk, measures))
    return config;
  RegistrationConfig suited = config;
  // What somebody has chosen stays.
  if (config.along_ratio == RegistrationConfig{}.along_ratio) suited.along_ratio = kGuessedAlong;
  suited.view_bias = std::max(config.view_bias, kCameraBias);
  if (config.joints == JointChoice::Core) suited.joints = JointChoice::All;
  suited.min_spread = 0.0;
  suited.max_edge_rms = std::max(config.max_edge_rms, kCameraRms);
  suited.max_speed = std::max(config.max_speed, kCameraSpeed);
  suited.max_distance = std::max(config.max_distance, kCameraDistance);
  suited.max_position = std::max(config.max_position, kCameraPosition);
  return suited;
}

}  // namespace chorus::registration
