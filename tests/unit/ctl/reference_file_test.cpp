// The CSV of another tracker.
#include "services/ctl/align/reference_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;

Result<Reference> read(std::string_view text, ReferenceOptions options = {}) {
  return read_reference(text, "take.csv", options);
}

constexpr std::string_view kMotive =
    "Format Version,1.23,Take Name,Walk,Rotation Type,Quaternion,Length Units,Millimeters,"
    "Coordinate Space,Global\n"
    "\n"
    ",Type,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid Body,Rigid "
    "Body,Marker,Marker,Marker\n"
    ",Name,Cap,Cap,Cap,Cap,Cap,Cap,Cap,Cap,Cap:Marker1,Cap:Marker1,Cap:Marker1\n"
    ",ID,\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",\"A\",B,B,B\n"
    ",,Rotation,Rotation,Rotation,Rotation,Position,Position,Position,Mean Marker "
    "Error,Position,Position,Position\n"
    "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z,,X,Y,Z\n"
    "0,0.000000,0,0,0,1,100,1650,-200,0.1,110,1660,-210\n"
    "1,0.008333,0,1,0,0,101,1650,-200,0.1,,,\n";

TEST(Reference, ReadsMotive) {
  const auto found = read(kMotive);
  ASSERT_TRUE(found) << to_string(found.error());
  EXPECT_FALSE(found->utc);
  ASSERT_EQ(found->bodies.size(), 2u);
  const auto& cap = found->bodies.at("Cap");
  ASSERT_EQ(cap.size(), 2u);
  EXPECT_TRUE(cap[0].place.isApprox(Eigen::Vector3d(0.1, 1.65, -0.2)));
  EXPECT_DOUBLE_EQ(cap[1].time, 0.008333);
  ASSERT_TRUE(cap[1].turn);
  EXPECT_NEAR(std::abs(cap[1].turn->y()), 1.0, 1e-9);
  EXPECT_EQ(found->bodies.at("Cap:Marker1").size(), 1u) << "an empty field is no place";
  EXPECT_FALSE(found->bodies.at("Cap:Marker1")[0].turn);
}

TEST(Reference, ReadsAPlainTable) {
  const auto found = read("time,x,y,z\n0.0,1,2,3\n0.1,1,2,4\n");
  ASSERT_TRUE(found) << to_string(found.error());
  ASSERT_EQ(found->bodies.at("").size(), 2u);
  EXPECT_EQ(found->bodies.at("")[1].place, Eigen::Vector3d(1, 2, 4));
  EXPECT_FALSE(found->utc);
}

TEST(Reference, ADateIsUtc) {
  const auto found = read("utc;name;x;y;z\n2026-11-25T10:00:00.5Z;Cap;1;2;3\n");
  ASSERT_TRUE(found) << to_string(found.error());
  EXPECT_TRUE(found->utc);
  EXPECT_NEAR(std::fmod(found->bodies.at("Cap")[0].time, 1.0), 0.5, 1e-6);
}

TEST(Reference, ReadsWhatWeExport) {
  const auto found = read(
      "frame,time_s,utc,person,joint,state,x_m,y_m,z_m,qx,qy,qz,qw,sd_mm\n"
      "0,0.000000,2026-11-25T10:00:00.000000000Z,3,Head,Tracked,1,1.7,2,0,0,0,1,5\n"
      "0,0.000000,2026-11-25T10:00:00.000000000Z,3,Neck,NotTracked,,,,,,,,\n"
      "1,0.033333,2026-11-25T10:00:00.033333333Z,3,Head,Tracked,1.1,1.7,2,0,0,0,1,5\n");
  ASSERT_TRUE(found) << to_string(found.error());
  ASSERT_EQ(found->bodies.size(), 1u);
  EXPECT_EQ(found->bodies.at("Head").size(), 2u);
}

TEST(Reference, ConvertsAxesAndUnits) {
  const std::string table = "time,x,y,z,qx,qy,qz,qw\n0,1,2,3,0,0,0.7071068,0.7071068\n";
  const auto z_up = read(table, {ReferenceAxes::ZUp, 0.001});
  EXPECT_TRUE(z_up->bodies.at("")[0].place.isApprox(Eigen::Vector3d(0.001, 0.003, -0.002)));
  const Eigen::Quaterniond turn = *z_up->bodies.at("")[0].turn;
  EXPECT_NEAR(std::abs(turn.y()), 0.7071068, 1e-6) << "a turn about their up is one about ours";
  const auto unity = read(table, {ReferenceAxes::Unity, {}});
  EXPECT_EQ(unity->bodies.at("")[0].place, Eigen::Vector3d(1, 2, -3));
}

TEST(Reference, SaysWhatIsWrong) {
  EXPECT_THAT(read("a,b\n1,2\n").error().message, HasSubstr("columns such as time,x,y,z"));
  EXPECT_THAT(read("time,x,y,z\n1,0,0,0\n1,0,0,0\n").error().message,
              HasSubstr("does not increase"));
  EXPECT_THAT(read("time,x,y,z\nsoon,0,0,0\n").error().message, HasSubstr("neither seconds"));
  EXPECT_FALSE(read(""));
  EXPECT_FALSE(read("time,x,y,z\n0,,,\n"));
  EXPECT_FALSE(read("Format Version,1.23\n\nnothing\n"));
}

}  // namespace
}  // namespace chorus::ctl
