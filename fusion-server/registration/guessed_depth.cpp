#include "fusion-server/registration/guessed_depth.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/body/guessed_depth.h"
#include "fusion-server/registration/ray_points.h"

namespace chorus::registration {
namespace {

constexpr std::size_t kEnoughVotes = 2000;  // joints; the frames of one sensor are alike

// From the two real takes in docs/benchmarks/registration.md, which also says what they do not
// show.
constexpr double kGuessedAlong = 20.0;
constexpr double kCameraBias = mm(12);  // of joints that a network finds in pictures
// As in tests/data/pose2sim_mediapipe/fusion.json, which gives the reasons.
constexpr double kCameraRms = 0.5;        // [m]
constexpr double kCameraSpeed = 10.0;     // [m/s]
constexpr double kCameraDistance = 12.0;  // [m] pictures show people as far as that
// [m] 95 %.  With a larger radius two cameras would show one person at two places, and a place
// would be called provisional that is only a direction.
constexpr double kCameraPosition = 0.5;
// [m] 95 %: a typical error of 60 mm, no more than joints of real cameras err by where places are
// known (docs/benchmarks/camera.md).
constexpr double kCameraGood = 0.15;
// Networks on small computers find people 8 to 30 times a second.
constexpr Duration kCameraGap = std::chrono::milliseconds(200);
constexpr const char* kWithoutDepth =
    " sends directions without depth, which this method does not place: state where it stands in "
    "registration.file";

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
        guesses += has_guessed_depth(joint, Eigen::Vector3d::Zero()) ? 1 : 0;
      }
    }
    if (votes >= kEnoughVotes) break;
  }
  return 2 * guesses > votes;
}

RegistrationConfig suited_to(const std::vector<WalkTrack>& walk, const RegistrationConfig& config) {
  const auto measures = [](const WalkTrack& track) {
    return saw_somebody(track) && !sends_rays_alone(track) && !guesses_depth(track);
  };
  const bool nobody = std::ranges::none_of(walk, saw_somebody);
  if (nobody || config.method != PairMethod::TimedRobust || std::ranges::any_of(walk, measures))
    return config;
  RegistrationConfig suited = config;
  // What somebody has chosen stays.
  if (config.along_ratio == RegistrationConfig{}.along_ratio) suited.along_ratio = kGuessedAlong;
  // Their scale, which is unknown, and a depth bias cannot be told apart.
  suited.depth_bias = suited.depth_bias_sigma = 0.0;
  suited.find_large_bias = false;
  suited.view_bias = std::max(config.view_bias, kCameraBias);
  if (config.joints == JointChoice::Core) suited.joints = JointChoice::All;
  suited.min_spread = 0.0;
  suited.max_edge_rms = std::max(config.max_edge_rms, kCameraRms);
  suited.max_speed = std::max(config.max_speed, kCameraSpeed);
  suited.max_distance = std::max(config.max_distance, kCameraDistance);
  suited.max_position = std::max(config.max_position, kCameraPosition);
  suited.good_position = std::max(config.good_position, kCameraGood);
  suited.cameras_alone = true;
  suited.max_gap = std::max(config.max_gap, kCameraGap);
  return suited;
}

bool nothing_to_solve(const std::vector<WalkTrack>& walk, Registration& result) {
  const auto silent = [](const WalkTrack& track) { return track.frames.empty(); };
  if (std::ranges::all_of(walk, silent)) {
    result.reasons.emplace_back("no sensor has delivered a frame yet");
    return true;
  }
  bool others = false;
  for (const WalkTrack& track : walk) {
    if (!sends_rays_alone(track)) {
      others = others || saw_somebody(track);
      continue;
    }
    const std::string reason =
        track.objection.empty() ? "sensor " + track.sensor.str() + kWithoutDepth : track.objection;
    result.verdicts[track.sensor] = {Verdict::Refused, {reason}};
    if (std::ranges::find(result.reasons, reason) == result.reasons.end())
      result.reasons.push_back(reason);
  }
  const bool in_vain = !others && !result.reasons.empty();
  if (in_vain) result.verdict = Verdict::Refused;
  return in_vain;
}

}  // namespace chorus::registration
