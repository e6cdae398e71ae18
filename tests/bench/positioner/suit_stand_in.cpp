#include "tests/bench/positioner/suit_stand_in.h"

#include <array>
#include <cmath>
#include <random>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::bench {
namespace {

using enum JointId;

/// A rotation error that wanders (Ornstein-Uhlenbeck).
class Wander {
 public:
  Wander(double sigma, double memory) : sigma_(sigma / std::sqrt(2.0)), memory_(memory) {}

  Eigen::Quaterniond next(double dt, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const double kept = begun_ ? std::exp(-dt / memory_) : 0.0;
    const double gained = sigma_ * std::sqrt(1.0 - kept * kept);
    for (int axis = 0; axis < 3; ++axis) at_[axis] = kept * at_[axis] + gained * normal(random);
    begun_ = true;
    return exp_map(at_);
  }

 private:
  double sigma_;
  double memory_;
  bool begun_ = false;
  Eigen::Vector3d at_ = Eigen::Vector3d::Zero();
};

/// The joint from which a joint hangs; a hip and a shoulder hang from the pelvis and the trunk, so
/// that both sides turn together.
struct Segment {
  JointId joint;
  JointId from;
  std::size_t wander;  ///< Which error turns it.
};
constexpr std::array kSegments{
    Segment{HipLeft, SpineBase, 0},        Segment{HipRight, SpineBase, 0},
    Segment{SpineMid, SpineBase, 1},       Segment{SpineShoulder, SpineBase, 1},
    Segment{Neck, SpineBase, 1},           Segment{Head, SpineBase, 1},
    Segment{ShoulderLeft, SpineBase, 1},   Segment{ShoulderRight, SpineBase, 1},
    Segment{ElbowLeft, ShoulderLeft, 2},   Segment{WristLeft, ElbowLeft, 3},
    Segment{ElbowRight, ShoulderRight, 4}, Segment{WristRight, ElbowRight, 5},
    Segment{KneeLeft, HipLeft, 6},         Segment{AnkleLeft, KneeLeft, 7},
    Segment{KneeRight, HipRight, 8},       Segment{AnkleRight, KneeRight, 9},
    Segment{FootLeft, AnkleLeft, 7},       Segment{FootRight, AnkleRight, 9}};
constexpr std::size_t kWanders = 10;

}  // namespace

suit::SuitTake suit_of(const std::vector<Skeleton<WorldSpace>>& truth, double rate_hz,
                       const SuitErrors& errors) {
  std::mt19937_64 random(errors.seed);
  std::vector<Wander> wanders(kWanders, Wander(errors.bone, errors.memory));
  suit::SuitTake take{rate_hz, {}, {}};
  for (std::size_t i = 0; i < truth.size(); ++i) {
    std::array<Eigen::Quaterniond, kWanders> turns;
    for (std::size_t w = 0; w < kWanders; ++w) turns[w] = wanders[w].next(1.0 / rate_hz, random);
    Skeleton<WorldSpace> body;
    body[SpineBase] = truth[i][SpineBase];
    for (const Segment& segment : kSegments) {
      const Joint& from = truth[i][segment.from];
      const Joint& to = truth[i][segment.joint];
      if (!from.seen() || !to.seen()) continue;
      body[segment.joint] = to;
      body[segment.joint].position =
          body[segment.from].position +
          errors.size * (turns[segment.wander] * (to.position - from.position));
    }
    const suit::SuitPose erring =
        suit::pose_of(body, from_seconds(static_cast<double>(i) / rate_hz));
    suit::SuitPose turned =
        suit::pose_of(suit::placed(erring, -errors.heading, {0, 0, 0}), erring.time);
    take.poses.push_back(turned);
    take.claimed.push_back(truth[i][SpineBase].position);
  }
  return take;
}

}  // namespace chorus::bench
