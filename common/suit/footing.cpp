#include "common/suit/footing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace chorus::suit {
namespace {

using enum JointId;

constexpr double kLongestGap = 0.5;  // [s]
// Height of an ankle and of the ball of a foot above the sole, as shares of the stature.
constexpr double kAnkleShare = 0.045;
constexpr double kBallShare = 0.012;
constexpr double kHeelShare = 0.027;  // How far the heel is behind the ankle.
// Heel and ball count by how far they are above the lower one, with this scale [m].
constexpr double kSoftness = 0.015;
// The other foot stands when its sole is lower by this [m]: suits hold heights to about a
// centimetre.
constexpr double kSwitch = 0.01;
constexpr double kSmoothing = 0.03;  // Of speeds [s].
constexpr double kGravity = 9.81;    // [m/s^2]
// How far the feet must be above the floor before it is called flight [m], and how fast the pelvis
// must have risen: steps and quick bends stay below.
constexpr double kClear = 0.03;
constexpr double kTakeOff = 0.6;
constexpr double kLongestFlight = 1.0;  // [s]

double lowest(const std::array<double, 4>& heights, std::size_t foot) {
  return std::min(heights[2 * foot], heights[2 * foot + 1]);
}

/// Heel and ball of a foot, as points of its sole.  The sole's direction is that of the bone from
/// ankle to ball, turned up by as much as the ankle is higher than the ball when the foot is flat.
struct SolePoints {
  Eigen::Vector3d heel;
  Eigen::Vector3d ball;
};

SolePoints sole_points(const Eigen::Vector3d& ankle, const Eigen::Vector3d& ball, double stature) {
  const Eigen::Vector3d bone = ball - ankle;
  const double drop = (kAnkleShare - kBallShare) * stature;
  const double length = bone.norm();
  const Eigen::Vector3d side = bone.cross(Eigen::Vector3d::UnitY());
  constexpr double kUpright = 0.05;  // A foot on its tip tells no direction.
  if (length < 1.2 * drop || side.norm() < kUpright * length) {
    const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
    return {ankle - kAnkleShare * stature * up, ball - kBallShare * stature * up};
  }
  const Eigen::AngleAxisd flat(std::asin(drop / length), side.normalized());
  const Eigen::Vector3d ahead = flat * (bone / length);
  const Eigen::Vector3d up = side.normalized().cross(ahead);
  return {ankle - kAnkleShare * stature * up - kHeelShare * stature * ahead,
          ball - kBallShare * stature * up};
}

}  // namespace

Footing::Soles Footing::soles_of(const SuitPose& pose) const {
  Soles soles;
  const auto set = [&](std::size_t at, JointId ankle_id, JointId ball_id) {
    const Joint& ankle = pose.joints[ankle_id];
    const Joint& ball = pose.joints[ball_id];
    soles[at].seen = ankle.seen();
    soles[at + 1].seen = ankle.seen() && ball.seen();
    if (!ankle.seen()) return;
    if (!ball.seen()) {
      soles[at].place = ankle.position - Eigen::Vector3d(0, kAnkleShare * stature_, 0);
      return;
    }
    const SolePoints sole = sole_points(ankle.position, ball.position, stature_);
    soles[at].place = sole.heel;
    soles[at + 1].place = sole.ball;
  };
  set(0, AnkleLeft, FootLeft);
  set(2, AnkleRight, FootRight);
  return soles;
}

/// How the pelvis moves when this foot stands.
Eigen::Vector3d Footing::walked(const Soles& now, std::size_t foot) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0.0;
  double floor = std::numeric_limits<double>::infinity();
  for (std::size_t i = 2 * foot; i < 2 * foot + 2; ++i) {
    if (now[i].seen && before_[i].seen) floor = std::min(floor, now[i].place.y());
  }
  for (std::size_t i = 2 * foot; i < 2 * foot + 2; ++i) {
    if (!now[i].seen || !before_[i].seen) continue;
    const double weight = std::exp(-(now[i].place.y() - floor) / kSoftness);
    sum += weight * (before_[i].place - now[i].place);
    weights += weight;
  }
  if (!(weights > 0.0)) return Eigen::Vector3d::Zero();
  sum /= weights;
  sum.y() = 0.0;
  return sum;
}

void Footing::stand_on_lower(const Soles& now) {
  std::array<double, 4> heights{};
  for (std::size_t i = 0; i < heights.size(); ++i)
    heights[i] = now[i].seen ? now[i].place.y() : std::numeric_limits<double>::infinity();
  const std::size_t other = 1 - foot_;
  if (lowest(heights, other) < lowest(heights, foot_) - kSwitch) foot_ = other;
  standing_ = -std::min(lowest(heights, 0), lowest(heights, 1));
}

/// Follows the parabola that the pelvis would fly; as long as standing lifts it higher, it stands.
void Footing::fly_or_stand(double dt, Step& step) {
  fall_.height += fall_.speed * dt - 0.5 * kGravity * dt * dt;
  fall_.speed -= kGravity * dt;
  fall_.age += dt;
  fall_.moved += step.moved;
  const bool lands = standing_ >= fall_.height || fall_.age > kLongestFlight;
  if (lands) {
    if (flies_) rise_ = once_ = twice_ = 0.0;
    flies_ = false;
    fall_ = {standing_, rise_, 0.0, Eigen::Vector3d::Zero(), velocity_};
  } else if (!flies_ && fall_.height - standing_ > kClear &&
             fall_.speed + kGravity * fall_.age > kTakeOff) {
    flies_ = true;
    // Since the parabola began, the feet did not stand: what was walked on them is taken back.
    step.moved += fall_.velocity * fall_.age - fall_.moved;
    step.stance = Stance::Flight;
    step.height = fall_.height;
    return;
  }
  step.height = flies_ ? fall_.height : standing_;
  if (!flies_) return;
  step.moved = fall_.velocity * dt;
  step.stance = Stance::Flight;
}

Step Footing::next(const SuitPose& pose) {
  const Soles now = soles_of(pose);
  Step step;
  if (!now[0].seen || !now[2].seen) {
    time_.reset();
    return step;
  }
  const double dt = time_ ? seconds(pose.time - *time_) : 0.0;
  const bool anew = !time_ || !(dt > 0.0) || dt > kLongestGap;
  const double stood = standing_;
  if (anew) foot_ = now[2].place.y() < now[0].place.y() ? 1 : 0;
  stand_on_lower(now);
  step.stance = foot_ == 0 ? Stance::Left : Stance::Right;
  step.height = standing_;
  if (anew) {
    rise_ = once_ = twice_ = 0.0;
    velocity_.setZero();
    flies_ = false;
    fall_ = {standing_, 0.0, 0.0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  } else {
    step.moved = walked(now, foot_);
    if (!flies_) {
      const double share = 1.0 - std::exp(-dt / kSmoothing);
      once_ += share * ((standing_ - stood) / dt - once_);
      twice_ += share * (once_ - twice_);
      rise_ = 2.0 * once_ - twice_;  // Smoothing twice tells by how much smoothing lags.
      velocity_ += share * (step.moved / dt - velocity_);
    }
    fly_or_stand(dt, step);
  }
  before_ = now;
  time_ = pose.time;
  return step;
}

}  // namespace chorus::suit
