// Plain files: documented files are read, files that we write are read back, and mistakes are
// named.
#include "common/importers/own_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "common/exporters/csv.h"
#include "common/exporters/take.h"
#include "common/importers/formats.h"
#include "common/resource/frame_resource.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/unit/importers/import_files.h"

namespace chorus::importers {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using ::testing::HasSubstr;
using ::testing::SizeIs;

Result<record::FrameRecording> csv(const std::string& text) {
  const TemporaryFolder folder;
  return read_joint_csv(folder.write("walk.csv", text));
}

std::string why(const std::string& text) {
  const auto read = csv(text);
  return read ? "" : to_string(read.error());
}

constexpr const char* kHeader = "time_s,person,joint,x_m,y_m,z_m\n";

TEST(JointCsv, TakesTheFewestColumnsThatTellAJoint) {
  const auto read = csv("time_s;joint;z_m;y_m;x_m\r\n0;Neck;3;2;1\r\n0.5;Neck;3;2;1.5\r\n");
  ASSERT_THAT(read, IsOk());
  ASSERT_THAT(read->frames, SizeIs(2));
  EXPECT_EQ(read->frames[0].captured, kDefaultStart);
  EXPECT_EQ(read->frames[1].captured, kDefaultStart + std::chrono::milliseconds(500));
  const Joint& neck = read->frames[1].bodies.at(0).skeleton[JointId::Neck];
  EXPECT_EQ(neck.position, Eigen::Vector3d(1.5, 2, 3));
  EXPECT_EQ(neck.state, JointState::Tracked);
  EXPECT_EQ(read->frames[1].bodies[0].skeleton[JointId::Head].state, JointState::NotTracked);
}

TEST(JointCsv, FieldsMayBeQuotedAsRDoes) {
  const auto read =
      csv("\"\",\"time_s\",\"joint\",\"x_m\",\"y_m\",\"z_m\"\n\"1\",0,\"Neck\",1,2,3\n");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->frames.at(0).bodies.at(0).skeleton[JointId::Neck].position,
            Eigen::Vector3d(1, 2, 3));
}

TEST(JointCsv, PeopleOfOneInstantShareItsFrame) {
  const auto read = csv(std::string(kHeader) + "0,7,Neck,1,2,3\n0,9,Neck,2,2,3\n1,9,Neck,,,\n");
  ASSERT_THAT(read, IsOk());
  ASSERT_THAT(read->frames, SizeIs(2));
  ASSERT_THAT(read->frames[0].bodies, SizeIs(2));
  EXPECT_EQ(read->frames[0].bodies[1].id, BodyId{9});
  EXPECT_THAT(read->frames[1].bodies, SizeIs(0));  // joints without a position do not yield a body
}

TEST(JointCsv, TakesNanForWhatWasNotSeenAsNumpyWritesIt) {
  const auto read = csv(std::string(kHeader) + "0,1,Neck,1,2,3\n0,1,Head,nan,NaN,NA\n");
  ASSERT_THAT(read, IsOk());
  EXPECT_FALSE(read->frames.at(0).bodies.at(0).skeleton[JointId::Head].given());
}

TEST(JointCsv, EverySpellingOfNotSeenIsOneAndCounted) {
  std::string text = std::string(kHeader) + "0,1,Neck,1,2,3\n";
  for (const char* word : {"None", "null", "-nan(ind)", "#N/A", "NaN", "", "-1.#IND", "N/A", "inf"})
    text += std::string("0,1,Head,") + word + "," + word + "," + word + "\n";
  const auto read = csv(text + "0,1,KneeLeft,1,,3\n");
  ASSERT_THAT(read, IsOk());
  EXPECT_FALSE(read->frames.at(0).bodies.at(0).skeleton[JointId::Head].given());
  EXPECT_THAT(read->notes.at("missing"), HasSubstr("10 joints"));
}

TEST(JointCsv, ZerosAreNotSeenAndCounted) {
  const TemporaryFolder folder;
  const auto file = folder.write(
      "walk.csv", std::string(kHeader) + "0,1,Neck,1,2,3\n0,1,Head,0,0,0\n0,1,HipLeft,0,0,1\n");
  const auto set = import_files(FileFormat::Csv, {file});
  ASSERT_THAT(set, IsOk());
  const auto& body = set->recordings.at(0).frames.at(0).bodies.at(0).skeleton;
  EXPECT_FALSE(body[JointId::Head].given());
  EXPECT_TRUE(body[JointId::HipLeft].given());
  EXPECT_THAT(set->recordings[0].notes.at("unseen"), HasSubstr("1 joints at 0, 0, 0"));
}

/// A person whose thigh and shin are `length` long in units of the file.
std::string legs(double length) {
  return std::string(kHeader) +
         fmt::format("0,1,HipLeft,1,{},2\n0,1,KneeLeft,1,{},2\n0,1,AnkleLeft,1,0,2\n", 2 * length,
                     length);
}

TEST(JointCsv, PeopleOfAnImpossibleSizeAreRefusedWithTheUnitThatFits) {
  const TemporaryFolder folder;
  const auto file = folder.write("walk.csv", legs(16.0));  // inches
  const auto as_metres = import_files(FileFormat::Csv, {file});
  ASSERT_THAT(as_metres, FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(to_string(as_metres.error()), HasSubstr("with --unit in they would be 1.7 m"));
  ImportOptions options;
  options.metres_per_unit = 0.0254;
  const auto as_inches = import_files(FileFormat::Csv, {file}, options);
  ASSERT_THAT(as_inches, IsOk());
  const auto& body = as_inches->recordings[0].frames[0].bodies[0].skeleton;
  EXPECT_NEAR(body[JointId::HipLeft].position.y(), 32 * 0.0254, 1e-9);
  const auto wide = folder.write("mm.csv", legs(400.0));
  EXPECT_THAT(import_files(FileFormat::Csv, {wide}), FailsWith(ErrorCode::Malformed));
  options.metres_per_unit = 0.001;
  EXPECT_THAT(import_files(FileFormat::Csv, {wide}, options), IsOk()) << "beyond 100 in metres";
}

TEST(JointCsv, TheAxisThatIsUpCanBeSaid) {
  const TemporaryFolder folder;
  const auto file = folder.write("walk.csv", std::string(kHeader) + "0,1,Head,1,2,3\n");
  ImportOptions options;
  options.up = UpAxis{2, false};
  const auto set = import_files(FileFormat::Csv, {file}, options);
  ASSERT_THAT(set, IsOk());
  EXPECT_EQ(set->recordings[0].frames[0].bodies[0].skeleton[JointId::Head].position,
            Eigen::Vector3d(1, 3, -2));
}

TEST(JointCsv, NamesTheRowTheColumnAndWhatIsWrong) {
  EXPECT_THAT(why("a,b\n1,2\n"), HasSubstr("names no column \"joint\""));
  EXPECT_THAT(why("joint,x_m,y_m,z_m\nNeck,1,2,3\n"), HasSubstr("neither a column \"utc\""));
  EXPECT_THAT(why("joint,joint\nNeck,1\n"), HasSubstr("twice"));
  EXPECT_THAT(why(""), HasSubstr("first row"));
  const std::string start(kHeader);
  EXPECT_THAT(why(start + "0,1,Neck,1,2,3\n0,1,Nose,1,2,3\n"), HasSubstr("walk.csv:3"));
  EXPECT_THAT(why(start + "0,1,Nose,1,2,3\n"), HasSubstr("\"Nose\" is no joint of ours"));
  EXPECT_THAT(why(start + "0,1,Neck,1,2\n"), HasSubstr("5 values where the first row names 6"));
  EXPECT_THAT(why(start + "0,1,Neck,1,2,3000\n"), HasSubstr("z_m"));
  EXPECT_THAT(why(start + "0,1,Neck,1,two,3\n"), HasSubstr("is not a number."));
  EXPECT_THAT(why(start + "0,1,neck,1,2,3\n"), HasSubstr("did you mean Neck?"));
  EXPECT_THAT(why(start + "0,1,Neck,1,2,3000\n"), HasSubstr("+-100 m; is it in millimetres?"));
  EXPECT_THAT(why(start + "7e8,1,Neck,1,2,3\n"), HasSubstr("+-604800 s; is it in milliseconds?"));
  EXPECT_THAT(why(start + "1,1,Neck,1,2,3\n0,1,Neck,1,2,3\n"), HasSubstr("goes back in time"));
  EXPECT_THAT(why(start + "0,1,Neck,1,2,3\n0,1,Neck,1,2,3.5\n"), HasSubstr("twice at one instant"));
  EXPECT_THAT(why("time_s;joint;x_m;y_m;z_m\n0;Neck;0,1;2;3\n"), HasSubstr("need a point"));
  EXPECT_THAT(why("\x1F\x8B\x08 packed"), HasSubstr("gunzip"));
  EXPECT_THAT(why("\x89MCAP0\r\n"), HasSubstr("a recording already"));
  const TemporaryFolder folder;
  EXPECT_THAT(to_string(read_joint_csv(folder.path()).error()), HasSubstr("is a folder"));
  EXPECT_THAT(why("utc,joint,x_m,y_m,z_m\nnow,Neck,1,2,3\n"), HasSubstr("is not a UTC time"));
  EXPECT_THAT(why("utc,joint,x_m,y_m,z_m,qx,qy,qz,qw\n2026-11-22T07:00:00Z,Neck,1,2,3,1,1,0,0\n"),
              HasSubstr("no rotation"));
}

TEST(JointCsv, WhatExportWritesComesBack) {
  exporters::Take take;
  take.rate_hz = 30.0;
  take.start = testing::kStart;
  take.frames = 3;
  exporters::PersonTrack track;
  track.person = PersonId{4};
  for (int i = 0; i < 3; ++i) {
    exporters::Pose pose;
    pose.skeleton = testing::standing_person({0.1 * i, 0, 0});
    pose.skeleton[JointId::HandLeft].state = JointState::Inferred;
    if (i == 1) testing::hide(pose.skeleton[JointId::Head]);
    pose.variance.fill(4e-4);
    pose.variance[index_of(JointId::Neck)] = -1.0;
    track.poses.push_back(pose);
  }
  take.persons.push_back(track);
  const auto read = csv(exporters::csv_of(take));
  ASSERT_THAT(read, IsOk());
  ASSERT_THAT(read->frames, SizeIs(3));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read->frames[i].captured, exporters::instant_of(take, i));
    const BodyFrame& body = read->frames[i].bodies.at(0);
    EXPECT_EQ(body.id, BodyId{4});
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Joint& written = track.poses[i].skeleton.joints[j];
      EXPECT_EQ(body.skeleton.joints[j].state, written.state) << i << " " << j;
      if (!written.seen()) continue;
      EXPECT_LT((body.skeleton.joints[j].position - written.position).norm(), 2e-6);
      const Covariance& covariance = body.skeleton.joints[j].covariance;
      ASSERT_EQ(covariance.known(), j != index_of(JointId::Neck));
      if (!covariance.known()) continue;
      EXPECT_NEAR((covariance.matrix() - 4e-4 * Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-9);
    }
  }
}

TEST(JointCsv, OneFilesSpaceIsTheWorldUnlessItHasAFloor) {
  const TemporaryFolder folder;
  const auto file = folder.write("walk.csv", std::string(kHeader) + "0,1,Neck,1,2,3\n");
  const auto world = import_files(FileFormat::Csv, {file});
  ASSERT_THAT(world, IsOk());
  EXPECT_THAT(world->world_from_sensor, SizeIs(1));
  ImportOptions options;
  options.floor = FloorPlane{{0, 1, 0}, 1.2};
  const auto sensor = import_files(FileFormat::Csv, {file}, options);
  ASSERT_THAT(sensor, IsOk());
  EXPECT_THAT(sensor->world_from_sensor, SizeIs(0));
}

TEST(FrameLines, DocumentsComeBackInTheirOrder) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const Timestamp captured = testing::kStart + i * testing::kFrameInterval;
    const auto body =
        testing::body_seen_from(testing::ring_sensor(0, 3), testing::standing_person(), captured);
    text += resource::write(resource::to_resource(testing::sensor_frame("s1", captured, {body})),
                            resource::Format::Json);
  }
  const TemporaryFolder folder;
  const auto read = read_frame_lines(folder.write("walk.ndjson", text));
  ASSERT_THAT(read, IsOk());
  ASSERT_THAT(read->frames, SizeIs(3));
  EXPECT_EQ(read->frames[2].captured, testing::kStart + 2 * testing::kFrameInterval);
  EXPECT_TRUE(read->frames[0].bodies.at(0).skeleton[JointId::Neck].seen());
  const auto twice = read_frame_lines(folder.write("twice.ndjson", text + text));
  ASSERT_FALSE(twice);
  EXPECT_THAT(to_string(twice.error()), HasSubstr("twice.ndjson:4"));
}

TEST(AzureKinectCsv, TurnsMillimetresOfTheCameraIntoOurAxes) {
  std::string header = "timestamp;body_idx";
  std::string row = ";1";
  for (const char* name : {"PELVIS", "KNEE_LEFT"}) {
    for (const char* part : {"c", "x", "y", "z"})
      header += std::string(";") + name + " (" + part + ")";
  }
  row += ";2;100;-200;2500;0;100;700;2500\n";
  const TemporaryFolder folder;
  const auto read =
      read_azure_kinect_csv(folder.write("log.csv", header + "\n500" + row + "33833" + row));
  ASSERT_THAT(read, IsOk());
  ASSERT_THAT(read->frames, SizeIs(2));
  EXPECT_EQ(read->frames[1].captured - read->frames[0].captured, std::chrono::microseconds(33333));
  const auto& skeleton = read->frames[0].bodies.at(0).skeleton;
  EXPECT_LT((skeleton[JointId::SpineBase].position - Eigen::Vector3d(-0.1, 0.2, 2.5)).norm(), 1e-9);
  EXPECT_EQ(skeleton[JointId::SpineBase].state, JointState::Tracked);
  EXPECT_EQ(skeleton[JointId::KneeLeft].state, JointState::NotTracked);
}

}  // namespace
}  // namespace chorus::importers
