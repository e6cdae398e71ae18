// Left and right of people who lie, turn over, leap and spin.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "fusion-server/facing/sides.h"
#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

constexpr Timestamp kAcrobatStart = from_unix_ns(1'790'000'000'000'000'000);
constexpr double kAcrobatStep = 0.033;  // [s]
const Eigen::Vector3d kAcrossLeft = Eigen::Vector3d::UnitX();

/// Somebody whom six sensors see, of which every other one has left and right exchanged.
class Watched {
 public:
  /// The number of views that are wrong after this instant.
  int look(const Skeleton<WorldSpace>& exact) {
    Person person{PersonId{1}, {}};
    for (int s = 0; s < 6; ++s)
      person.views.push_back(view_from(s, deg(60) * s, s % 2 == 0 ? exact : exchanged(exact)));
    resolve_sides(person, kAcrobatStart + from_seconds(time_), memory_, {});
    time_ += kAcrobatStep;
    confidence_ = person.sides_confidence.value();
    return static_cast<int>(std::ranges::count_if(person.views, [&](const SensorView& view) {
      return agreement(spans_of(view.skeleton), spans_of(exact)) < 0;
    }));
  }
  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] double confidence() const { return confidence_; }
  [[nodiscard]] const SidesMemory& memory() const { return memory_; }

 private:
  SidesMemory memory_;
  double time_ = 0.0;
  double confidence_ = 0.0;
};

Skeleton<WorldSpace> tilted_back(const Skeleton<WorldSpace>& body, double angle) {
  return turned(body, Eigen::AngleAxisd(-angle, kAcrossLeft).matrix());
}

TEST(SidesOfAcrobats, WhoLieOnTheirBackAreRightFromTheFirstFrame) {
  Watched watched;
  const auto lying = tilted_back(body_at({0, 0, 0}, 0, {.knees = 0.15, .elbows = -0.03}), deg(90));
  for (int i = 0; i < 30; ++i) EXPECT_EQ(watched.look(lying), 0) << i;
}

TEST(SidesOfAcrobats, WhoTurnOverBackwardsStay) {
  Watched watched;
  const Posture posture{.knees = 0.10, .wrists = 0.1, .elbows = -0.02};
  for (int i = 0; i < 30; ++i) watched.look(body_at({0, 0, 0}, 0, posture));
  for (int i = 0; i < 90; ++i) {
    const double t = i * kAcrobatStep;
    const auto body = body_at({0, 0.3, -1.5 * t}, 0, posture);
    ASSERT_EQ(watched.look(tilted_back(body, deg(360) * t)), 0) << t;
  }
  EXPECT_GT(watched.confidence(), 0.8);
}

/// A dancer holds out nothing that shows where the front is, and leaps backwards.
TEST(SidesOfAcrobats, WhoLeapBackwardsStay) {
  Watched watched;
  const Posture slight{.knees = 0.03};
  for (int i = 0; i < 15; ++i) watched.look(body_at({0, 0, 0}, 0, slight));
  for (int i = 0; i < 60; ++i) {
    const double t = i * kAcrobatStep;
    const double up = 0.5 * std::abs(std::sin(deg(290) * t));
    ASSERT_EQ(watched.look(body_at({0, up, -1.5 * t}, 0, slight)), 0) << t;
  }
}

/// The views stay far from the sides held, and what the posture tells is told again.
TEST(SidesOfAcrobats, WhoSpinStayCertain) {
  Watched watched;
  const Posture posture{.knees = 0.06, .wrists = 0.1, .elbows = -0.02};
  for (int i = 0; i < 90; ++i) watched.look(body_at({0, 0, 0}, 0, posture));
  for (int i = 0; i < 90; ++i) {
    const double heading = wrap_angle(deg(560) * i * kAcrobatStep);
    ASSERT_EQ(watched.look(body_at({0, 0, 0}, heading, posture)), 0) << i;
  }
  EXPECT_GT(watched.confidence(), 0.85);
}

/// Somebody turns a cartwheel half, with the chest to a sensor, and stays on their hands: the line
/// of the shoulders alone looks like that of somebody with their back to it.
TEST(SidesOfAcrobats, WhoAreUpsideDownTeachNothingAboutASensor) {
  Watched watched;
  const auto body = body_at({0, 0, 0}, 0, {.knees = 0.10, .wrists = 0.1, .elbows = -0.02});
  const SensorId first = view_from(0, 0, body).sensor;
  for (int i = 0; i < 150; ++i) watched.look(body);
  ASSERT_GT(watched.confidence(), SidesConfig{}.learn_from);
  for (int i = 0; i < 60; ++i) {
    const double angle = std::min(deg(180), deg(360) * i * kAcrobatStep);
    const auto wheel = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).matrix();
    ASSERT_EQ(watched.look(turned(body, wheel)), 0) << i;
  }
  ASSERT_GT(watched.confidence(), SidesConfig{}.learn_from);
  EXPECT_EQ(watched.memory().telling.at(first).log_odds(), 0.0);
}

}  // namespace
}  // namespace chorus::facing
