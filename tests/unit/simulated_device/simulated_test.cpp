#include "services/sensor/device/simulated/simulated.h"

#include "common/synthetic/scene.h"
#include "services/sensor/device/simulated/scene_settings.h"

#include <gmock/gmock.h>

#include <condition_variable>
#include <mutex>
#include <thread>

namespace chorus::sensor_service {
namespace {

using testing::HasSubstr;

constexpr Timestamp kStart = from_unix_ns(1'795'000'000'000'000'000);

Result<std::unique_ptr<FrameSource>> device(std::string_view json, std::string_view id,
                                            std::shared_ptr<const Clock> clock,
                                            const synthetic::HostClock& host = {}) {
  ConfigReader config = ConfigReader::parse(json, "test").value();
  auto made = make_simulated(config, SensorId::parse(id).value(), {std::move(clock), host});
  if (const auto ok = config.finish(); !ok) return pass(ok);
  return made;
}

/// A clock that is always slightly later than at the last call: time passes without waiting.
class HastyClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const override {
    return kStart + std::chrono::milliseconds(20) * ++asked_;
  }

 private:
  mutable std::atomic<int> asked_{0};
};

std::vector<Capture> first_captures(FrameSource& source, std::size_t count) {
  std::vector<Capture> captures;
  std::stop_source stop;
  const auto done = source.run(stop.get_token(), [&](Capture capture) {
    captures.push_back(std::move(capture));
    if (captures.size() >= count) stop.request_stop();
  });
  EXPECT_TRUE(done);
  return captures;
}

TEST(Simulated, TwoProcessesSeeTheSamePersonWhereverTheyStand) {
  const auto run = [](std::string_view json, std::string_view id) {
    auto source = device(json, id, std::make_shared<HastyClock>());
    return first_captures(**source, 10);
  };
  const auto front =
      run(R"({"ring": {"index": 0}, "noise": {"along_mm": 0, "across_mm": 0}})", "s1");
  const auto side =
      run(R"({"ring": {"index": 1}, "noise": {"along_mm": 0, "across_mm": 0}})", "s2");
  ASSERT_EQ(front.size(), 10u);
  ASSERT_EQ(side.size(), 10u);
  const synthetic::Ring ring;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const auto in_world = [&](const Capture& capture, std::size_t place) {
      const auto& body = capture.frame.bodies.at(0).skeleton;
      return Eigen::Vector3d(ring_place(ring, place) * body[JointId::Neck].position);
    };
    // The two frames are captured up to one frame interval apart; the person walks at 0.9 m/s.
    EXPECT_LT((in_world(front[i], 0) - in_world(side[i], 1)).norm(), 0.06);
    EXPECT_NE(front[i].frame.captured, side[i].frame.captured);
  }
}

TEST(Simulated, AHostsClockErrorMovesTheStampsAndNothingElse) {
  const auto run = [](double offset) {
    auto source = device("{}", "s1", std::make_shared<HastyClock>(), {.offset = offset});
    return first_captures(**source, 5);
  };
  const auto right = run(0.0);
  const auto ahead = run(0.3);
  for (std::size_t i = 0; i < right.size(); ++i) {
    EXPECT_EQ(ahead[i].frame.captured - right[i].frame.captured, std::chrono::milliseconds(300));
    EXPECT_EQ(ahead[i].frame.bodies.at(0).captured, ahead[i].frame.captured);
    EXPECT_EQ(ahead[i].frame.bodies.at(0).skeleton[JointId::Neck].position,
              right[i].frame.bodies.at(0).skeleton[JointId::Neck].position);
  }
}

TEST(Simulated, ADriftingClockThatIsSteppedStampsEverythingAlike) {
  synthetic::HostClock host{.offset = -1.0, .drift = 1e-3, .step = 5.0, .origin = kStart};
  host.step_at = kStart + std::chrono::milliseconds(500);
  const auto run = [](const synthetic::HostClock& clock) {
    auto source = device("{}", "s1", std::make_shared<HastyClock>(), clock);
    return first_captures(**source, 40);
  };
  const auto right = run({});
  const auto wrong = run(host);
  EXPECT_GT(right.back().frame.captured, host.step_at) << "the step is within the test";
  for (std::size_t i = 0; i < right.size(); ++i) {
    EXPECT_EQ(wrong[i].frame.captured, host.host_time(right[i].frame.captured)) << i;
    EXPECT_EQ(wrong[i].frame.received, host.host_time(right[i].frame.received)) << i;
  }
  const auto image = wrong.back().depth();
  ASSERT_TRUE(image);
  EXPECT_EQ(image->captured, wrong.back().frame.captured);
}

TEST(Simulated, ProfilesOfTheJudgeAreDevicesToo) {
  auto source =
      device(R"({"profile": "A", "profile_draw": 3})", "s1", std::make_shared<HastyClock>());
  ASSERT_TRUE(source) << to_string(source.error());
  EXPECT_THAT((*source)->describe().label, HasSubstr("profile A "));
  const auto captures = first_captures(**source, 20);
  ASSERT_EQ(captures.size(), 20u);
  EXPECT_FALSE(captures.back().frame.bodies.empty());
  // The profile's own latency passes before a frame is delivered.
  EXPECT_GT(captures.back().frame.received - captures.back().frame.captured,
            std::chrono::milliseconds(20));
}

TEST(Simulated, SensorsOfTheSameSeedErrEachOnItsOwn) {
  for (const char* profile : {R"({"profile": "A"})", R"({"profile": "C"})"}) {
    const auto run = [&](std::string_view id) {
      auto source = device(profile, id, std::make_shared<HastyClock>());
      return first_captures(**source, 20);
    };
    const auto one = run("s1");
    const auto other = run("s2");
    const auto neck = [](const Capture& capture) {
      return capture.frame.bodies.at(0).skeleton[JointId::Neck].position;
    };
    ASSERT_FALSE(one.back().frame.bodies.empty() || other.back().frame.bodies.empty()) << profile;
    EXPECT_NE(one.back().frame.captured, other.back().frame.captured) << profile;
    EXPECT_GT((neck(one.back()) - neck(other.back())).norm(), 1e-3) << profile;
  }
}

TEST(Simulated, DeliversInOrderAfterCaptureWithoutGaps) {
  auto source = device(R"({"latency_ms": 20})", "s1", std::make_shared<HastyClock>());
  const auto captures = first_captures(**source, 30);
  ASSERT_EQ(captures.size(), 30u);
  for (std::size_t i = 0; i < captures.size(); ++i) {
    const SensorFrame& frame = captures[i].frame;
    EXPECT_EQ(frame.sequence, i + 1);
    EXPECT_EQ(frame.sensor.str(), "s1");
    EXPECT_GE(frame.received - frame.captured, std::chrono::milliseconds(20));
    EXPECT_TRUE(i == 0 || frame.captured > captures[i - 1].frame.captured);
    ASSERT_TRUE(frame.floor);
    EXPECT_NEAR(frame.floor->offset, 1.6, 0.05);
  }
}

TEST(Simulated, SequenceCountsDroppedFramesToo) {
  auto source = device(R"({"noise": {"drop_percent": 50}})", "s1", std::make_shared<HastyClock>());
  const auto captures = first_captures(**source, 20);
  EXPECT_GT(captures.back().frame.sequence, 25u);
  EXPECT_LT(captures.back().frame.sequence, 80u);
}

TEST(Simulated, ImagesAreRenderedOnDemand) {
  auto source = device("{}", "s1", std::make_shared<HastyClock>());
  const auto captures = first_captures(**source, 1);
  source->reset();  // an image may be requested after the device is gone
  const auto depth = captures[0].depth();
  ASSERT_TRUE(depth) << to_string(depth.error());
  EXPECT_EQ(depth->captured, captures[0].frame.captured);
  EXPECT_EQ(depth->media_type, "image/png");
  EXPECT_EQ(captures[0].color()->media_type, "image/jpeg");
}

TEST(Simulated, AClockThatStepsNeitherFreezesNorFloodsIt) {
  const auto clock = std::make_shared<FakeClock>(kStart);
  auto source = device("{}", "s1", clock);
  std::mutex mutex;
  std::condition_variable arrived;
  std::vector<Timestamp> captured;
  std::jthread runner([&](std::stop_token stop) {
    (void)(*source)->run(stop, [&](Capture capture) {
      const std::lock_guard lock(mutex);
      captured.push_back(capture.frame.captured);
      arrived.notify_one();
    });
  });
  // Sets the clock and lets it run until a frame captured since then has come; false if none
  // comes.
  const auto delivers_from = [&](Timestamp now) {
    clock->set(now);
    for (int i = 0; i < 2000; ++i) {
      clock->advance(std::chrono::milliseconds(1));
      std::unique_lock lock(mutex);
      arrived.wait_for(lock, std::chrono::milliseconds(5));
      if (!captured.empty() && captured.back() >= now && captured.back() <= clock->now())
        return true;
    }
    return false;
  };
  EXPECT_TRUE(delivers_from(kStart));
  EXPECT_TRUE(delivers_from(kStart + std::chrono::hours(1)));
  EXPECT_TRUE(delivers_from(kStart - std::chrono::hours(1)));
  runner.request_stop();
  runner.join();
  EXPECT_LT(captured.size(), 200u) << "two hours were jumped, not played";
}

TEST(Simulated, EveryPathGoesByItsName) {
  std::vector<Eigen::Vector3d> hands;
  for (const std::string_view path : synthetic::kPathNames) {
    auto source = device(R"({"scene": {"path": ")" + std::string(path) + R"("}})", "s1",
                         std::make_shared<HastyClock>());
    ASSERT_TRUE(source) << path;
    const auto captures = first_captures(**source, 1);
    ASSERT_EQ(captures.size(), 1u) << path;
    ASSERT_EQ(captures[0].frame.bodies.size(), 1u) << path;
    hands.push_back(captures[0].frame.bodies[0].skeleton[JointId::HandLeft].position);
  }
  for (std::size_t i = 0; i < hands.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(hands[i], hands[j]) << i << " is not " << j;
  }
}

TEST(Simulated, PlaysAMotionFileThatAllSensorsSeeAlike) {
  const auto run = [](int index) {
    const std::string json = R"({"scene": {"motion": "common/motion/assets/02_02.amc"},
        "noise": {"along_mm": 0, "across_mm": 0}, "ring": {"index": )" +
                             std::to_string(index) + "}}";
    auto source = device(json, "s" + std::to_string(index), std::make_shared<HastyClock>());
    EXPECT_THAT((*source)->describe().label, HasSubstr("motion of 02_02.amc"));
    return first_captures(**source, 10);
  };
  const auto front = run(0);
  const auto side = run(1);
  const synthetic::Ring ring;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const auto in_world = [&](const Capture& capture, std::size_t place) {
      const auto& body = capture.frame.bodies.at(0).skeleton;
      return Eigen::Vector3d(ring_place(ring, place) * body[JointId::Neck].position);
    };
    // The two frames are captured up to one frame interval apart; the person walks at 1.3 m/s.
    EXPECT_LT((in_world(front[i], 0) - in_world(side[i], 1)).norm(), 0.08);
  }
}

/// Number of tracked joints of the person in the middle of the ring.  Ignores nearer bodies: the
/// fitter of profile C knows no background and may take a pillar for a person.
int tracked_joints(const std::string& profile, const std::string& occluders) {
  constexpr double kNearest = 2.2;  // [m]
  const std::string json = R"({"profile": ")" + profile +
                           R"(", "scene": {"path": "stand", "occluders": )" + occluders + "}}";
  auto source = device(json, "s1", std::make_shared<HastyClock>());
  EXPECT_TRUE(source) << to_string(source.error());
  int tracked = 0;
  for (const Capture& capture : first_captures(**source, 30)) {
    for (const BodyFrame& body : capture.frame.bodies) {
      for (const Joint& joint : body.skeleton.joints) {
        tracked += joint.state == JointState::Tracked && joint.position.z() > kNearest ? 1 : 0;
      }
    }
  }
  return tracked;
}

TEST(Simulated, APillarInTheWayHidesThePersonFromEveryProfile) {
  for (const std::string profile : {"gauss", "A", "C", "D"}) {
    const int free = tracked_joints(profile, "[]");
    EXPECT_GT(free, 15 * 25) << profile;
    EXPECT_LT(tracked_joints(profile, R"([{"kind": "pillar", "z_m": 1.5}])"), free / 3) << profile;
    EXPECT_GT(tracked_joints(profile, R"([{"kind": "pillar", "z_m": -1.5}])"), free / 2)
        << profile << ": it stands behind";
  }
}

TEST(Simulated, ThingsAreReadWithTheirUsualSizes) {
  auto config = ConfigReader::parse(R"({"occluders": [
      {"kind": "table"},
      {"kind": "car", "length_m": 4, "x_m": 1, "y_m": 0.5, "z_m": 2, "yaw_deg": 90,
       "travel_x_m": 3, "period_s": 10}]})",
                                    "test")
                    .value();
  const SceneSettings settings = read_scene(config);
  ASSERT_TRUE(config.finish());
  ASSERT_EQ(settings.scene.occluders.size(), 2u);
  const synthetic::Occluder& table = settings.scene.occluders[0];
  EXPECT_TRUE(table.half.isApprox(Eigen::Vector3d(0.6, 0.375, 0.4)));
  EXPECT_NEAR(table.world_from_box.translation().y(), 0.375, 1e-12);
  const synthetic::Occluder& car = settings.scene.occluders[1];
  EXPECT_TRUE(car.half.isApprox(Eigen::Vector3d(0.4, 0.6, 2)));
  EXPECT_TRUE(
      place_of(car, std::chrono::seconds(5)).translation().isApprox(Eigen::Vector3d(4, 1.1, 2)));
}

TEST(Simulated, WrongConfigIsNamed) {
  const auto clock = std::make_shared<FakeClock>(kStart);
  const std::pair<std::string_view, std::string_view> cases[] = {
      {R"({"ring": {"index": 6}})", "ring.count"},
      {R"({"ring": {}, "pose": {}})", "either ring or pose"},
      {R"({"scene": {"path": "zigzag"}})", "scene.path"},
      {R"({"scene": {"sped_m_per_s": 1}})", "speed_m_per_s"},
      {R"({"noise": {"along_mm": -1}})", "noise.along_mm"},
      {R"({"latency_ms": 1e9})", "latency_ms"},
      {R"({"profile": "Z"})", "profile"},
      {R"({"scene": {"motion": "walk.fbx"}})", "scene.motion"},
      {R"({"scene": {"motion": "/no/such.bvh"}})", "/no/such.bvh"},
      {R"({"scene": {"occluders": [{"kind": "wall"}]}})", "occluders"},
      {R"({"scene": {"occluders": [{"x_m": 1}]}})", "car, pillar or table"},
      {R"({"scene": {"occluders": [{"kind": "car", "size_m": 1}]}})", "size_m"},
  };
  for (const auto& [json, named] : cases) {
    const auto made = device(json, "s1", clock);
    ASSERT_FALSE(made) << json;
    EXPECT_THAT(to_string(made.error()), HasSubstr(std::string(named)));
  }
  ConfigReader empty = ConfigReader::parse("{}", "test").value();
  EXPECT_FALSE(make_simulated(empty, SensorId::parse("s1").value(), {}));
}

}  // namespace
}  // namespace chorus::sensor_service
