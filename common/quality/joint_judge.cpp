#include "common/quality/joint_judge.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace chorus::quality {
namespace {

constexpr double kSlow = 0.1;  // [m/s]; who stands, sways by less
/// [m] off uniform motion in one step of a thirtieth of a second: 90 m/s^2.  The fastest hands of
/// captured throws reach some 40 m/s^2.
constexpr double kJump = 0.1;
constexpr double kLongestStep = 0.1;  // [s] between frames that are compared

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

double root_mean(double squares, std::size_t count) {
  if (count == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::sqrt(squares / static_cast<double>(count));
}

}  // namespace

JointQuality JointCounts::quality() const {
  JointQuality out;
  out.tracked = ratio(tracked, present);
  out.inferred = ratio(inferred, present);
  out.missing = ratio(missing, present);
  out.unseen = ratio(unseen, present);
  out.carried = ratio(carried, present);
  out.gaps = gaps;
  out.longest_gap = longest_gap;
  out.longest_gap_at = longest_gap_at;
  out.sensors = ratio(contributors, tracked);
  out.jitter_at_rest = root_mean(rest_squares, rest);
  out.jitter_in_motion = root_mean(motion_squares, motion);
  out.jumps = jumps;
  out.first_jump_at = first_jump_at;
  out.stated = root_mean(stated_squares, stated);
  return out;
}

void JointJudge::add(const resource::JointResource& joint, double at, bool carried,
                     JointCounts& counts) {
  ++counts.present;
  const bool seen = joint.seen();
  gap(!seen, at, counts);
  if (carried) {
    ++counts.carried;
  } else if (!seen) {
    ++counts.missing;
  } else if (joint.state == JointState::Inferred) {
    ++counts.inferred;
  } else {
    ++counts.tracked;
    counts.contributors += static_cast<std::size_t>(std::popcount(joint.contributors));
  }
  if (!seen) return places_.clear();
  if (!carried && joint.contributors == 0) ++counts.unseen;
  const double variance = joint.covariance.known() ? joint.covariance.matrix().trace() / 3.0
                                                   : joint.variance.value_or(0.0);
  if (variance > 0.0 && !carried) {
    counts.stated_squares += variance;
    ++counts.stated;
  }
  if (!places_.empty() && at - places_.back().at > kLongestStep) places_.clear();
  places_.push_back({at, joint.position});
  if (places_.size() > 4) places_.erase(places_.begin());
  motion(counts);
}

void JointJudge::gap(bool missing, double at, JointCounts& counts) {
  if (missing && !missing_) {
    missing_since_ = at;
    ++counts.gaps;
  }
  missing_ = missing;
  if (missing && at - missing_since_ > counts.longest_gap) {
    counts.longest_gap = at - missing_since_;
    counts.longest_gap_at = missing_since_;
  }
}

// The second difference of white noise has six times its variance, the third one twenty times.
void JointJudge::motion(JointCounts& counts) {
  if (places_.size() < 3) return;
  const auto back = [&](std::size_t n) -> const Place& { return places_[places_.size() - 1 - n]; };
  const double step = back(0).at - back(1).at;
  const double before = back(1).at - back(2).at;
  if (!(step > 0.0 && before > 0.0)) return;
  const Eigen::Vector3d velocity = (back(1).x_in_world - back(2).x_in_world) / before;
  const Eigen::Vector3d off = back(0).x_in_world - back(1).x_in_world - velocity * step;
  if (off.norm() > kJump * std::max(1.0, 30.0 * step)) {
    if (++counts.jumps == 1) counts.first_jump_at = back(0).at;
    places_.erase(places_.begin(), places_.end() - 1);  // the way back to uniform motion is no jump
    return;
  }
  const bool even = step < 1.5 * before && before < 1.5 * step;
  if (!even || off.norm() > kJump) return;
  if ((back(0).x_in_world - back(2).x_in_world).norm() / (step + before) < kSlow) {
    counts.rest_squares += off.squaredNorm() / 3.0 / 6.0;
    ++counts.rest;
  } else if (places_.size() == 4) {
    const Eigen::Vector3d third = back(0).x_in_world - 3.0 * back(1).x_in_world +
                                  3.0 * back(2).x_in_world - back(3).x_in_world;
    counts.motion_squares += third.squaredNorm() / 3.0 / 20.0;
    ++counts.motion;
  }
}

}  // namespace chorus::quality
