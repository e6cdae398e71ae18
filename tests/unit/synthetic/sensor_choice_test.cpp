#include "common/synthetic/sensor_choice.h"

#include <gtest/gtest.h>

#include "common/synthetic/kinect/kinect_sensor.h"

namespace chorus::synthetic {
namespace {

constexpr Timestamp kChoiceStart = from_unix_ns(1'795'000'000'000'000'000);
constexpr Timestamp kEnd = kChoiceStart + std::chrono::seconds(10);

Scene room() {
  WalkerScript script;
  script.centre = {0.0, 2.6};
  script.reach = 0.5;
  Scene scene;
  scene.people = make_people(script, 1);
  scene.world_from_sensor = {stand_sensor({0, 1.2, 0}, 0.0, deg(5))};
  return scene;
}

SensorChoice choice(std::string profile) {
  SensorChoice chosen;
  chosen.id = *SensorId::parse("s1");
  chosen.profile = std::move(profile);
  return chosen;
}

std::vector<Eigen::Vector3d> necks(const std::vector<SensorFrame>& frames) {
  std::vector<Eigen::Vector3d> all;
  for (const SensorFrame& frame : frames) {
    for (const BodyFrame& body : frame.bodies) {
      all.push_back(body.skeleton[JointId::Neck].position);
    }
  }
  return all;
}

std::vector<Eigen::Vector3d> recorded(const Scene& scene, const SensorChoice& chosen) {
  return necks(record(scene, chosen, kChoiceStart, kEnd).value());
}

TEST(SensorChoice, NominalAIsTheKinectSensorOfProfileA) {
  const Scene scene = room();
  const auto direct =
      kinect::record(scene, {*SensorId::parse("s1"), 0, kinect::nominal_profile("A"), 1, 1, true},
                     kChoiceStart, kEnd);
  ASSERT_GT(direct.size(), 100u);
  EXPECT_EQ(recorded(scene, choice("A")), necks(direct));
}

TEST(SensorChoice, ProfilesDrawsAndSeedsDiffer) {
  const Scene scene = room();
  const auto nominal = recorded(scene, choice("A"));
  EXPECT_NE(nominal, recorded(scene, choice("B")));
  SensorChoice drawn = choice("A");
  drawn.draw = 7;
  const auto once = recorded(scene, drawn);
  EXPECT_NE(nominal, once);
  EXPECT_EQ(once, recorded(scene, drawn));
  SensorChoice other = choice("A");
  other.seed = 2;
  EXPECT_NE(nominal, recorded(scene, other));
}

TEST(SensorChoice, ProfileCIsRenderedAndFitted) {
  const Scene scene = room();
  const auto nominal = recorded(scene, choice("C"));
  ASSERT_GT(nominal.size(), 100u);
  EXPECT_NE(nominal, recorded(scene, choice("A")));
  SensorChoice drawn = choice("C");
  drawn.draw = 7;
  EXPECT_NE(nominal, recorded(scene, drawn));
  SensorChoice quiet = choice("C");
  quiet.stress = {{Source::White, 0.0}};
  EXPECT_NE(nominal, recorded(scene, quiet));
}

TEST(SensorChoice, GaussIsThePlainModel) {
  const Scene scene = room();
  SensorChoice chosen = choice("gauss");
  chosen.gauss.seed = 7;
  const auto sensor = make_sensor(scene, chosen, kChoiceStart);
  ASSERT_TRUE(sensor.has_value());
  const SimulatedSensor plain{chosen.id, 0, chosen.gauss};
  EXPECT_EQ(necks({*(*sensor)->next()}),
            necks({*observe(scene, plain, first_frame_from(plain, kChoiceStart))}));
  EXPECT_EQ((*sensor)->clock().offset, 0.0);
  SensorChoice other = chosen;
  other.gauss.seed = 8;
  EXPECT_NE(recorded(scene, chosen), recorded(scene, other));
}

TEST(SensorChoice, StressMultipliesItsSourceAlone) {
  const Scene scene = room();
  SensorChoice stressed = choice("B");
  stressed.stress = {{Source::Clock, 0.0}};
  const auto sensor = make_sensor(scene, stressed, kChoiceStart);
  ASSERT_TRUE(sensor.has_value());
  EXPECT_EQ((*sensor)->clock().offset, 0.0);
  const auto plain = make_sensor(scene, choice("B"), kChoiceStart);
  EXPECT_NE((*plain)->clock().offset, 0.0);
  EXPECT_EQ((*plain)->next_exposure(), (*sensor)->next_exposure());
}

TEST(SensorChoice, RefusesWhatItDoesNotHave) {
  const Scene scene = room();
  EXPECT_EQ(make_sensor(scene, choice("Z"), kChoiceStart).error().code, ErrorCode::InvalidArgument);
  SensorChoice nowhere = choice("A");
  nowhere.place = 1;
  EXPECT_EQ(make_sensor(scene, nowhere, kChoiceStart).error().code, ErrorCode::InvalidArgument);
  EXPECT_FALSE(record(scene, nowhere, kChoiceStart, kEnd).has_value());
}

TEST(SensorChoice, TellsWhichParametersMadeTheNumbers) {
  EXPECT_EQ(frozen_hash("A"), kinect::frozen_hash());
  EXPECT_EQ(frozen_hash("D"), kinect::frozen_hash());
  EXPECT_EQ(frozen_hash("C").size(), 12u);
  EXPECT_NE(frozen_hash("C"), frozen_hash("A"));
  EXPECT_EQ(frozen_hash("gauss"), "");
  EXPECT_EQ(frozen_hash("Z"), "");
}

}  // namespace
}  // namespace chorus::synthetic
