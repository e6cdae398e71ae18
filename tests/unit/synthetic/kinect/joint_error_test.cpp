#include "common/synthetic/kinect/joint_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/builders.h"

namespace chorus::synthetic::kinect {
namespace {

constexpr double kFrame = 0.033;
using enum JointId;

/// One axis of smooth noise over `length` frames.
std::vector<double> run_of(double tau, int length) {
  SmoothNoise noise;
  std::vector<double> values;
  for (int i = 0; i < length; ++i) {
    noise.advance(kFrame, tau, Draw{7, static_cast<std::uint64_t>(i)});
    values.push_back(noise.value().x());
  }
  return values;
}

double correlation(const std::vector<double>& values, std::size_t lag) {
  double products = 0, squares = 0;
  for (std::size_t i = 0; i + lag < values.size(); ++i) {
    products += values[i] * values[i + lag];
    squares += values[i] * values[i];
  }
  return products / squares;
}

TEST(SmoothNoise, HasUnitVarianceFromTheFirstFrameOn) {
  double squares = 0;
  for (const double value : run_of(0.5, 60'000)) squares += value * value;
  EXPECT_NEAR(squares / 60'000, 1.0, 0.08);
  double at_start = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    SmoothNoise noise;
    noise.advance(kFrame, 0.5, Draw{seed});
    at_start += noise.value().squaredNorm() / 3.0;
  }
  EXPECT_NEAR(at_start / 4000, 1.0, 0.06);
}

TEST(SmoothNoise, ForgetsAsStated) {
  const double tau = 0.6;
  const auto values = run_of(tau, 100'000);
  for (const std::size_t lag : {3u, 10u, 30u}) {
    const double a = static_cast<double>(lag) * kFrame / (tau / 2);
    EXPECT_NEAR(correlation(values, lag), (1 + a) * std::exp(-a), 0.05) << lag;
  }
}

TEST(SmoothNoise, AddsHardlyAnythingToWhiteNoise) {
  const auto values = run_of(0.7, 20'000);
  double squares = 0;
  for (std::size_t i = 3; i < values.size(); ++i) {
    squares += std::pow(values[i] - 3 * values[i - 1] + 3 * values[i - 2] - values[i - 3], 2);
  }
  EXPECT_LT(std::sqrt(squares / 20.0 / 20'000), 0.04) << "third difference, against sigma 1";
}

TEST(SmoothNoise, StandsStillWhenNoTimePasses) {
  SmoothNoise noise;
  noise.advance(kFrame, 0.5, Draw{1});
  const Eigen::Vector3d before = noise.value();
  noise.advance(0.0, 0.5, Draw{2});
  EXPECT_EQ(noise.value(), before);
}

TEST(Lattice, HasUnitVarianceEverywhereAndIsContinuous) {
  double lattice = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    lattice += lattice_noise({seed}, 100.37, 0.5).squaredNorm() / 3;
  }
  EXPECT_NEAR(lattice / 3000, 1.0, 0.06);
  for (double x = 1; x < 5; x += 0.01) {
    EXPECT_LT((lattice_noise({1}, x + 0.001, 0.6) - lattice_noise({1}, x, 0.6)).norm(), 0.05);
  }
}

TEST(ShownState, ChangesInRunsNotPerFrame) {
  Visibility visibility = nominal_profile("A").visibility;
  visibility.inferred_visible = 0.3;
  int changes = 0, inferred = 0;
  JointState before = JointState::Tracked;
  constexpr int kFrames = 9000;
  for (int i = 0; i < kFrames; ++i) {
    const JointState now = shown_state(WristLeft, 1.0, i * kFrame, visibility, {});
    changes += now != before;
    inferred += now == JointState::Inferred;
    before = now;
  }
  EXPECT_NEAR(static_cast<double>(inferred) / kFrames, 0.3, 0.05);
  // If the state were drawn anew for each frame, it would change in 2 * 0.3 * 0.7 of the frames.
  EXPECT_LT(changes, 0.42 * kFrames / 5);
  EXPECT_GT(changes, 100);
}

TEST(ShownState, HiddenJointsAreMostlyInferredAndAVisibleCoreNever) {
  const Visibility visibility = nominal_profile("A").visibility;
  int hidden = 0;
  for (int i = 0; i < 3000; ++i) {
    hidden += shown_state(KneeLeft, 0.0, i * 1.0, visibility, {}) == JointState::Inferred;
    EXPECT_EQ(shown_state(Neck, 1.0, i * 1.0, visibility, {}), JointState::Tracked);
    EXPECT_EQ(shown_state(ShoulderLeft, 1.0, i * 1.0, visibility, {}), JointState::Tracked);
  }
  EXPECT_NEAR(hidden / 3000.0, visibility.inferred_occluded, 0.04);
}

/// A person standing 2.5 m in front of the sensor, all of whose joints move at one speed.
struct Setting {
  Skeleton<SensorSpace> body;
  Stand stand;
  explicit Setting(double speed) {
    const Eigen::Isometry3d world_from_sensor = testing::sensor_pose({0, 1, 0}, 0.0);
    body = to_sensor(world_from_sensor.inverse(), testing::standing_person({0, 0, 2.5}, deg(180)));
    stand.speed.fill(speed);
  }
};

/// Root mean square error per axis of one joint over independent moments.
Eigen::Vector3d spread(const Profile& profile, JointId id, double speed) {
  const Setting setting(speed);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  constexpr int kRuns = 3000;
  for (int i = 0; i < kRuns; ++i) {
    const ErrorKeys keys{static_cast<std::uint64_t>(i), 0, 0};
    ColouredState state;
    advance(state, setting.stand, {1.0, kFrame}, profile, keys);
    auto body = setting.body;
    add_errors(body, state, setting.stand, 1.0, profile, keys);
    squares += (body[id].position - setting.body[id].position).cwiseAbs2();
  }
  return (squares / kRuns).cwiseSqrt();
}

TEST(AddErrors, TrackedJointsScatterAsTheTableSays) {
  Profile profile = nominal_profile("A");
  profile.gross.teleports = 0;
  profile.white_scale = 0;
  profile.coloured.scale = 1;
  const Eigen::Vector3d elbow = spread(profile, ElbowLeft, 1.0);
  const Eigen::Vector3d neck = spread(profile, Neck, 1.0);
  EXPECT_GT(elbow.x(), 1.5 * neck.x()) << "limbs more than the core";
  EXPECT_NEAR(neck.z() / neck.x(), profile.coloured.depth_factor, 0.15);
  profile.coloured.scale = 2;
  EXPECT_NEAR(spread(profile, Neck, 1.0).x() / neck.x(), 2.0, 0.01);
}

/// Profile A without any of its errors of tracked joints.
Profile quiet() {
  Profile profile = nominal_profile("A");
  profile.gross.teleports = 0;
  profile.white_scale = 0;
  profile.coloured.scale = 0;
  profile.coloured.inferred_least = 0;
  profile.coloured.inferred_pull = 0;
  return profile;
}

/// The body of `setting` with one draw of errors, after an interval of one second.
Skeleton<SensorSpace> with_errors(const Setting& setting, const Profile& profile,
                                  std::uint64_t seed) {
  ColouredState state;
  advance(state, setting.stand, {1.0, kFrame}, profile, {seed, 0, 0});
  Skeleton<SensorSpace> body = setting.body;
  add_errors(body, state, setting.stand, 1.0, profile, {seed, 0, 0});
  return body;
}

/// rms distance from the truth while this fraction of every joint is hidden [m].
double hidden_by(double share, JointId id) {
  const Profile profile = quiet();
  Setting setting(0.0);
  setting.stand.hidden.fill(share);
  double squares = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    const auto body = with_errors(setting, profile, seed);
    squares += (body[id].position - setting.body[id].position).squaredNorm();
  }
  return std::sqrt(squares / 1000);
}

TEST(AddErrors, HiddenLimbsErrMoreTheMoreTheyAreHiddenAndWhetherOrNotTheyAreCalledInferred) {
  EXPECT_EQ(hidden_by(0.0, ElbowLeft), 0.0);
  EXPECT_GT(hidden_by(1.0, ElbowLeft), mm(30));
  EXPECT_NEAR(hidden_by(0.5, ElbowLeft), 0.5 * hidden_by(1.0, ElbowLeft), 1e-9);
  EXPECT_EQ(hidden_by(1.0, Neck), 0.0);
}

TEST(AddErrors, AGuessWandersAlsoAtRest) {
  const Profile profile = quiet();
  Setting setting(0.0);
  setting.stand.hidden.fill(1.0);
  ColouredState state;
  std::vector<double> places;
  for (int i = 0; i < 60; ++i) {
    advance(state, setting.stand, {i * kFrame, kFrame}, profile, {});
    auto body = setting.body;
    add_errors(body, state, setting.stand, i * kFrame, profile, {});
    places.push_back(body[ElbowLeft].position.z());
  }
  const auto [least, most] = std::minmax_element(places.begin(), places.end());
  EXPECT_GT(*most - *least, mm(20));
}

TEST(AddErrors, ABoneToAFollowerKeepsItsLength) {
  Profile profile = quiet();
  profile.coloured.scale = 1;
  const auto length_error = [&](double share) {
    profile.coloured.follow_share = share;
    const Setting setting(1.0);
    double squares = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      const auto body = with_errors(setting, profile, seed);
      squares += ((body[HipLeft].position - body[SpineBase].position) -
                  (setting.body[HipLeft].position - setting.body[SpineBase].position))
                     .squaredNorm();
    }
    return std::sqrt(squares / 1000);
  };
  EXPECT_LT(length_error(0.9), 0.6 * length_error(0.0));
}

TEST(AddErrors, FeetForgetSooner) {
  const Profile profile = nominal_profile("A");
  const Setting setting(1.0);
  const auto kept = [&](JointId id) {
    double products = 0, squares = 0;
    for (std::uint64_t seed = 0; seed < 500; ++seed) {
      ColouredState state;
      std::vector<double> values;
      for (int i = 0; i < 11; ++i) {
        advance(state, setting.stand, {i * kFrame, kFrame}, profile, {seed, 0, 0});
        values.push_back(state.joint[index_of(id)].value().x());
      }
      products += values.front() * values.back();
      squares += values.front() * values.front();
    }
    return products / squares;
  };
  EXPECT_LT(kept(AnkleLeft), kept(KneeLeft) - 0.15) << "after a third of a second";
}

TEST(AddErrors, GuessesJitterMore) {
  Profile profile = quiet();
  profile.white_scale = 1;
  profile.white_inferred = mm(12);
  const auto jitter = [&](JointState state) {
    Setting setting(1.0);
    for (Joint& joint : setting.body.joints) joint.state = state;
    double squares = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      auto body = setting.body;
      add_errors(body, {}, setting.stand, 1.0, profile, {seed, 0, 0});
      squares += std::pow(body[KneeLeft].position.x() - setting.body[KneeLeft].position.x(), 2);
    }
    return std::sqrt(squares / 1000);
  };
  const double tracked = jitter(JointState::Tracked);
  EXPECT_NEAR(jitter(JointState::Inferred), std::hypot(tracked, mm(12)), mm(0.8));
}

TEST(AddErrors, AMisjudgedYawMakesThemGrow) {
  Profile profile = nominal_profile("A");
  profile.gross.teleports = 0;
  profile.white_scale = 0;
  const Setting setting(1.0);
  const auto error_at = [&](double misjudged) {
    Stand stand = setting.stand;
    stand.misjudged = misjudged;
    ColouredState state;
    advance(state, stand, {1.0, kFrame}, profile, {});
    auto body = setting.body;
    add_errors(body, state, stand, 1.0, profile, {});
    return (body[Neck].position - setting.body[Neck].position).norm();
  };
  EXPECT_NEAR(error_at(deg(22.5)) / error_at(0.0), 1.0 + profile.coloured.turn_growth, 1e-6);
}

TEST(AddErrors, AStandingBodyHasLittleWhiteNoise) {
  Profile profile = nominal_profile("A");
  profile.gross.teleports = 0;
  profile.coloured.scale = 0;
  EXPECT_LT(spread(profile, Neck, 0.0).x(), mm(0.2));
  EXPECT_GT(spread(profile, Neck, 1.0).x(), mm(0.5));
}

TEST(AddErrors, ProfileBHasHeavierTails) {
  const auto share_beyond = [](const char* name) {
    Profile profile = nominal_profile(name);
    profile.gross.teleports = 0;
    profile.white_scale = 0;
    const double sigma = spread(profile, Neck, 1.0).x();
    const Setting setting(1.0);
    int beyond = 0;
    for (int i = 0; i < 3000; ++i) {
      const ErrorKeys keys{static_cast<std::uint64_t>(i), 0, 0};
      ColouredState state;
      advance(state, setting.stand, {1.0, kFrame}, profile, keys);
      auto body = setting.body;
      add_errors(body, state, setting.stand, 1.0, profile, keys);
      beyond += std::abs((body[Neck].position - setting.body[Neck].position).x()) > 3 * sigma;
    }
    return beyond;
  };
  EXPECT_GT(share_beyond("B"), 2 * share_beyond("A"));
}

}  // namespace
}  // namespace chorus::synthetic::kinect
