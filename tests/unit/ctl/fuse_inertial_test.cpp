// chorus fuse with what worn inertial sensors said: beside the recordings, or in them.
#include <filesystem>

#include <nlohmann/json.hpp>

#include "common/record/cell_writer.h"
#include "common/synthetic/exercise.h"
#include "common/synthetic/simulated_suit.h"
#include "fusion-server/wire/registration_file.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;
namespace support = chorus::testing;

constexpr double kTakeLength = 24.0;  // [s]
// [s] in which nobody sees the left arm's end: before any sensor can be calibrated live, and at the
// end.
struct Hidden {
  double from;
  double to;
};
constexpr Hidden kEarly{0.5, 3.0};
constexpr Hidden kLate{21.0, kTakeLength};

bool holds(const Hidden& hidden, double time) { return time >= hidden.from && time < hidden.to; }

/// Somebody who exercises before three exact sensors, wearing thirteen inertial ones.
class WornTake {
 public:
  WornTake() {
    std::filesystem::create_directory(folder_ / "rec");
    scene_.epoch = support::kStart;
    scene_.people = {synthetic::exercising(synthetic::make_people({}, 1).front())};
    Registration places;
    places.version = 1;
    for (int i = 0; i < kRing; ++i) record_sensor(i, places);
    places.master = support::sensor_id("s1");
    folder_.write("places.json", wire::write_registration(places));
    record_suit();
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// Mean errors of the left wrist while it is hidden [m]; none where it has no place then.
  struct Errors {
    std::optional<double> early, late;
  };
  /// Fuses with these words added.
  Errors hidden_errors(const std::vector<std::string>& more, Outcome& done) {
    std::vector<std::string> words{"fuse",           at("rec"),         "--out", "-",
                                   "--registration", at("places.json"), "--json"};
    words.insert(words.end(), more.begin(), more.end());
    done = run_chorus(words);
    return {error_in({kEarly.from + 1.2, kEarly.to}, done.out),
            error_in({kLate.from + 1.2, kLate.to}, done.out)};
  }

 private:
  [[nodiscard]] std::optional<double> error_in(const Hidden& span, const std::string& lines) const {
    double sum = 0.0;
    double count = 0.0;
    for (const std::string& line : lines_of(lines)) {
      const Json frame = Json::parse(line);
      const Timestamp instant =
          from_unix_ns(std::stoll(frame.at("capturedNanoseconds").get<std::string>()));
      if (!holds(span, seconds(instant - support::kStart)) || frame.at("bodies").empty()) continue;
      const Json& wrist = frame.at("bodies")[0].at("joints").at("WristLeft");
      if (!wrist.contains("x")) continue;
      const Eigen::Vector3d there(wrist.at("x"), wrist.at("y"), wrist.at("z"));
      sum += (there - truth(scene_, 0, instant)[JointId::WristLeft].position).norm();
      count += 1.0;
    }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
  }
  void record_sensor(int index, Registration& places) {
    using enum JointId;
    const Eigen::Isometry3d place = support::ring_sensor(index, kRing);
    const std::string name = "s" + std::to_string(index + 1);
    places.sensors[support::sensor_id(name)].world_from_sensor = place;
    record::FrameRecording recording;
    recording.sensor = support::sensor_id(name);
    recording.device = "test";
    recording.floor = support::floor_seen_from(place);
    recording.notes["set_origin"] = to_iso8601(support::kStart);
    for (int i = 0; i < static_cast<int>(30.0 * kTakeLength); ++i) {
      const Timestamp captured = support::kStart + i * support::kFrameInterval;
      auto body = support::body_seen_from(place, truth(scene_, 0, captured), captured);
      for (const JointId id : {WristLeft, HandLeft, HandTipLeft, ThumbLeft})
        if (holds(kEarly, i / 30.0) || holds(kLate, i / 30.0)) body.skeleton[id] = {};
      recording.frames.push_back(support::sensor_frame(name, captured, {std::move(body)}));
    }
    EXPECT_THAT(record::write_frame_recording(folder_ / "rec" / (name + ".mcap"), recording),
                support::IsOk());
  }
  void record_suit() {
    const SensorId id = support::sensor_id("suit");
    auto writer = record::CellWriter::create(folder_ / "suit.mcap", {});
    ASSERT_THAT(writer, support::IsOk());
    const synthetic::SimulatedSuit suit{scene_, 0, synthetic::limbs_of_suit(13), 50.0, 3, {}};
    for (int i = 0; i < static_cast<int>(50.0 * kTakeLength); ++i) {
      const Timestamp captured = support::kStart + from_seconds(0.02 * i);
      auto said = std::make_shared<resource::OrientationsResource>();
      said->sequence = static_cast<std::uint64_t>(i) + 1;
      said->captured = captured;
      said->source = "suit";
      said->instants = {suit_at(suit, support::kStart, captured, said->sequence)};
      ASSERT_THAT(writer->write(record::RawOrientations{
                      id, std::move(said), captured,
                      record::ClockModel{Duration{0}, Duration{0}, Duration{0}}}),
                  support::IsOk());
    }
    ASSERT_THAT(writer->close(), support::IsOk());
  }

  support::TemporaryFolder folder_;
  synthetic::Scene scene_;
};

TEST(FuseInertial, AHiddenLimbGoesOnByItsRecordedSensor) {
  WornTake take;
  Outcome done;
  const auto with = take.hidden_errors({"--inertial", take.at("suit.mcap")}, done);
  ASSERT_EQ(done.code, kExitOk) << done.error;
  ASSERT_TRUE(with.late) << done.error;
  EXPECT_LT(*with.late, 0.06);
  ASSERT_TRUE(with.early) << "a calibration serves from the beginning";
  EXPECT_LT(*with.early, 0.1);
  const Json worn = Json::parse(done.error).at("inertial").at("suit");
  EXPECT_EQ(worn.at("wearer"), 1);
  EXPECT_TRUE(worn.at("sensors").at("tracker-ForearmLeft").at("calibrated"));
  EXPECT_GE(Json::parse(done.error).at("calibrationsCarriedBack"), 10);

  // In the recordings they are used once that is switched on, and named until then.
  std::filesystem::copy_file(take.at("suit.mcap"), take.at("rec/suit.mcap"));
  const auto alone = take.hidden_errors({}, done);
  EXPECT_TRUE(!alone.late || *alone.late > 0.15);
  EXPECT_TRUE(!alone.early || *alone.early > 0.15);
  EXPECT_THAT(done.error, HasSubstr("--set fusion.inertial.enabled=true lets them help"));
  const auto live =
      take.hidden_errors({"--set", "fusion.inertial.enabled=true", "--as-live"}, done);
  ASSERT_TRUE(live.late) << done.error;
  EXPECT_LT(*live.late, 0.06);
  EXPECT_TRUE(!live.early || *live.early > 0.15) << "live, nothing is known so early";
}

TEST(FuseInertial, ARecordingWithoutSensorsOnAnybodyIsRefusedByName) {
  const Cell cell(2.0);
  const Outcome done = run_chorus(
      {"fuse", cell.recordings(), "--out", "-", "--inertial", cell.recordings() + "/s1.mcap"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("s1.mcap"));
  EXPECT_THAT(done.error, HasSubstr("chorus import inertial"));
}

}  // namespace
}  // namespace chorus::ctl
