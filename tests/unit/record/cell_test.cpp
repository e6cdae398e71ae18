#include "common/record/cell_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/builders.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/record/cell_rig.h"

namespace chorus::record {
namespace {

using chorus::testing::bytes_of;
using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using chorus::testing::TemporaryFolder;
using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::shared_ptr<const resource::FrameResource> seen_by(const char* sensor, int i) {
  const Timestamp t = kStart + kFrameInterval * i;
  const auto pose = chorus::testing::ring_sensor(1, 4);
  const auto person = chorus::testing::standing_person({0.0137 * i, 0, 0}, 0.1 * i);
  auto frame = chorus::testing::sensor_frame(sensor, t,
                                             {chorus::testing::body_seen_from(pose, person, t, 3)});
  frame.sequence = static_cast<std::uint64_t>(i) + 1;
  chorus::testing::hide(frame.bodies[0].skeleton[JointId::FootLeft]);
  return std::make_shared<const resource::FrameResource>(resource::to_resource(frame));
}

RawFrame raw(const char* sensor, int i, Duration applied = Duration{0}) {
  return raw_frame(sensor, seen_by(sensor, i), applied);
}

FusedFrame fused(int i) {
  const Timestamp t = kStart + kFrameInterval * i;
  return {t, t + milliseconds(20), [i] {
            resource::FrameResource frame = *seen_by("s1", i);
            frame.source = "fusion";
            frame.space = resource::SpaceKind::World;
            frame.sensors = {"s1", "s2"};
            for (auto& joint : frame.bodies[0].joints) joint.contributors = 3;
            return frame;
          }};
}

PlacesChanged places(const std::string& json) {
  return {kStart, json, {{"s1", chorus::testing::ring_sensor(1, 4)}}};
}

void write_cell(const std::filesystem::path& path) {
  write_cell(path, places(R"({"version":1,"sensors":{}})"), seen_by, fused);
}

TEST(CellRecording, GivesBackEverySensorsFramesByTheRecordersClock) {
  const TemporaryFolder folder;
  write_cell(folder / "a.mcap");
  const auto cell = read_cell(folder / "a.mcap");
  ASSERT_TRUE(cell) << to_string(cell.error());
  ASSERT_THAT(cell->sensors, SizeIs(2));
  EXPECT_EQ(cell->sensors[0].sensor.str(), "s1");
  EXPECT_EQ(cell->sensors[1].sensor.str(), "s2");
  ASSERT_THAT(cell->sensors[1].frames, SizeIs(40));
  for (int i = 0; i < 40; ++i) {
    const auto& one = cell->sensors[0].frames[static_cast<std::size_t>(i)];
    const auto& two = cell->sensors[1].frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(one.captured, kStart + kFrameInterval * i);
    EXPECT_EQ(two.captured, one.captured + milliseconds(i < 20 ? 400 : 410));
    EXPECT_EQ(two.bodies[0].captured, two.captured);
    EXPECT_EQ(one.received, one.captured + milliseconds(5));
    ASSERT_TRUE(one.floor);
    EXPECT_EQ(one.floor->offset, 1.25);
  }
  EXPECT_THAT(cell->registrations, ElementsAre(R"({"version":1,"sensors":{}})"));
  EXPECT_THAT(cell->fused, SizeIs(0)) << "only when asked for";
}

TEST(CellRecording, RawFramesAreByteForByteWhatTheSensorSaid) {
  const TemporaryFolder folder;
  write_cell(folder / "a.mcap");
  const auto file = read_recording(folder / "a.mcap");
  ASSERT_TRUE(file);
  int i = 0;
  for (const Message& message : file->messages) {
    if (message.topic != "/sensors/s2/frame") continue;
    const auto said = resource::write(*seen_by("s2", i), resource::Format::Json);
    EXPECT_EQ(message.data, said);
    EXPECT_EQ(message.publish_time, kStart + kFrameInterval * i) << "its own clock";
    const auto again = resource::read_frame(message.data, resource::Format::Json);
    ASSERT_TRUE(again);
    EXPECT_EQ(resource::write(*again, resource::Format::Json), said);
    ++i;
  }
  EXPECT_EQ(i, 40);
}

TEST(CellRecording, StatesStandBeforeTheFirstFrameAndAreNotRepeated) {
  const TemporaryFolder folder;
  write_cell(folder / "a.mcap");
  const auto file = read_recording(folder / "a.mcap");
  ASSERT_TRUE(file);
  std::map<std::string, int> count;
  for (const Message& message : file->messages) {
    if (message.topic == "/sensors/s2/frame") {
      EXPECT_GE(count["/sensors/s2/clock"], 1);
      EXPECT_GE(count["/sensors/s2/floor-plane"], 1);
    }
    ++count[message.topic];
  }
  EXPECT_EQ(count["/sensors/s2/clock"], 2) << "it was corrected once";
  EXPECT_EQ(count["/sensors/s1/clock"], 1);
  EXPECT_EQ(count["/sensors/s2/floor-plane"], 1);
  EXPECT_EQ(count["/registration"], 1);
}

TEST(CellRecording, FusedFramesAreReadWhenAskedFor) {
  const TemporaryFolder folder;
  write_cell(folder / "a.mcap");
  const auto cell = read_cell(folder / "a.mcap", {.fused = true});
  ASSERT_TRUE(cell);
  ASSERT_THAT(cell->fused, SizeIs(40));
  EXPECT_EQ(cell->fused[7].sensors, (std::vector<std::string>{"s1", "s2"}));
  EXPECT_EQ(resource::write(cell->fused[7], resource::Format::Json),
            resource::write(fused(7).frame(), resource::Format::Json));
}

TEST(CellRecording, OneOfItsSensorsIsARecordingOfASensor) {
  const TemporaryFolder folder;
  write_cell(folder / "a.mcap");
  const auto one = read_frame_recording(folder / "a.mcap", {}, chorus::testing::sensor_id("s2"));
  ASSERT_TRUE(one) << to_string(one.error());
  EXPECT_EQ(one->sensor.str(), "s2");
  const auto none = read_frame_recording(folder / "a.mcap");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("s1, s2"));
}

TEST(CellRecording, ARecordingOfOneSensorIsASessionToo) {
  const TemporaryFolder folder;
  FrameRecording description;
  description.sensor = chorus::testing::sensor_id("cam01");
  description.device = "a test";
  auto writer = CellWriter::create(folder / "a.mcap", {metadata_of(description), true});
  ASSERT_TRUE(writer);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(writer->write(raw("cam01", i)));
  ASSERT_TRUE(writer->close());
  const auto read = read_frame_recording(folder / "a.mcap");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->sensor.str(), "cam01");
  EXPECT_EQ(read->device, "a test");
  ASSERT_THAT(read->frames, SizeIs(5));
  const auto twice = read_cell({folder / "a.mcap", folder / "a.mcap"});
  ASSERT_FALSE(twice) << "the same file twice is a mistake";
  EXPECT_EQ(twice.error().code, ErrorCode::Conflict);
  EXPECT_TRUE(read->frames[0].floor);
}

TEST(CellRecording, AClockThatWasSetBackCostsItsFramesAndIsNoted) {
  const TemporaryFolder folder;
  auto writer = CellWriter::create(folder / "a.mcap", {});
  ASSERT_TRUE(writer);
  for (int i = 0; i < 10; ++i)
    ASSERT_TRUE(writer->write(raw("s1", i, milliseconds(i < 5 ? 100 : 0))));
  ASSERT_TRUE(writer->close());
  const auto cell = read_cell(folder / "a.mcap", {.strict = true});
  ASSERT_TRUE(cell) << to_string(cell.error());
  EXPECT_THAT(cell->sensors[0].frames, SizeIs(7)) << "100 ms are three frames";
  EXPECT_THAT(cell->sensors[0].notes.at("left_out"), HasSubstr("3 frames"));
}

/// Frames of s1 in the order in which they arrive, one every 33 ms.
void write_arrivals(const std::filesystem::path& path, const std::vector<int>& numbers) {
  auto writer = CellWriter::create(path, {});
  ASSERT_TRUE(writer);
  Timestamp received = kStart + kFrameInterval * numbers.back();
  for (const int number : numbers) {
    RawFrame frame = raw("s1", number);
    frame.received = received;
    received += kFrameInterval;
    ASSERT_TRUE(writer->write(std::move(frame)));
  }
  ASSERT_TRUE(writer->close());
}

TEST(CellRecording, AFrameThatCameLateTakesItsPlace) {
  const TemporaryFolder folder;
  write_arrivals(folder / "a.mcap", {0, 1, 5, 3, 2, 4, 3, 6, 7});
  const auto cell = read_cell(folder / "a.mcap");
  ASSERT_TRUE(cell) << to_string(cell.error());
  std::vector<std::uint64_t> numbers;
  for (const SensorFrame& frame : cell->sensors[0].frames) numbers.push_back(frame.sequence);
  EXPECT_THAT(numbers, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_THAT(cell->sensors[0].notes.at("left_out"), HasSubstr("1 frame ")) << "3 came twice";
}

TEST(CellRecording, AFrameThatCameMuchTooLateIsLeftOut) {
  const TemporaryFolder folder;
  std::vector<int> numbers{0, 1, 3};
  for (int i = 4; i < 60; ++i) numbers.push_back(i);
  numbers.insert(numbers.end(), {2, 60});
  write_arrivals(folder / "a.mcap", numbers);
  const auto cell = read_cell(folder / "a.mcap");
  ASSERT_TRUE(cell) << to_string(cell.error());
  EXPECT_THAT(cell->sensors[0].frames, SizeIs(60));
  EXPECT_THAT(cell->sensors[0].notes.at("left_out"), HasSubstr("1 frame "));
}

TEST(CellRecording, AFolderIsReadAsOneRecording) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "rec");
  const auto write_part = [&](int part, const std::string& recording) {
    auto writer = CellWriter::create(folder / ("rec/r-000" + std::to_string(part) + ".mcap"),
                                     {{{"recording", recording}}, false});
    ASSERT_TRUE(writer);
    for (int i = 10 * part; i < 10 * part + 10; ++i) ASSERT_TRUE(writer->write(raw("s1", i)));
    ASSERT_TRUE(writer->close());
  };
  write_part(1, "r");
  write_part(0, "r");
  const auto cell = read_cell(folder / "rec");
  ASSERT_TRUE(cell) << to_string(cell.error());
  ASSERT_THAT(cell->sensors, SizeIs(1));
  EXPECT_THAT(cell->sensors[0].frames, SizeIs(20));
  EXPECT_THAT(cell->files.begin()->second, SizeIs(2));
  write_part(2, "another");
  const auto mixed = read_cell(folder / "rec");
  ASSERT_FALSE(mixed) << "two recordings of one sensor are no recording";
  EXPECT_EQ(mixed.error().code, ErrorCode::Conflict);
}

struct PartFile {
  std::string name;
  std::string recording;
  std::string part;
  int first = 0;  ///< Number of the first of its ten frames.
};

void write_part(const std::filesystem::path& folder, const PartFile& part) {
  std::filesystem::create_directory(folder);
  auto writer = CellWriter::create(folder / part.name,
                                   {{{"recording", part.recording}, {"part", part.part}}, false});
  ASSERT_TRUE(writer);
  for (int i = part.first; i < part.first + 10; ++i) {
    ASSERT_TRUE(writer->write(raw("s1", i)));
    ASSERT_TRUE(writer->write(fused(i)));
  }
  ASSERT_TRUE(writer->close());
}

TEST(CellRecording, PartsFollowEachOtherByTimeWhateverTheyAreCalledNow) {
  const TemporaryFolder folder;
  write_part(folder / "rec", {"z.mcap", "r", "1", 0});
  write_part(folder / "rec", {"b.mcap", "r", "2", 10});
  write_part(folder / "rec", {"a.mcap", "r", "3", 20});
  const auto cell = read_cell(folder / "rec", {.fused = true});
  ASSERT_TRUE(cell) << to_string(cell.error());
  EXPECT_THAT(cell->sensors.at(0).frames, SizeIs(30));
  EXPECT_EQ(cell->sensors[0].notes.count("left_out"), 0u);
  EXPECT_THAT(cell->fused, SizeIs(30));
  EXPECT_EQ(cell->files.begin()->second.front().filename(), "z.mcap");
}

TEST(CellRecording, TheSamePartTwiceIsNoRecording) {
  const TemporaryFolder folder;
  write_part(folder / "rec", {"a.mcap", "r", "1", 0});
  write_part(folder / "rec", {"copy.mcap", "r", "1", 0});
  const auto cell = read_cell(folder / "rec");
  ASSERT_FALSE(cell);
  EXPECT_EQ(cell.error().code, ErrorCode::Conflict);
  EXPECT_THAT(cell.error().message, HasSubstr("a.mcap"));
}

TEST(CellRecording, OfTwoRecordingsTheFusedFramesAreNotMixed) {
  const TemporaryFolder folder;
  write_part(folder / "rec", {"a.mcap", "r", "1", 0});
  write_part(folder / "rec", {"b.mcap", "q", "1", 10});
  CellQuery query{.fused = true};
  query.raw = false;
  const auto both = read_cell(folder / "rec", query);
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().code, ErrorCode::Conflict);
  const auto one = read_cell(folder / "rec/a.mcap", query);
  ASSERT_TRUE(one);
  EXPECT_THAT(one->fused, SizeIs(10));
  EXPECT_THAT(one->sensors, SizeIs(0)) << "they were not asked for";
}

TEST(CellRecording, APartThatIsWhollyEarlierIsAnErrorAndNotLeftOut) {
  const TemporaryFolder folder;
  write_part(folder / "rec", {"a.mcap", "r", "1", 100});
  auto writer =
      CellWriter::create(folder / "rec/b.mcap", {{{"recording", "r"}, {"part", "2"}}, false});
  for (int i = 0; i < 5; ++i) {
    RawFrame old = raw("s1", i);
    old.received = kStart + kFrameInterval * (200 + i);  // reported late
    ASSERT_TRUE(writer->write(old));
  }
  ASSERT_TRUE(writer->close());
  const auto cell = read_cell(folder / "rec");
  ASSERT_FALSE(cell);
  EXPECT_EQ(cell.error().code, ErrorCode::Conflict);
  EXPECT_THAT(to_string(cell.error()), HasSubstr("b.mcap"));
}

TEST(CellRecording, DamageNamesItsFile) {
  const TemporaryFolder folder;
  write_cell(folder / "a.mcap");
  const std::string bytes = bytes_of(folder / "a.mcap");
  std::ofstream(folder / "a.mcap", std::ios::binary | std::ios::trunc)
      << bytes.substr(0, bytes.size() - 40);
  const auto cell = read_cell(folder / "a.mcap");
  ASSERT_TRUE(cell);
  ASSERT_THAT(cell->damage, SizeIs(1));
  EXPECT_THAT(cell->damage[0], HasSubstr("a.mcap: the end is missing"));
}

TEST(CellRecording, NonsenseOnAKnownTopicIsNamed) {
  for (const auto& [topic, text] : std::vector<std::pair<std::string, std::string>>{
           {"/sensors/s1/clock", "{}"},
           {"/sensors/s1/clock", R"({"appliedNanoseconds":"99999999999999999999"})"},
           {"/sensors/s1/clock", R"({"appliedNanoseconds":5})"},
           {"/sensors/s1/floor-plane", R"({"normalX":1})"},
           {"/sensors/s1/frame", "{"}}) {
    const TemporaryFolder folder;
    auto writer = RecordingWriter::create(folder / "a.mcap");
    const auto channel = writer->add_channel({topic, "", "", {}});
    ASSERT_TRUE(writer->write(*channel, {topic, 1, kStart, kStart, text}));
    ASSERT_TRUE(writer->close());
    const auto cell = read_cell(folder / "a.mcap");
    ASSERT_FALSE(cell) << text;
    EXPECT_EQ(cell.error().code, ErrorCode::Malformed);
  }
}

TEST(Scene, DrawsABoneOnlyBetweenTrackedJoints) {
  const auto scene = nlohmann::json::parse(scene_update(*seen_by("s1", 0), "s1"));
  ASSERT_EQ(scene["entities"].size(), 1u);
  const auto& entity = scene["entities"][0];
  EXPECT_EQ(entity["frame_id"], "s1");
  EXPECT_EQ(entity["id"], "body-3");
  EXPECT_EQ(entity["timestamp"]["sec"], to_unix_ns(kStart) / 1'000'000'000);
  const auto& line = entity["lines"][0];
  EXPECT_EQ(line["type"], 2);
  EXPECT_EQ(line["points"].size(), kJointCount - 1) << "one foot is hidden";
  EXPECT_EQ(line["indices"].size(), 2 * (kJointCount - 2));
  for (const auto& index : line["indices"]) EXPECT_LT(index.get<int>(), 24);
  // SpineBase is the first joint and the first bone's parent.
  EXPECT_NEAR(line["points"][0]["y"].get<double>(),
              seen_by("s1", 0)->bodies[0].joints[0].position.y(), 1e-4);
}

TEST(Scene, ABodyOfWhichNothingIsTrackedHasNoLines) {
  resource::FrameResource frame = *seen_by("s1", 0);
  for (auto& joint : frame.bodies[0].joints) joint.state = JointState::NotTracked;
  const auto scene = nlohmann::json::parse(scene_update(frame, "s1"));
  EXPECT_TRUE(scene["entities"][0]["lines"].empty());
}

TEST(Scene, RaysHaveNoPlaceAndAreNotDrawn) {
  resource::FrameResource frame = *seen_by("s1", 0);
  for (auto& joint : frame.bodies[0].joints) joint.measurement = Measurement::Ray;
  const auto scene = nlohmann::json::parse(scene_update(frame, "s1"));
  EXPECT_TRUE(scene["entities"][0]["lines"].empty());
}

TEST(Scene, TheWorldsUpIsTheViewersUp) {
  const NamedPlace place{"s1", chorus::testing::ring_sensor(1, 4)};
  const auto json = nlohmann::json::parse(frame_transforms(kStart, {place}));
  const auto rotation_of = [&](std::size_t i) {
    const auto& q = json["transforms"][i]["rotation"];
    return Eigen::Quaterniond(q["w"].get<double>(), q["x"].get<double>(), q["y"].get<double>(),
                              q["z"].get<double>());
  };
  ASSERT_EQ(json["transforms"].size(), 2u);
  EXPECT_EQ(json["transforms"][0]["child_frame_id"], "world");
  EXPECT_LT((rotation_of(0) * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-5);
  EXPECT_EQ(json["transforms"][1]["parent_frame_id"], "world");
  EXPECT_EQ(json["transforms"][1]["child_frame_id"], "s1");
  EXPECT_LT(rotation_of(1).angularDistance(Eigen::Quaterniond(place.world_from_named.linear())),
            1e-4);
}

}  // namespace
}  // namespace chorus::record
