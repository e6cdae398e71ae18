#include "common/synthetic/path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "common/synthetic/smoothstep.h"

namespace chorus::synthetic {
namespace {

// Plausible estimates without a measured source.
constexpr double kAcceleration = 1.2;   // Mean acceleration when starting and stopping [m/s^2].
constexpr double kTurnRate = deg(110);  // Mean rate when turning on the spot [rad/s].
constexpr double kTurnSettling = 0.3;   // Extra time of every turn [s].
// Amplitude of the strides when turning on the spot, relative to that of walking.
constexpr double kTurnStep = 0.35;
constexpr double kPauseShare = 0.35;   // Probability of a pause at a way-point of a random walk.
constexpr double kMinPause = 0.5;      // [s]
constexpr double kMaxPause = 3.0;      // [s]
constexpr double kRandomLoop = 240.0;  // Shortest loop of a random walk [s].
constexpr double kStandLoop = 60.0;    // Loop of somebody who stands still [s].
constexpr double kLinePause = 0.4;     // Pause at each end of a line, before turning [s].
// Shortest leg, as a share of the reach; shorter ones are drawn again, at most kRedraws times.
constexpr double kMinLegShare = 0.5;
constexpr double kMinAmplitude = 0.3;
constexpr double kMaxAmplitude = 1.4;
constexpr int kRedraws = 20;
constexpr double kTurnPause = 1.5;    // Pause between full turns [s].
constexpr int kStations = 3;          // A workplace has this many stations, side by side.
constexpr double kStationStep = 0.4;  // Distance between neighbouring stations [m].
constexpr int kReachesPerStation = 4;
constexpr double kReachTime = 0.7;  // Time that a hand needs each way [s].
// Limits of the time for which a hand stays at its target [s].
constexpr double kMinHold = 0.3;
constexpr double kMaxHold = 1.2;
constexpr double kAsideSpeed = 0.35;    // Mean speed when stepping aside [m/s].
constexpr double kReachForward = 0.42;  // Targets are this far in front of the body [m].
constexpr std::array kReachHeights{0.85, 1.10, 1.35, 1.60};  // [m]

constexpr std::uint64_t kDrawWander = 101;
constexpr std::uint64_t kDrawDirection = 102;
constexpr std::uint64_t kDrawReach = 103;

/// Integral of smoothstep() from 0 to x.
double smooth_way(double x) { return x * x * x * (1 - 0.5 * x); }

double heading_towards(const Eigen::Vector2d& way) { return std::atan2(way.x(), way.y()); }

}  // namespace

Path::Path(const PathScript& script) : script_(script) {
  script_.speed = std::clamp(script_.speed, 0.1, 2.0);
  const double recorded = script_.stride / script_.period;
  // Slower people take shorter strides, and fewer per second.
  amplitude_ = std::clamp(std::sqrt(script_.speed / recorded), kMinAmplitude, kMaxAmplitude);
  cadence_ = script_.speed / (amplitude_ * script_.stride);
  place_ = script_.centre;
  heading_ = Draw{script_.seed, kDrawDirection}.uniform(-std::numbers::pi, std::numbers::pi);
  if (script_.kind == PathKind::Random) wander();
  if (script_.kind == PathKind::Line) line();
  if (script_.kind == PathKind::Circle) circle();
  if (script_.kind == PathKind::Stand) pause(kStandLoop);
  if (script_.kind == PathKind::Turn) turn_in_place();
  if (script_.kind == PathKind::Assembly) assemble();
}

void Path::add(Leg leg) {
  leg.start = loop_;
  loop_ += leg.duration;
  legs_.push_back(leg);
}

void Path::pause(double duration) {
  add({.move = Move::Pause,
       .duration = duration,
       .from = place_,
       .to = place_,
       .heading = heading_});
}

void Path::turn_to(double heading) {
  turn_by(wrap_angle(heading - heading_));
  heading_ = wrap_angle(heading);  // Set exactly, because the sum was rounded.
}

void Path::turn_by(double turn) {
  add({.move = Move::Turn,
       .duration = std::abs(turn) / kTurnRate + kTurnSettling,
       .from = place_,
       .to = place_,
       .heading = heading_,
       .turn = turn});
  heading_ = wrap_angle(heading_ + turn);
}

void Path::step_aside(const Eigen::Vector2d& target) {
  const double way = (target - place_).norm();
  add({.move = Move::Aside,
       .duration = way / kAsideSpeed + kTurnSettling,
       .from = place_,
       .to = target,
       .heading = heading_});
  place_ = target;
}

void Path::reach_for(bool left, const Eigen::Vector3d& target, double hold) {
  Leg leg{.move = Move::Reach, .from = place_, .to = place_, .heading = heading_};
  leg.ramp = kReachTime;
  leg.duration = 2 * kReachTime + hold;
  leg.reach = {left, 1.0, target};
  add(leg);
}

void Path::walk_to(const Eigen::Vector2d& target) {
  const Eigen::Vector2d way = target - place_;
  if (way.norm() < 1e-3) return;
  turn_to(heading_towards(way));
  Leg leg{.move = Move::Walk, .from = place_, .to = target, .heading = heading_};
  leg.ramp = script_.speed / kAcceleration;
  leg.speed = std::min(script_.speed, way.norm() / leg.ramp);
  leg.duration = way.norm() / leg.speed + leg.ramp;
  add(leg);
  place_ = target;
}

void Path::wander() {
  Draw draw{script_.seed, kDrawWander};
  const auto way_point = [&] {
    const double radius = script_.reach * std::sqrt(draw.uniform());
    const double angle = draw.uniform(-std::numbers::pi, std::numbers::pi);
    return Eigen::Vector2d(script_.centre +
                           radius * Eigen::Vector2d(std::sin(angle), std::cos(angle)));
  };
  const double first_heading = heading_;
  place_ = way_point();
  const Eigen::Vector2d first = place_;
  while (loop_ < kRandomLoop) {
    Eigen::Vector2d target = way_point();
    for (int i = 0; i < kRedraws && (target - place_).norm() < kMinLegShare * script_.reach; ++i) {
      target = way_point();
    }
    walk_to(target);
    if (draw.uniform() < kPauseShare || script_.reach <= 0) {
      pause(draw.uniform(kMinPause, kMaxPause));
    }
  }
  walk_to(first);
  turn_to(first_heading);
}

void Path::line() {
  const Eigen::Vector2d along(std::sin(heading_), std::cos(heading_));
  place_ = script_.centre - script_.reach * along;
  const Eigen::Vector2d start = place_;
  walk_to(script_.centre + script_.reach * along);
  pause(kLinePause);
  walk_to(start);
  pause(kLinePause);
  turn_to(heading_towards(along));
}

void Path::circle() {
  const double lap = 2 * std::numbers::pi * std::max(script_.reach, 0.1);
  Leg leg{.move = Move::Orbit, .from = script_.centre, .to = script_.centre, .heading = heading_};
  leg.turn = 2 * std::numbers::pi;
  leg.speed = script_.speed;
  leg.duration = lap / script_.speed;
  // The loop closes only with a whole number of gait cycles per lap.
  const double cycles = std::max(1.0, std::round(cadence_ * leg.duration));
  cadence_ = cycles / leg.duration;
  amplitude_ =
      std::clamp(script_.speed / (cadence_ * script_.stride), kMinAmplitude, kMaxAmplitude);
  add(leg);
}

/// A full turn to either side, with pauses in between.
void Path::turn_in_place() {
  for (const double turn : {2 * std::numbers::pi, -2 * std::numbers::pi}) {
    turn_by(turn);
    pause(kTurnPause);
  }
}

/// At each station the hands reach in turn for points at different heights.  Then a step aside
/// leads to the next station, and from the last one back to the first.
void Path::assemble() {
  Draw draw{script_.seed, kDrawReach};
  const Eigen::Vector2d to_left(std::cos(heading_), -std::sin(heading_));
  const double step = std::min(kStationStep, script_.reach);
  const auto station = [&](int index) {
    return Eigen::Vector2d(script_.centre + step * (index - kStations / 2) * to_left);
  };
  place_ = station(0);
  for (int i = 0; i < kStations; ++i) {
    for (int k = 0; k < kReachesPerStation; ++k) {
      const bool left = k % 2 == 0;
      // From slightly across the middle to far outside [m].
      const double aside = draw.uniform(-0.05, 0.35);
      const double height = kReachHeights[static_cast<std::size_t>(i + k) % kReachHeights.size()];
      reach_for(left, {left ? aside : -aside, height, kReachForward},
                draw.uniform(kMinHold, kMaxHold));
    }
    pause(kLinePause);
    step_aside(station((i + 1) % kStations));
  }
}

PathPoint Path::along(const Leg& leg, double time) const {
  PathPoint point{leg.from, leg.heading, cadence_ * time, 0.0};
  const double share = leg.duration > 0 ? std::clamp(time / leg.duration, 0.0, 1.0) : 1.0;
  if (leg.move == Move::Turn) {
    point.heading = leg.heading + leg.turn * smoothstep(share);
    point.amplitude = kTurnStep * amplitude_ * std::sin(std::numbers::pi * share);
  } else if (leg.move == Move::Orbit) {
    const double angle = leg.heading + leg.turn * share;
    const double radius = std::max(script_.reach, 0.1);
    point.place = leg.from + radius * Eigen::Vector2d(std::sin(angle), std::cos(angle));
    point.heading = wrap_angle(angle + std::numbers::pi / 2);
    point.amplitude = amplitude_;
  } else if (leg.move == Move::Aside) {
    point.place = leg.from + smoothstep(share) * (leg.to - leg.from);
    point.amplitude = kTurnStep * amplitude_ * std::sin(std::numbers::pi * share);
  } else if (leg.move == Move::Reach) {
    point.reach = leg.reach;
    point.reach.amount =
        std::min(smoothstep(std::clamp(time / leg.ramp, 0.0, 1.0)),
                 smoothstep(std::clamp((leg.duration - time) / leg.ramp, 0.0, 1.0)));
  } else if (leg.move == Move::Walk) {
    const double begin = std::clamp(time / leg.ramp, 0.0, 1.0);
    const double end = std::clamp((leg.duration - time) / leg.ramp, 0.0, 1.0);
    // A short way has no cruise: the two ramps are all of it, but for rounding.
    const double brake = std::max(leg.ramp, leg.duration - leg.ramp);
    const double cruise = std::clamp(time, leg.ramp, brake) - leg.ramp;
    const double way =
        leg.speed * (leg.ramp * (smooth_way(begin) + 0.5 - smooth_way(end)) + cruise);
    point.place = leg.from + way * (leg.to - leg.from).normalized();
    point.amplitude =
        amplitude_ * (leg.speed / script_.speed) * std::min(smoothstep(begin), smoothstep(end));
  }
  return point;
}

PathPoint Path::at(Duration since_epoch) const {
  Duration in_loop = since_epoch % loop();
  if (in_loop < Duration::zero()) in_loop += loop();
  const double time = seconds(in_loop);
  const auto after = std::upper_bound(legs_.begin(), legs_.end(), time,
                                      [](double t, const Leg& leg) { return t < leg.start; });
  const Leg& leg = after == legs_.begin() ? legs_.front() : *std::prev(after);
  return along(leg, time - leg.start);
}

}  // namespace chorus::synthetic
