// chorus characterise, from recordings to a report and two profiles.
#include <fstream>

#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "fusion-server/pipeline/offline.h"
#include "services/ctl/line/offline_options.h"
#include "tests/unit/characteristics/turning_person.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using chorus::testing::IsOk;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Somebody who turns before one sensor that takes everybody for facing it and sees them too near.
class TurnRecorded {
 public:
  TurnRecorded() { add("s1"); }
  void add(const std::string& sensor) const {
    characteristics::TurnSpec spec;
    spec.out = deg(130);
    spec.back = deg(60);
    spec.bias = mm(30);
    spec.along = mm(6);
    spec.across = mm(2);
    record::FrameRecording recording;
    recording.sensor = chorus::testing::sensor_id(sensor);
    recording.device = "test";
    recording.frames = characteristics::record_turn(spec);
    for (SensorFrame& frame : recording.frames) frame.sensor = recording.sensor;
    const std::string name = sensor == "s1" ? "turn.mcap" : sensor + ".mcap";
    EXPECT_THAT(record::write_frame_recording(file(name), recording), IsOk());
  }
  [[nodiscard]] std::string file(const std::string& name) const {
    return (folder_ / name).string();
  }

 private:
  chorus::testing::TemporaryFolder folder_;
};

TEST(CharacteriseCommand, SaysThatPlacesOfOtherSensorsAreNotUsed) {
  const TurnRecorded recorded;
  recorded.add("s2");
  std::ofstream(recorded.file("registration.json"))
      << R"({"sensors": {"other": {"x": 0, "y": 1, "z": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}})";
  const Outcome done = run_chorus({"characterise", recorded.file("")});
  EXPECT_THAT(done.out + done.error, HasSubstr("is of other sensors, and is not used"));
}

TEST(CharacteriseCommand, WritesWhatFusionAndSimulationCanLoad) {
  const TurnRecorded recorded;
  const Outcome done = run_chorus({"characterise", recorded.file("turn.mcap"), "--distance", "2.5",
                                   "--distance-sigma", "0.005", "--out", recorded.file("kind")});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.out, HasSubstr("it takes everybody for facing it"));
  EXPECT_THAT(done.out, HasSubstr("mm +- 5 too near"));
  OfflineOptions options;
  options.config = recorded.file("kind/fusion-profile.json");
  const auto told = offline_config(options);
  ASSERT_THAT(told, IsOk());
  EXPECT_NEAR(told->registration.depth_bias, mm(30), mm(2));
  EXPECT_NEAR(told->registration.depth_bias_sigma, mm(5), mm(2));
  EXPECT_EQ(told->pipeline.fusion.noise, pipeline::OfflineConfig().pipeline.fusion.noise);
  const Json simulated = Json::parse(
      chorus::testing::bytes_of(recorded.file("kind/sensor-profile.json")), nullptr, true, true);
  const Json& device = simulated.at("device").at("simulated");
  EXPECT_NEAR(device.at("noise").at("along_mm").get<double>(), 6, 0.5);
  EXPECT_NEAR(device.at("noise").at("across_mm").get<double>(), 2, 0.2);
  const Outcome again =
      run_chorus({"characterise", recorded.file("turn.mcap"), "--out", recorded.file("kind")});
  EXPECT_EQ(again.code, kExitFailed) << "a profile is never overwritten";
}

TEST(CharacteriseCommand, ReportsAsJson) {
  const TurnRecorded recorded;
  const Outcome done = run_chorus({"characterise", recorded.file("turn.mcap"), "--json"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  const Json sensor = Json::parse(done.out).at("sensors").at(0);
  EXPECT_EQ(sensor.at("frontRear"), "takes-for-facing");
  EXPECT_NEAR(sensor.at("exchangedAtDegrees").at(0).get<double>(), 130, 4);
  EXPECT_FALSE(sensor.contains("depthBias"));
}

TEST(CharacteriseCommand, AWalkBeforeSeveralSensorsSaysHowTheyDiffer) {
  const Cell cell(8.0);
  const Outcome done = run_chorus({"characterise", cell.recordings(), "--json"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  const Json report = Json::parse(done.out);
  EXPECT_LT(report.at("agreement").at("acrossMillimetres").get<double>(), 5.0);
  EXPECT_GT(report.at("agreement").at("pairs").get<int>(), 100);
  EXPECT_LT(std::abs(report.at("walkedDepthBias").at("millimetres").get<double>()),
            2 * report.at("walkedDepthBias").at("sigmaMillimetres").get<double>());
  EXPECT_THAT(report.at("notes").dump(), HasSubstr("stays on one spot"));
}

TEST(CharacteriseCommand, ATurnIsWithinTheRecording) {
  const TurnRecorded cell;
  const Outcome after = run_chorus({"characterise", cell.file("turn.mcap"), "--turn", "4,3000"});
  EXPECT_EQ(after.code, kExitFailed);
  EXPECT_THAT(after.error, HasSubstr("4,3000 ends after the recording, which is "));
  for (const char* wrong : {"4", "30,10", "a,b"}) {
    const Outcome done = run_chorus({"characterise", cell.file("turn.mcap"), "--turn", wrong});
    EXPECT_EQ(done.code, kExitUsage) << wrong;
    EXPECT_THAT(done.error, HasSubstr("write it as 4,28"));
  }
}

TEST(CharacteriseCommand, ASensorThatIsNotThereIsAnsweredWithThoseThatAre) {
  const TurnRecorded cell;
  const Outcome done = run_chorus({"characterise", cell.file("turn.mcap"), "--sensor", "s9"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("no frames of s9, but of s1"));
}

TEST(CharacteriseCommand, ADistanceIsThatOfOneSensor) {
  const Cell cell(8.0);
  const Outcome done = run_chorus({"characterise", cell.recordings(), "--distance", "2.5"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("name which with --sensor"));
  const Outcome walk = run_chorus({"characterise", cell.recordings(), "--sensor", "s1"});
  EXPECT_EQ(walk.code, kExitFailed);
  EXPECT_THAT(walk.error, HasSubstr("stays on one spot"));
}

}  // namespace
}  // namespace chorus::ctl
