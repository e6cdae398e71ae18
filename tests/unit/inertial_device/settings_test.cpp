// The keys of device.inertial: what is refused, by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/sensor/device/inertial/inertial.h"
#include "tests/support/builders.h"

namespace chorus::inertial_device {
namespace {

using ::testing::HasSubstr;

/// What is wrong with this section; empty if nothing.
std::string wrong_with(const std::string& section) {
  auto reader = ConfigReader::parse(section, "test");
  if (!reader) return to_string(reader.error());
  check_inertial_settings(*reader, chorus::testing::sensor_id("suit"));
  const auto done = reader->finish();
  return done ? "" : to_string(done.error());
}

TEST(InertialSettings, EverySourceAndEveryFaultIsTaken) {
  for (const std::string source :
       {"simulated", "replay", "slimevr", "mocopi", "vmc", "vrchat", "rokoko", "neuron", "mxtp"})
    EXPECT_EQ(wrong_with(R"({"source":")" + source + R"(","port":0})"), "");
  EXPECT_EQ(wrong_with(R"({"sensors":5,"skin":1,"raw":true,"faults":[
    {"kind":"slip","limb":"ForearmLeft","begin_s":20,"size_deg":60},
    {"kind":"disturbance","limb":"Pelvis","begin_s":2,"lasts_s":10,"size_deg":-40},
    {"kind":"battery","limb":"ShankRight","begin_s":60},{"kind":"silence","limb":"Chest"},
    {"kind":"swap","limb":"ShankLeft","other":"ShankRight"},
    {"kind":"lie","limb":"Chest","factor":0.1}]})"),
            "");
}

TEST(InertialSettings, MistakesAreNamed) {
  EXPECT_THAT(wrong_with(R"({"source":"kinect"})"), HasSubstr("source"));
  EXPECT_THAT(wrong_with(R"({"sensors":8})"), HasSubstr("5, 6 or 13"));
  EXPECT_THAT(wrong_with(R"({"faults":[{"kind":"slip","limb":"Tail"}]})"), HasSubstr("limb"));
  EXPECT_THAT(wrong_with(R"({"faults":[{"kind":"swap","limb":"ShankLeft"}]})"), HasSubstr("other"));
  EXPECT_THAT(wrong_with(R"({"faults":[{"kind":"melts","limb":"Chest"}]})"), HasSubstr("kind"));
  EXPECT_THAT(wrong_with(R"({"slips":"Tail"})"), HasSubstr("slips"));
}

}  // namespace
}  // namespace chorus::inertial_device
