// Cameras whose pictures take long, with the configuration as shipped: the server waits for them,
// without delaying the others.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "fusion-server/core/fusion_core.h"
#include "tests/support/builders.h"

namespace chorus::core {
namespace {

using std::chrono::milliseconds;
using testing::kStart;
using testing::sensor_id;

struct Source {
  Duration period;
  Duration jitter;  ///< Largest time added to the period and to the delay.
  Duration delay;
  bool rays = true;
};

constexpr Source kMoveNet{milliseconds(185), milliseconds(40), milliseconds(250)};
constexpr Source kDepthCamera{milliseconds(33), milliseconds(0), milliseconds(20), false};

std::string camera_name(std::size_t i) { return "cam" + std::to_string(i); }

Eigen::Isometry3d place(std::size_t i) {
  return testing::ring_sensor(static_cast<int>(i), 4, 3.5, 1.5);
}

Skeleton<WorldSpace> person(Duration t) {
  const double angle = 0.5 * chorus::seconds(t);
  return testing::standing_person({0.5 * std::cos(angle), 0, 0.5 * std::sin(angle)}, angle);
}

SensorFrame picture(std::size_t i, const Source& source, Duration t) {
  const Timestamp captured = kStart + t;
  BodyFrame body = testing::body_seen_from(place(i), person(t), captured);
  for (Joint& joint : body.skeleton.joints) {
    if (!source.rays) break;
    joint.position.normalize();
    joint.measurement = Measurement::Ray;
    joint.orientation.coeffs().setZero();
  }
  return testing::sensor_frame(camera_name(i), captured, {body});
}

/// A delay from 0 to `most`: the same sequence in all runs, a different one for each sensor.
Duration uneven(Duration most, std::size_t sensor, std::uint64_t count) {
  return most * static_cast<int>((count * 7919 + sensor * 104'729) % 101) / 100;
}

std::vector<SensorFrame> frames_of(const std::vector<Source>& sources, Duration length) {
  std::vector<SensorFrame> frames;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const Source& own = sources[i];
    std::uint64_t count = 0;
    for (Duration t = milliseconds(11 * i); t < length; ++count) {
      SensorFrame frame = picture(i, own, t);
      frame.sequence = count;
      frame.received = frame.captured + own.delay + uneven(own.jitter, i, count);
      frames.push_back(std::move(frame));
      t += own.period + uneven(own.rays ? own.jitter : Duration{0}, i, count + 1);
    }
  }
  std::ranges::stable_sort(frames, {}, &SensorFrame::received);
  return frames;
}

struct Outcome {
  double with_body = 0.0;  ///< Fraction of the instants that have a body.
  double by_all = 0.0;     ///< Fraction in which every sensor sees the neck.
  double age_p90 = 0.0;    ///< [s]
  double error = 0.0;      ///< Largest error of the neck [m].
};

/// What the instants from `settled` to the end show; fractions are of all of them.
Outcome run(const std::vector<Source>& sources, CoreConfig config = {},
            Duration length = std::chrono::seconds(20),
            Duration settled = std::chrono::seconds(6)) {
  Registration registration;
  registration.verdict = Verdict::Good;
  registration.master = sensor_id(camera_name(0));
  for (std::size_t i = 0; i < sources.size(); ++i) {
    config.sensors.insert(sensor_id(camera_name(i)));
    registration.sensors[sensor_id(camera_name(i))].world_from_sensor = place(i);
  }
  config.session.automatic = false;
  FusionCore core(config, registration);
  Outcome out;
  std::vector<double> ages;
  const std::vector<SensorFrame> frames = frames_of(sources, length);
  auto next = frames.begin();
  for (Duration t{0}; t < length; t += milliseconds(1)) {
    for (; next != frames.end() && next->received <= kStart + t; ++next) core.take(*next);
    while (const auto snapshot = core.tick(kStart + t)) {
      if (snapshot->instant < kStart + settled) continue;
      ages.push_back(chorus::seconds(kStart + t - snapshot->instant));
      if (snapshot->bodies.empty()) continue;
      const FusedBody& body = snapshot->bodies[0];
      const Joint& neck = body.skeleton[JointId::Neck];
      if (!neck.seen()) continue;
      const auto truth = person(snapshot->instant - kStart)[JointId::Neck].position;
      out.with_body += 1.0;
      out.by_all +=
          body.contributors[index_of(JointId::Neck)] == (1U << sources.size()) - 1 ? 1.0 : 0.0;
      out.error = std::max(out.error, (neck.position - truth).norm());
    }
  }
  std::ranges::sort(ages);
  out.age_p90 = ages.at(ages.size() * 9 / 10);
  out.with_body /= static_cast<double>(ages.size());
  out.by_all /= static_cast<double>(ages.size());
  return out;
}

TEST(SlowCameras, TwoOfThemMakeABodyWithTheConfigurationAsShipped) {
  const Outcome outcome = run({kMoveNet, kMoveNet});
  EXPECT_GT(outcome.with_body, 0.98);
  EXPECT_GT(outcome.by_all, 0.95);
  EXPECT_LT(outcome.age_p90, 0.6);
  EXPECT_LT(outcome.error, 0.03);
}

TEST(SlowCameras, EvenTwoPicturesASecondMakeABody) {
  const Source slowest{milliseconds(450), milliseconds(60), milliseconds(600)};
  const Outcome outcome = run({slowest, slowest});
  EXPECT_GT(outcome.by_all, 0.9);
  EXPECT_LT(outcome.age_p90, 1.4);
}

TEST(SlowCameras, AQuickOneWaitsForTheSlowOneThatItNeeds) {
  const Source quick{milliseconds(35), milliseconds(10), milliseconds(60)};
  const Outcome outcome = run({quick, kMoveNet});
  EXPECT_GT(outcome.by_all, 0.95);
}

TEST(SlowCameras, FourOfDifferentPace) {
  const Source slower{milliseconds(230), milliseconds(60), milliseconds(300)};
  const Outcome outcome = run({kMoveNet, slower, kMoveNet, slower});
  EXPECT_GT(outcome.with_body, 0.98);
  EXPECT_GT(outcome.by_all, 0.9);
  EXPECT_LT(outcome.age_p90, 0.75);
}

TEST(SlowCameras, DoNotMakeQuickSensorsOld) {
  const Outcome alone = run({kDepthCamera, kDepthCamera, kDepthCamera});
  const Outcome with = run({kDepthCamera, kDepthCamera, kDepthCamera, kMoveNet});
  EXPECT_LT(alone.age_p90, 0.1);
  EXPECT_LT(with.age_p90, 0.25);
  EXPECT_GT(with.with_body, 0.98);
}

TEST(SlowCameras, AreWaitedForNoLongerThanTheConfigurationAllows) {
  CoreConfig config;
  config.pipeline.align.slowest = milliseconds(0);
  EXPECT_LT(run({kMoveNet, kMoveNet}, config).by_all, 0.05);
  config.pipeline.align.slowest = milliseconds(800);
  const Source hopeless{milliseconds(900), milliseconds(0), milliseconds(900)};
  EXPECT_LT(run({hopeless, hopeless}, config).age_p90, 0.9);
}

}  // namespace
}  // namespace chorus::core
