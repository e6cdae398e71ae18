#include "fusion-server/registration/adjustment.h"

#include <gtest/gtest.h>

#include "tests/unit/registration/pair_cloud.h"
#include "tests/unit/registration/walk_builder.h"

namespace chorus::registration {
namespace {

const std::vector<double> kAngles{0.0, deg(100), deg(220)};

/// Three sensors around one walk, and their true places.
struct Scene {
  RegistrationConfig config;
  std::map<SensorId, Walker> walkers;
  Places truth;  ///< master_from_sensor; the master is sensor 0.

  void add(const WalkTrack& track, const Eigen::Isometry3d& world_from_sensor) {
    walkers.emplace(track.sensor, walker_of(track, config));
    truth[track.sensor] = ring_place(kAngles[0]).inverse() * world_from_sensor;
  }
  [[nodiscard]] Places adjust(const Places& start, int master = 0, double inflation = 1.0) const {
    return adjust_together(start, {walkers, sensor(master), inflation}, config);
  }
};

Scene scene_of(const WalkSpec& spec, double depth_error = 0.0) {
  Scene scene;
  if (depth_error > 0) scene.config.along_ratio = 8.0;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Isometry3d at = ring_place(kAngles[static_cast<std::size_t>(i)]);
    const WalkTrack track = watch(i, at, spec);
    scene.add(with_depth_error(track, depth_error, 50 + static_cast<unsigned>(i)), at);
  }
  return scene;
}

Places displaced(const Places& places, double size) {
  Places off = places;
  for (int i = 1; i < 3; ++i) {
    Vector6 xi = size * Vector6::Ones();
    xi[i] *= -2.0;
    off.at(sensor(i)) = small_motion(xi) * off.at(sensor(i));
  }
  return off;
}

double worst_error(const Places& found, const Places& truth) {
  double worst = 0.0;
  for (const auto& [id, place] : truth) {
    worst = std::max(worst, difference(found.at(id), place).position);
  }
  return worst;
}

TEST(AdjustTogether, FindsTheTruthOfAnExactWalkFromADisplacedStart) {
  for (const bool use_floor : {true, false}) {
    Scene scene = scene_of({.noise = 0.0});
    scene.config.use_floor = use_floor;
    const Places start = displaced(scene.truth, 0.02);
    EXPECT_GT(worst_error(start, scene.truth), mm(40));
    const Places found = scene.adjust(start);
    EXPECT_LT(worst_error(found, scene.truth), mm(1)) << use_floor;
    EXPECT_TRUE(found.at(sensor(0)).isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  }
}

/// Moving any one sensor does not reduce the cost, which this test sums over the pairs by itself.
TEST(AdjustTogether, EndsWhereNoSingleMoveFitsTheWalkBetter) {
  Scene scene = scene_of({.noise = 0.01});
  scene.config.use_floor = false;
  scene.config.along_ratio = 1.0;
  const Places found = scene.adjust(displaced(scene.truth, 0.005));
  const auto slots = slots_of(scene.config.joints);
  const auto misfit = [&](const Places& places) {
    double sum = 0.0;
    for (int a = 0; a < 3; ++a) {
      for (int b = a + 1; b < 3; ++b) {
        const Trail& target = scene.walkers.at(sensor(a)).trail;
        const Trail& source = scene.walkers.at(sensor(b)).trail;
        for (const Pair& pair : pair_up(target, source, scene.config).pairs) {
          const double sigma = slots[pair.slot].sigma;
          sum += (places.at(sensor(a)) * pair.x_in_target - places.at(sensor(b)) * pair.x_in_source)
                     .squaredNorm() /
                 (sigma * sigma);
        }
      }
    }
    return sum;
  };
  for (int i = 1; i < 3; ++i) {
    for (int axis = 0; axis < 6; ++axis) {
      for (const double step : {0.003, -0.003}) {
        Places moved = found;
        moved.at(sensor(i)) = small_motion(unit6(axis, step)) * moved.at(sensor(i));
        EXPECT_GT(misfit(moved), misfit(found)) << i << " " << axis << " " << step;
      }
    }
  }
}

/// Single cameras: chains of pairs leave the depth open; three rays determine it.
TEST(AdjustTogether, ThreeBluntSensorsFixWhatEachPairLeavesOpen) {
  double before = 0.0;
  double after = 0.0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Scene scene = scene_of({.length = 10, .noise = 0.004, .seed = seed}, 0.15);
    const Places start = displaced(scene.truth, 0.02);
    before += worst_error(start, scene.truth);
    after += worst_error(scene.adjust(start), scene.truth);
  }
  EXPECT_LT(after, 0.5 * before);
}

TEST(AdjustTogether, AnyMasterGivesTheSameShape) {
  const Scene scene = scene_of({.noise = 0.01});
  const Places start = displaced(scene.truth, 0.01);
  const Places from_first = scene.adjust(start);
  Places turned;
  const Eigen::Isometry3d other_from_master = start.at(sensor(2)).inverse();
  for (const auto& [id, place] : start) turned[id] = other_from_master * place;
  const Places from_third = scene.adjust(turned, 2);
  for (const auto& [id, place] : from_first) {
    const Eigen::Isometry3d expected = from_first.at(sensor(2)).inverse() * place;
    EXPECT_LT(difference(from_third.at(id), expected).position, mm(4)) << id.str();
  }
}

TEST(AdjustTogether, FloorsHoldTiltAndHeightWhereTheWalkIsCountedForLittle) {
  const FloorPlane tilted{Eigen::Vector3d(std::sin(deg(1)), std::cos(deg(1)), 0), 0.0};
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Isometry3d at = ring_place(kAngles[static_cast<std::size_t>(i)]);
    WalkSpec spec{.length = 6, .noise = 0.02};
    if (i == 1) spec.floor_in_world = tilted;
    scene.add(watch(i, at, spec), at);
  }
  const auto tilt_error = [&](double inflation) {
    const Places found = scene.adjust(displaced(scene.truth, 0.02), 0, inflation);
    return difference(found.at(sensor(1)), scene.truth.at(sensor(1))).angle;
  };
  EXPECT_LT(to_deg(tilt_error(1.0)), 0.5);     // here the walk outweighs the floor
  EXPECT_GT(to_deg(tilt_error(1000.0)), 0.6);  // here the floor outweighs the walk
}

TEST(AdjustTogether, ASensorWithTooFewSightsKeepsItsPlace) {
  Scene scene = scene_of({.noise = 0.01});
  Walker& stranger = scene.walkers.at(sensor(2));
  stranger.trail.frames.resize(2);
  const Places start = displaced(scene.truth, 0.01);
  const Places found = scene.adjust(start);
  EXPECT_LT(difference(found.at(sensor(2)), start.at(sensor(2))).position, 1e-9);
  EXPECT_GT(difference(found.at(sensor(1)), start.at(sensor(1))).position, mm(5));
}

TEST(AdjustTogether, WithoutCommonInstantsNothingMoves) {
  Scene scene = scene_of({.noise = 0.01});
  for (int i = 1; i < 3; ++i) {
    for (TrailFrame& frame : scene.walkers.at(sensor(i)).trail.frames) {
      frame.captured += std::chrono::hours(i);
    }
  }
  const Places start = displaced(scene.truth, 0.01);
  const Places found = scene.adjust(start);
  for (const auto& [id, place] : start) EXPECT_EQ(found.at(id).matrix(), place.matrix());
}

TEST(AdjustTogether, AlmostEverythingWrongIsNoReasonToMoveFarther) {
  const WalkSpec wild{.noise = 0.01, .outliers = 0.3};
  const Scene scene = scene_of(wild);
  const Places found = scene.adjust(displaced(scene.truth, 0.005));
  EXPECT_LT(worst_error(found, scene.truth), mm(15));
}

TEST(AdjustTogether, FastInstantsAreLeftOut) {
  Scene scene = scene_of({.noise = 0.01});
  scene.config.max_speed = 0.0;  // everybody counts as too fast
  const Places start = displaced(scene.truth, 0.01);
  EXPECT_EQ(scene.adjust(start).at(sensor(1)).matrix(), start.at(sensor(1)).matrix());
}

}  // namespace
}  // namespace chorus::registration
