#include "common/synthetic/performer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/body/interpolate.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"

namespace chorus::synthetic {
namespace {

constexpr double kTurnRound = 0.3;  // Time for slowing down, and for speeding up, at each end [s].
constexpr std::uint64_t kDrawGroupBuild = 211;
constexpr std::uint64_t kDrawStart = 212;

double length_of(const motion::Motion& motion) {
  return motion.frames.empty() ? 0.0
                               : static_cast<double>(motion.frames.size() - 1) / motion.rate_hz;
}

/// Position in the motion after the reversal at one end; a parabola smooths the reversal.
double rounded(double time, double round) {
  return time < round ? 0.5 * (time * time / round + round) : time;
}

/// Position in the motion [s] when it is played back and forth; `time` is in [0, 2 length).
double played(double time, double length) {
  if (!(length > 0.0)) return 0.0;
  const double round = std::min(kTurnRound, 0.5 * length);
  const double there = time <= length ? time : 2 * length - time;
  return there <= 0.5 * length ? rounded(there, round) : length - rounded(length - there, round);
}

/// A Catmull-Rom spline from p[1] to p[2]: at a frame, the velocity is the mean of the steps before
/// and after it.
Eigen::Vector3d spline(const std::array<Eigen::Vector3d, 4>& p, double s) {
  const Eigen::Vector3d leaving = 0.5 * (p[2] - p[0]);
  const Eigen::Vector3d arriving = 0.5 * (p[3] - p[1]);
  const double s2 = s * s;
  const double s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * p[1] + (s3 - 2 * s2 + s) * leaving + (3 * s2 - 2 * s3) * p[2] +
         (s3 - s2) * arriving;
}

Skeleton<WorldSpace> sampled(const motion::Motion& motion, double time) {
  const auto last = static_cast<std::ptrdiff_t>(motion.frames.size()) - 1;
  const double place = std::clamp(time * motion.rate_hz, 0.0, static_cast<double>(last));
  const auto before =
      std::min(static_cast<std::ptrdiff_t>(place), std::max<std::ptrdiff_t>(last - 1, 0));
  const double s = place - static_cast<double>(before);
  const auto frame = [&](std::ptrdiff_t offset) -> const Skeleton<WorldSpace>& {
    return motion
        .frames[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(before + offset, 0, last))];
  };
  Skeleton<WorldSpace> body = interpolate(frame(0), frame(1), s);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto at = [&](std::ptrdiff_t offset) { return frame(offset).joints[i].position; };
    body.joints[i].position = spline({at(-1), at(0), at(1), at(2)}, s);
  }
  return body;
}

}  // namespace

Performer::Performer(std::shared_ptr<const Performance> performance, const PerformerScript& script)
    : performance_(std::move(performance)), script_(script) {
  script_.body_scale = std::clamp(script_.body_scale, 0.5, 1.5);
  if (!performance_ || script_.role >= performance_->roles.size()) performance_ = nullptr;
  if (performance_) {
    loop_ = std::max(Duration{1}, from_seconds(2 * length_of(performance_->roles[script_.role])));
  }
}

Skeleton<WorldSpace> Performer::at(Duration since_epoch) const {
  if (!performance_) return {};
  Duration in_loop = (since_epoch % loop_ + script_.start % loop_) % loop_;
  if (in_loop < Duration::zero()) in_loop += loop_;
  const motion::Motion& role = performance_->roles[script_.role];
  Skeleton<WorldSpace> body = sampled(role, played(seconds(in_loop), length_of(role)));
  const Eigen::Quaterniond world_from_stage = about_y(script_.turn);
  const Eigen::Vector3d origin(script_.centre.x(), 0.0, script_.centre.y());
  for (Joint& joint : body.joints) {
    joint.position = origin + world_from_stage * (script_.body_scale * joint.position);
    if (is_unit(joint.orientation)) joint.orientation = world_from_stage * joint.orientation;
  }
  return body;
}

std::vector<Person> make_performers(std::shared_ptr<const Performance> performance,
                                    const WalkerScript& script, std::size_t count) {
  const std::size_t roles = std::max<std::size_t>(1, performance ? performance->roles.size() : 0);
  const std::size_t groups = (count + roles - 1) / roles;
  std::vector<Person> people;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t group = i / roles;
    PerformerScript own{i % roles, script.centre, 0.0, script.body_scale};
    if (groups > 1) {
      own.turn = 2 * std::numbers::pi * static_cast<double>(group) / static_cast<double>(groups);
      own.centre += script.reach * Eigen::Vector2d(std::sin(own.turn), std::cos(own.turn));
    }
    if (group > 0) {
      own.body_scale *=
          1.0 + Draw{script.seed, kDrawGroupBuild, group}.uniform(-kBuildSpread, kBuildSpread);
      const double share = Draw{script.seed, kDrawStart, group}.uniform();
      own.start = from_seconds(share * seconds(Performer(performance, own).loop()));
    }
    people.emplace_back([performer = Performer(performance, own)](Duration since_epoch) {
      return performer.at(since_epoch);
    });
  }
  return people;
}

}  // namespace chorus::synthetic
