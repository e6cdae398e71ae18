#include "common/positioning/position_filter.h"

#include <random>

#include <gtest/gtest.h>

#include "common/geometry/rotation.h"
#include "tests/support/matchers.h"

namespace chorus::positioning {
namespace {

constexpr double kDt = 1.0 / 30.0;
const Eigen::Vector3d kEye(0, 3.0, 4.5);
// Half a metre above the hips: from there, floor and size tell the distance only badly.
const Eigen::Vector3d kLowEye(0, 1.45, 4.5);

/// A world that errs as the filter believes: a person on a circle, one camera.
struct World {
  explicit World(unsigned seed, Eigen::Vector3d from = kEye) : random(seed), eye(std::move(from)) {}
  double normal() { return std::normal_distribution<double>()(random); }
  static double decayed(double value, double kept, double sigma, double draw) {
    return kept * value + sigma * std::sqrt(1.0 - kept * kept) * draw;
  }

  static Eigen::Vector3d truth(double t) {
    return {std::sin(0.5 * t), 0.95, std::cos(0.5 * t) - 1.0};
  }
  Motion move(double t) {
    const double kept = std::exp(-kDt / errors.speed_memory);
    for (double& each : speed) each = decayed(each, kept, errors.speed, normal());
    Motion motion{kDt, truth(t) - truth(t - kDt), 0.0, false};
    motion.moved -= kDt * Eigen::Vector3d(speed[0], 0.0, speed[1]);
    motion.moved += errors.step * std::sqrt(kDt) * Eigen::Vector3d(normal(), 0.0, normal());
    height = decayed(height, std::exp(-kDt / errors.height_memory), errors.height, normal());
    motion.height = truth(t).y() - height;
    motion.moved = about_y(-heading) * motion.moved;
    return motion;
  }
  Seen look(double t) {
    const Eigen::Vector3d line = truth(t) - eye;
    const double kept = std::exp(-kDt / errors.memory);
    along = decayed(along, begun ? kept : 0.0, errors.along * line.norm(), normal());
    level = decayed(level, begun ? kept : 0.0, errors.across * line.norm(), normal());
    steep = decayed(steep, begun ? kept : 0.0, errors.across * line.norm(), normal());
    begun = true;
    const Eigen::Vector3d ahead = line.normalized();
    const Eigen::Vector3d side = Eigen::Vector3d::UnitY().cross(ahead).normalized();
    Seen seen;
    seen.eye = eye;
    seen.place = eye + (1.0 + depth) * line + along * ahead + level * side +
                 steep * ahead.cross(side) +
                 errors.picture * Eigen::Vector3d(normal(), normal(), normal());
    seen.heading = heading + errors.heading_noise * normal();
    return seen;
  }

  PositionErrors errors{};
  std::mt19937 random;
  Eigen::Vector3d eye;
  double depth = 0.0;
  double heading = 0.3;
  double speed[2] = {0.0, 0.0};
  double height = 0.0;
  double along = 0.0, level = 0.0, steep = 0.0;
  bool begun = false;
};

struct Outcome {
  double squares = 0.0;
  double nees = 0.0;
  double smooth_squares = 0.0;
  double smooth_nees = 0.0;
  double count = 0.0;
  double farther = 0.0;  ///< Sum of the errors along the line of sight [m].
};

void run(unsigned seed, bool hidden, Outcome& out, const Eigen::Vector3d& eye = kEye) {
  World world(seed, eye);
  world.depth = world.errors.depth * world.normal();
  PositionFilter filter(1, world.errors);
  std::vector<FilterStep> steps;
  std::vector<Eigen::Vector3d> truths;
  for (int i = 0; i < 300; ++i) {
    const double t = i * kDt;
    if (filter.begun()) filter.predict(world.move(t));
    const bool seen = !hidden || i < 150 || i > 210;
    const Seen look = world.look(t);
    if (!filter.begun()) filter.begin(look, 0.3, 0.15);
    if (seen) filter.see(look);
    steps.push_back(filter.step());
    truths.push_back(World::truth(t));
  }
  const std::vector<Position> smooth = smoothed(steps);
  for (std::size_t i = 30; i < steps.size(); ++i) {
    const Position online = position_in(steps[i].filtered, steps[i].filtered_covariance);
    const Eigen::Vector3d off = online.place - truths[i];
    const Eigen::Vector3d smooth_off = smooth[i].place - truths[i];
    out.squares += off.squaredNorm();
    out.smooth_squares += smooth_off.squaredNorm();
    out.nees += off.dot(online.covariance.inverse() * off) / 3.0;
    out.smooth_nees += smooth_off.dot(smooth[i].covariance.inverse() * smooth_off) / 3.0;
    out.farther += off.dot((truths[i] - eye).normalized());
    out.count += 1.0;
  }
}

TEST(PositionFilter, StatesItsErrorInAWorldThatErrsAsItBelieves) {
  Outcome out;
  for (unsigned seed = 1; seed <= 40; ++seed) run(seed, false, out);
  EXPECT_GT(out.nees / out.count, 0.5);
  EXPECT_LT(out.nees / out.count, 1.8);
  EXPECT_LT(out.smooth_nees / out.count, 2.5);
  EXPECT_LT(std::sqrt(out.squares / out.count), 0.15);
}

TEST(PositionFilter, StatesItsErrorWhileNobodyIsSeen) {
  Outcome out;
  for (unsigned seed = 1; seed <= 40; ++seed) run(seed, true, out);
  EXPECT_GT(out.nees / out.count, 0.5);
  EXPECT_LT(out.nees / out.count, 1.8);
}

TEST(PositionFilter, DoesNotDriftAwayFromALowCamera) {
  Outcome out;
  for (unsigned seed = 1; seed <= 40; ++seed) run(seed, false, out, kLowEye);
  EXPECT_LT(std::abs(out.farther / out.count), 0.09) << "0.22 with the axes of what is expected";
  EXPECT_LT(std::sqrt(out.squares / out.count), 0.17);
  EXPECT_GT(out.nees / out.count, 0.7);
  EXPECT_LT(out.nees / out.count, 1.4);
}

TEST(PositionFilter, IsSurprisedBySomebodyElse) {
  World world(5);
  PositionFilter filter(1, world.errors);
  const Seen look = world.look(0.0);
  filter.begin(look, 0.0, 0.15);
  for (int i = 0; i < 60; ++i) {
    filter.predict({kDt, Eigen::Vector3d::Zero(), 0.95, false});
    filter.see(look);
  }
  Seen other = look;
  EXPECT_LT(filter.surprise(look), 2.0);
  other.place.x() += 0.6;
  EXPECT_GT(filter.surprise(other), 9.0);
}

TEST(PositionFilter, TwoCamerasTakeEachOthersDepthErrorsAway) {
  World world(6);
  PositionFilter filter(2, world.errors);
  const Eigen::Vector3d truth(0, 0.95, 0);
  const Eigen::Vector3d eyes[2] = {{0, 1.5, 4.5}, {4.5, 1.5, 0}};
  const auto seen = [&](std::size_t camera) {
    Seen out;
    out.camera = camera;
    out.eye = eyes[camera];
    out.place = eyes[camera] + 1.03 * (truth - eyes[camera]);  // 3 % too far, both
    return out;
  };
  filter.begin(seen(0), 0.0, 0.15);
  for (int i = 0; i < 60; ++i) {
    filter.predict({kDt, Eigen::Vector3d::Zero(), 0.95, false});
    filter.see(seen(0));
    filter.see(seen(1));
  }
  EXPECT_LT((filter.position().place - truth).norm(), 0.05);
  EXPECT_GT(filter.depth_of(0).first, 0.01);
}

}  // namespace
}  // namespace chorus::positioning
