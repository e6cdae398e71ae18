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
  Places truth;  ///< world_from_sensor; the floor is y = 0, the master is sensor 0.

  void add(const WalkTrack& track, const Eigen::Isometry3d& world_from_sensor) {
    walkers.emplace(track.sensor, walker_of(track, config));
    truth[track.sensor] = world_from_sensor;
  }
  [[nodiscard]] std::optional<Adjusted> look(const Places& start, int master = 0) const {
    Walkers all{walkers, sensor(master)};
    if (!config.use_floor) all.guessed = plane_in_sensor({}, truth.at(sensor(master)));
    return adjust_together(start, all, config);
  }
  [[nodiscard]] Places adjust(const Places& start, int master = 0) const {
    const auto adjusted = look(start, master);
    return adjusted ? adjusted->places : start;
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
    Scene scene = scene_of({.length = 10, .noise = 0.0});
    scene.config.use_floor = use_floor;
    const Places start = displaced(scene.truth, 0.02);
    EXPECT_GT(worst_error(start, scene.truth), mm(40));
    const Places found = scene.adjust(start);
    EXPECT_LT(worst_error(found, scene.truth), mm(1)) << use_floor;
    EXPECT_LT(difference(found.at(sensor(0)), scene.truth.at(sensor(0))).position, mm(1));
  }
}

/// Moving any one sensor does not reduce the cost, which this test sums over the pairs by itself.
TEST(AdjustTogether, EndsWhereNoSingleMoveFitsTheWalkBetter) {
  Scene scene = scene_of({.length = 8, .noise = 0.01});
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

/// The sensors measure depth badly, as cameras do: chains of pairs do not determine the depth, but
/// three rays do.
TEST(AdjustTogether, ThreeBluntSensorsFixWhatEachPairLeavesOpen) {
  double before = 0.0;
  double after = 0.0;
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const Scene scene = scene_of({.length = 10, .noise = 0.004, .seed = seed}, 0.15);
    const Places start = displaced(scene.truth, 0.02);
    before += worst_error(start, scene.truth);
    after += worst_error(scene.adjust(start), scene.truth);
  }
  EXPECT_LT(after, 0.5 * before);
}

TEST(AdjustTogether, AnyMasterGivesTheSameShape) {
  const Scene scene = scene_of({.length = 10, .noise = 0.01});
  const Places start = displaced(scene.truth, 0.01);
  const Places from_first = scene.adjust(start);
  const Places from_third = scene.adjust(start, 2);
  for (const auto& [id, place] : from_first) {
    const Eigen::Isometry3d expected = from_first.at(sensor(2)).inverse() * place;
    const Eigen::Isometry3d other = from_third.at(sensor(2)).inverse() * from_third.at(id);
    EXPECT_LT(difference(other, expected).position, mm(4)) << id.str();
  }
}

TEST(AdjustTogether, FloorsHoldTiltAndHeightWhereTheWalkIsCountedForLittle) {
  const FloorPlane tilted{Eigen::Vector3d(std::sin(deg(1)), std::cos(deg(1)), 0), 0.0};
  const auto tilt_error = [&](double length, double noise) {
    Scene scene;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Isometry3d at = ring_place(kAngles[static_cast<std::size_t>(i)]);
      WalkSpec spec{.length = length, .noise = noise};
      if (i == 1) spec.floor_in_world = tilted;
      scene.add(watch(i, at, spec), at);
    }
    const Places found = scene.adjust(displaced(scene.truth, 0.002));
    // Compares the two sensors with each other, because the world's up is the mean of what all
    // floors state and thus itself tilted.
    return difference(found.at(sensor(0)).inverse() * found.at(sensor(1)),
                      scene.truth.at(sensor(0)).inverse() * scene.truth.at(sensor(1)))
        .angle;
  };
  EXPECT_LT(to_deg(tilt_error(20, 0.004)), 0.5);  // the walk outweighs the floor
  EXPECT_GT(to_deg(tilt_error(3, 0.15)), 0.6);    // the floor outweighs the walk
}

TEST(AdjustTogether, TheMasterKeepsItsPlaceAlongTheFloorAndItsDirectionAlone) {
  const Scene scene = scene_of({.noise = 0.01});
  Places start = displaced(scene.truth, 0.005);
  Eigen::Isometry3d& master = start.at(sensor(0));
  master = small_motion((Vector6() << 0.01, 0, 0.01, 0, 0.02, 0).finished()) * master;
  const Eigen::Vector3d before = master.translation();
  const auto adjusted = scene.look(start);
  ASSERT_TRUE(adjusted);
  const Eigen::Isometry3d& after = adjusted->places.at(sensor(0));
  EXPECT_NEAR(after.translation().x(), before.x(), mm(0.5));
  EXPECT_NEAR(after.translation().z(), before.z(), mm(0.5));
  EXPECT_LT(std::abs(after.translation().y() - 1.8), mm(2));  // its floor corrected it
  const Matrix6 shift = at_point(after.translation());
  const Matrix6 at_eye = shift * adjusted->covariances.at(sensor(0)) * shift.transpose();
  EXPECT_LT(to_mm(std::sqrt(at_eye(3, 3))), 0.1);
  EXPECT_GT(to_mm(std::sqrt(at_eye(4, 4))), 3.0);  // mean of three floors, each off by 10 mm
  EXPECT_GT(to_deg(std::sqrt(at_eye(0, 0))), 0.1);
}

/// However long and exact the walk is, the errors of joints that depend on the direction of view
/// remain.
TEST(AdjustTogether, AnExactWalkStillLeavesYawAndPlaceUncertain) {
  const Scene scene = scene_of({.noise = 0.0});
  const auto adjusted = scene.look(scene.truth);
  ASSERT_TRUE(adjusted);
  const Matrix6 at_walk = at_point(Eigen::Vector3d(0, 1.2, 0)) *
                          adjusted->covariances.at(sensor(1)) *
                          at_point(Eigen::Vector3d(0, 1.2, 0)).transpose();
  EXPECT_GT(to_mm(std::sqrt(at_walk(3, 3))), 2.0);
  EXPECT_LT(to_mm(std::sqrt(at_walk(3, 3))), 8.0);
  EXPECT_GT(to_deg(std::sqrt(at_walk(1, 1))), 0.05);
  EXPECT_LT(to_deg(std::sqrt(at_walk(1, 1))), 1.0);
}

/// If the person walks on a circle, the bias of a view rotates with the person's place, which
/// looks as if the sensor were rotated.
TEST(AdjustTogether, ACircleLeavesTheYawLessCertainThanAWalkAllOver) {
  const auto yaw_sigma = [](const Path& path) {
    const Scene scene = scene_of({.path = path, .noise = 0.0});
    const auto adjusted = scene.look(scene.truth);
    return adjusted ? std::sqrt(adjusted->covariances.at(sensor(1))(1, 1)) : 0.0;
  };
  const auto circle = [](double t) {
    return Eigen::Vector2d(0.8 * std::sin(0.8 * t), 0.8 * std::cos(0.8 * t));
  };
  EXPECT_GT(yaw_sigma(circle), 1.3 * yaw_sigma(wander));
}

/// The first `count` of the three sensors; all report joints too near.
Scene near_scene(const WalkSpec& spec, double depth_bias, int count = 3) {
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const Eigen::Isometry3d at = ring_place(kAngles[static_cast<std::size_t>(i)]);
    scene.add(nearer_by(depth_bias, watch(i, at, spec)), at);
  }
  return scene;
}

TEST(AdjustTogether, AKnownDepthBiasIsTakenOut) {
  Scene scene = near_scene({.noise = 0.005}, mm(25));
  EXPECT_GT(worst_error(scene.adjust(scene.truth), scene.truth), mm(25));
  scene.config.depth_bias = mm(25);
  EXPECT_LT(worst_error(scene.adjust(scene.truth), scene.truth), mm(5));
}

/// Depth and width of a walk tell it from places that are nearer to each other.
TEST(AdjustTogether, AnUnknownDepthBiasIsEstimated) {
  Scene scene = near_scene({.noise = 0.005}, mm(25));
  const double without = worst_error(scene.adjust(scene.truth), scene.truth);
  scene.config.depth_bias_sigma = mm(50);
  EXPECT_LT(worst_error(scene.adjust(scene.truth), scene.truth), 0.4 * without);
  const auto adjusted = scene.look(scene.truth);
  ASSERT_TRUE(adjusted);
  EXPECT_NEAR(adjusted->depth_bias.bias, mm(25), mm(8));
  EXPECT_GT(adjusted->depth_bias.sigma, mm(0.1));
  EXPECT_LT(adjusted->depth_bias.sigma, mm(15));
}

TEST(AdjustTogether, ALargeDepthBiasThatNobodyToldIsFoundAndSaid) {
  const Scene scene = near_scene({.noise = 0.01}, mm(80));
  const auto adjusted = scene.look(scene.truth);
  ASSERT_TRUE(adjusted && adjusted->found_bias);
  EXPECT_NEAR(adjusted->depth_bias.bias, mm(80), 4 * adjusted->depth_bias.sigma);
  EXPECT_LT(adjusted->depth_bias.sigma, mm(20));
  EXPECT_LT(worst_error(adjusted->places, scene.truth), mm(40));
}

TEST(AdjustTogether, ASmallDepthBiasIsNotLookedForNorOneThatWasTold) {
  Scene scene = near_scene({.noise = 0.01}, mm(20));
  EXPECT_FALSE(scene.look(scene.truth)->found_bias);
  scene = near_scene({.noise = 0.01}, mm(80));
  scene.config.depth_bias_sigma = mm(1);
  EXPECT_FALSE(scene.look(scene.truth)->found_bias);
}

/// A smaller depth bias would scale the noise across the lines of sight down.
TEST(AdjustTogether, NoiseIsNotTakenForADepthBias) {
  Scene scene = near_scene({.length = 60, .noise = 0.03}, 0.0);
  scene.config.depth_bias_sigma = mm(50);
  EXPECT_LT(worst_error(scene.adjust(scene.truth), scene.truth), mm(15));
}

TEST(AdjustTogether, WhatTheWalkLeavesOpenOfTheDepthBiasAddsToTheCovariances) {
  const auto sigma = [](double depth_bias) {
    Scene scene = near_scene({.length = 10, .noise = 0.01}, 0.0, 2);
    scene.config.depth_bias_sigma = depth_bias;
    const auto adjusted = scene.look(scene.truth);
    if (!adjusted) return 0.0;
    const Matrix6 shift = at_point(Eigen::Vector3d(0, 1.2, 0));
    return std::sqrt((shift * adjusted->covariances.at(sensor(1)) * shift.transpose())(3, 3));
  };
  EXPECT_GT(sigma(mm(20)), 1.3 * sigma(0.0));
}

TEST(AdjustTogether, GivesUpWhenStopped) {
  const Scene scene = scene_of({.noise = 0.01});
  Walkers walkers{scene.walkers, sensor(0)};
  int asked = 0;
  walkers.stopped = [&] { return ++asked == 2; };
  EXPECT_FALSE(adjust_together(displaced(scene.truth, 0.01), walkers, scene.config));
  EXPECT_EQ(asked, 2);
}

TEST(AdjustTogether, TheEndDoesNotDependOnHowFarTheStartWasOff) {
  const Scene scene = scene_of({.noise = 0.02, .outliers = 0.05});
  const Places near = scene.adjust(displaced(scene.truth, 0.002));
  const Places far = scene.adjust(displaced(scene.truth, 0.03));
  for (const auto& [id, place] : near)
    EXPECT_LT(difference(far.at(id), place).position, mm(0.1)) << id.str();
}

TEST(AdjustTogether, NoisierWalksAreStatedToBeLessCertain) {
  const auto sigma = [](double noise) {
    const Scene scene = scene_of({.length = 10, .noise = noise});
    const auto adjusted = scene.look(scene.truth);
    return adjusted ? std::sqrt(adjusted->covariances.at(sensor(1))(1, 1)) : 0.0;
  };
  EXPECT_GT(sigma(0.04), 1.5 * sigma(0.01));
}

/// Moves every joint by errors that last: with this time constant [s], and as large on every axis.
WalkTrack with_lasting_errors(WalkTrack track, double sigma, double time_constant, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> draw(0.0, 1.0);
  const double kept = std::exp(-1.0 / (30.0 * time_constant));
  std::array<Eigen::Vector3d, kJointCount> errors;
  for (Eigen::Vector3d& error : errors) error = {draw(random), draw(random), draw(random)};
  for (SensorFrame& frame : track.frames) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Vector3d news{draw(random), draw(random), draw(random)};
      errors[j] = kept * errors[j] + std::sqrt(1.0 - kept * kept) * news;
      frame.bodies[0].skeleton.joints[j].position += sigma * errors[j];
    }
  }
  return track;
}

/// Errors that last can be taken out only as far as the walk is long.  What stays in it makes
/// instants repeat one another, so that a quarter of a walk is worth less than a quarter.
TEST(AdjustTogether, AShortWalkWithLastingErrorsIsWorthLessThanItsShare) {
  const auto stated_variance = [](double length) {
    WalkSpec spec{.length = length, .noise = 0.001};
    spec.path = [](double t) {  // round and round, three seconds each
      return Eigen::Vector2d(0.4 * std::sin(2.1 * t), 0.4 * std::cos(2.1 * t));
    };
    Scene scene;
    scene.config.view_bias = 0.0;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Isometry3d at = ring_place(kAngles[static_cast<std::size_t>(i)]);
      const unsigned seed = 70 + static_cast<unsigned>(i);
      scene.add(with_lasting_errors(watch(i, at, spec), 0.03, 0.6, seed), at);
    }
    const auto adjusted = scene.look(scene.truth);
    return adjusted ? adjusted->covariances.at(sensor(1))(1, 1) : 0.0;
  };
  EXPECT_GT(stated_variance(3.0), 4.0 * stated_variance(12.0));
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
  const Places start = displaced(scene.truth, 0.005);
  const Places found = scene.adjust(start);
  EXPECT_LE(worst_error(found, scene.truth), worst_error(start, scene.truth));
}

TEST(AdjustTogether, FastInstantsAreLeftOut) {
  Scene scene = scene_of({.noise = 0.01});
  scene.config.max_speed = 0.0;  // everybody counts as too fast
  const Places start = displaced(scene.truth, 0.01);
  EXPECT_EQ(scene.adjust(start).at(sensor(1)).matrix(), start.at(sensor(1)).matrix());
}

}  // namespace
}  // namespace chorus::registration
