#include "common/motion/c3d.h"

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/base/units.h"
#include "tests/support/matchers.h"
#include "tests/unit/motion/c3d_files.h"

namespace chorus::motion {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::VectorNear;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Form {
  Order order;
  float scale;
  const char* name;
};

class C3dForms : public ::testing::TestWithParam<Form> {};

TEST_P(C3dForms, GiveTheSamePoints) {
  C3dSpec spec;
  spec.order = GetParam().order;
  spec.scale = GetParam().scale;
  const auto read = parse_c3d(C3dBuilder(spec).bytes(), "form.c3d");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->processor, GetParam().name);
  EXPECT_THAT(read->labels, ElementsAre("HipLeft", "Wand"));
  EXPECT_EQ(read->rate_hz, 50.0);
  ASSERT_EQ(read->frames.size(), 2u);
  const MarkerPoint& point = read->frames[1][1];
  EXPECT_THAT(point.position.cast<double>(),
              VectorNear(Eigen::Vector3d(0.101, -0.2, 1.50025), 1e-6));
  EXPECT_NEAR(point.residual, mm(2 * std::abs(GetParam().scale)), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    Processors, C3dForms,
    ::testing::Values(Form{Order::Intel, -1.0f, "Intel"}, Form{Order::Intel, 0.25f, "Intel"},
                      Form{Order::Dec, -1.0f, "DEC"}, Form{Order::Dec, 0.25f, "DEC"},
                      Form{Order::Mips, -1.0f, "MIPS"}, Form{Order::Mips, 0.25f, "MIPS"}),
    [](const auto& each) {
      return std::string(each.param.name) + (each.param.scale < 0 ? "Floats" : "Integers");
    });

TEST(C3d, PointsThatAreNotThereAreNot) {
  C3dSpec spec;
  spec.frames = 4;
  spec.at = [](int f, int) -> std::array<double, 4> {
    if (f == 0) return {1, 2, 3, -1};
    if (f == 1) return {std::nan(""), 2, 3, 0};
    if (f == 2) return {1e30, 2, 3, 0};
    return {1, 2, 3, 0};
  };
  const auto read = parse_c3d(C3dBuilder(spec).bytes(), "gaps.c3d").value();
  for (std::size_t f = 0; f < 3; ++f) EXPECT_FALSE(read.frames[f][0].valid()) << f;
  EXPECT_TRUE(read.frames[3][0].valid());
}

TEST(C3d, UnitsAndAxesAreTheFilesOwn) {
  C3dSpec spec;
  spec.units = "m";
  spec.y_screen = "+Z";
  spec.at = [](int, int) { return std::array<double, 4>{1.0, 2.0, 3.0, 0.0}; };
  const auto z_up = motion_from_markers(parse_c3d(C3dBuilder([&] {
                                                    auto both = spec;
                                                    both.labels = {"HipLeft", "HipRight"};
                                                    return both;
                                                  }())
                                                      .bytes(),
                                                  "z.c3d")
                                            .value());
  ASSERT_THAT(z_up, IsOk());
  EXPECT_THAT(z_up->subjects[0].motion.frames[0][JointId::HipLeft].position,
              VectorNear(Eigen::Vector3d(1, 3, -2), 1e-6));
  spec.x_screen = "";
  spec.y_screen = "";
  EXPECT_EQ(parse_c3d(C3dBuilder(spec).bytes(), "silent.c3d")->world_from_file.row(1),
            Eigen::RowVector3d(0, 0, 1))
      << "+z is up where nothing is said";
  spec.units = "furlong";
  EXPECT_THAT(parse_c3d(C3dBuilder(spec).bytes(), "odd.c3d"), FailsWith(ErrorCode::Malformed));
}

TEST(C3d, WorldIsAlwaysRightHanded) {
  for (const char* x : {"+X", "-Y", "+Z", "??", ""}) {
    for (const char* y : {"+Y", "-Z", "+X", "Q", ""}) {
      C3dSpec spec;
      spec.x_screen = x;
      spec.y_screen = y;
      const auto read = parse_c3d(C3dBuilder(spec).bytes(), "axes.c3d").value();
      EXPECT_NEAR(read.world_from_file.determinant(), 1.0, 1e-12) << x << y;
      EXPECT_TRUE((read.world_from_file * read.world_from_file.transpose()).isIdentity(1e-12));
    }
  }
}

TEST(C3dLabels, BecomeJointsOfEverySubjectAndTheRestIsReported) {
  C3dSpec spec;
  spec.labels = {"A:LHJC", "A:RHJC", "A:LKNE", "A:LKNM", "B:Head", "B:Neck", "A:LTHI", "Wand"};
  spec.at = [](int, int p) { return std::array<double, 4>{1000.0 * p, 10.0, 0.0, 1.0}; };
  const auto found = motion_from_markers(parse_c3d(C3dBuilder(spec).bytes(), "two.c3d").value());
  ASSERT_THAT(found, IsOk());
  ASSERT_EQ(found->subjects.size(), 2u);
  EXPECT_EQ(found->subjects[0].name, "A");
  const auto& a = found->subjects[0].motion.frames[0];
  EXPECT_NEAR(a[JointId::KneeLeft].position.x(), 2.5, 1e-6) << "between two skin markers";
  EXPECT_EQ(a[JointId::KneeLeft].state, JointState::Inferred);
  EXPECT_EQ(a[JointId::HipRight].state, JointState::Tracked);
  EXPECT_NEAR(a[JointId::SpineBase].position.x(), 0.5, 1e-6);
  EXPECT_FALSE(a[JointId::Head].seen());
  EXPECT_TRUE(found->subjects[1].motion.frames[0][JointId::Head].seen());
  EXPECT_THAT(found->unused_labels, ElementsAre("A:LTHI", "Wand"));
}

TEST(C3dLabels, ThatAreNoneOfOursAreNamedInTheRefusal) {
  C3dSpec spec;
  spec.labels = {"foo", "bar"};
  const auto found = motion_from_markers(parse_c3d(C3dBuilder(spec).bytes(), "foo.c3d").value());
  ASSERT_THAT(found, FailsWith(ErrorCode::Unsupported));
  EXPECT_THAT(found.error().message, HasSubstr("foo, bar"));
}

TEST(C3dHostile, ACutFileIsReadUpToItsLastWholeFrame) {
  const std::string whole = C3dBuilder(C3dSpec{}).bytes();
  std::size_t read = 0;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto cut = parse_c3d(std::string_view(whole).substr(0, size), "cut.c3d");
    if (!cut) continue;
    ++read;
    ASSERT_EQ(cut->frames.size(), 1u) << size;
    EXPECT_THAT(cut->notes.at(0), HasSubstr("announces 2 frames and holds 1"));
  }
  EXPECT_GT(read, 10u);
  EXPECT_THAT(parse_c3d(whole, "whole.c3d"), IsOk());
}

TEST(C3dHostile, EveryByteOfHeaderAndParametersMayLie) {
  const std::string whole = C3dBuilder(C3dSpec{}).bytes();
  std::size_t refused = 0;
  for (std::size_t at = 0; at < 1024; ++at) {
    for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      std::string lie = whole;
      lie[at] = static_cast<char>(value);
      const auto read = parse_c3d(lie, "lie.c3d");
      if (!read) {
        ++refused;
        continue;
      }
      for (const auto& frame : read->frames) ASSERT_EQ(frame.size(), read->labels.size());
      static_cast<void>(motion_from_markers(*read));
    }
  }
  EXPECT_GT(refused, 100u);
}

/// Where the value of a parameter without dimensions is, which the name occurs once before.
std::size_t value_of(const std::string& bytes, const std::string& name) {
  return bytes.find(name) + name.size() + 2 + 2;
}

TEST(C3dHostile, MoreFramesThanThereAreIsSaidSo) {
  std::string lie = C3dBuilder(C3dSpec{}).bytes();
  const std::size_t at = value_of(lie, "FRAMES");
  lie[at] = static_cast<char>(0x10);
  lie[at + 1] = static_cast<char>(0x27);
  const auto read = parse_c3d(lie, "lie.c3d");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->frames.size(), 2u);
  EXPECT_THAT(read->notes.at(0), HasSubstr("announces 10000 frames and holds 2"));
}

TEST(C3d, WhatSixteenBitsCannotCountIsCounted) {
  C3dSpec spec;
  spec.labels = {"HipLeft"};
  spec.scale = 1.0f;
  spec.analog = 0;
  spec.frames = 70'000;
  const std::string bytes = C3dBuilder(spec).bytes();
  const auto wrapped = parse_c3d(bytes, "wrapped.c3d");
  ASSERT_THAT(wrapped, IsOk());
  EXPECT_EQ(wrapped->frames.size(), 70'000u) << "the count of 4464 wrapped";
  std::string full = bytes + std::string(100, '\0');  // what is left of the last block
  full[value_of(full, "FRAMES")] = full[value_of(full, "FRAMES") + 1] = static_cast<char>(0xff);
  const auto saturated = parse_c3d(full, "saturated.c3d");
  ASSERT_THAT(saturated, IsOk());
  EXPECT_EQ(saturated->frames.size(), 70'000u);
  EXPECT_THAT(saturated->notes.at(0), HasSubstr("holds 4465 frames more"));
}

TEST(C3d, ZerosThatClaimToBeThereAreNotSeenAndCounted) {
  C3dSpec spec;
  spec.at = [](int f, int) { return std::array<double, 4>{0.0, 0.0, f == 0 ? 0.0 : 5.0, 0.0}; };
  const auto read = parse_c3d(C3dBuilder(spec).bytes(), "zeros.c3d");
  ASSERT_THAT(read, IsOk());
  EXPECT_FALSE(read->frames[0][0].valid());
  EXPECT_TRUE(read->frames[1][0].valid());
  EXPECT_THAT(read->notes, ElementsAre(HasSubstr("2 points at 0, 0, 0")));
}

TEST(C3d, WithoutAPlaceOfItsPointsTheHeadersBlockCounts) {
  std::string bytes = C3dBuilder(C3dSpec{}).bytes();
  bytes[value_of(bytes, "DATA_START")] = 0;
  const auto read = parse_c3d(bytes, "start.c3d");
  ASSERT_THAT(read, IsOk());
  EXPECT_NEAR(read->frames[1][0].position.x(), 0.101, 1e-6);
}

TEST(C3d, TheUnitCanBeSaidInsteadOfTheFile) {
  C3dSpec spec;
  spec.units = "furlong";
  const auto read = parse_c3d(C3dBuilder(spec).bytes(), "odd.c3d", 0.01);
  ASSERT_THAT(read, IsOk());
  EXPECT_NEAR(read->frames[0][0].position.x(), 1.0, 1e-6);
}

std::string shared_bytes(const std::string& name) {
  const char* folder = std::getenv("CHORUS_SHARED");
  std::ifstream in(std::filesystem::path(folder != nullptr ? folder : "../shared") / "data" / name,
                   std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(RealC3d, TreadmillWalkStandsUprightWithItsLeftOnTheLeft) {
  const auto bytes = shared_bytes("opensense_xsens/OpenSim/Sandbox/MatlabScripts/test_walking.c3d");
  if (bytes.empty()) GTEST_SKIP() << "runs where ../shared/data stands beside the checkout";
  const auto read = parse_c3d(bytes, "test_walking.c3d");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->frames.size(), 806u);
  EXPECT_EQ(read->rate_hz, 250.0);
  const auto found = motion_from_markers(*read);
  ASSERT_THAT(found, IsOk());
  EXPECT_THAT(found->unused_labels, Contains("LASI"));
  const auto& body = found->subjects[0].motion.frames[400];
  const auto height = [&](JointId id) { return body[id].position.y(); };
  EXPECT_GT(height(JointId::SpineShoulder), height(JointId::HipLeft) + 0.3);
  EXPECT_GT(height(JointId::HipLeft), height(JointId::KneeLeft) + 0.3);
  EXPECT_GT(height(JointId::KneeRight), height(JointId::AnkleRight) + 0.25);
  // Left is the direction of up x forward; the toes are in front of the ankles.
  const Eigen::Vector3d left = body[JointId::HipLeft].position - body[JointId::HipRight].position;
  const Eigen::Vector3d ahead =
      body[JointId::FootLeft].position - body[JointId::AnkleLeft].position;
  EXPECT_GT(Eigen::Vector3d::UnitY().cross(ahead).dot(left), 0.0);
}

TEST(RealC3d, GaitLabFileGivesItsJointCentres) {
  const auto bytes = shared_bytes("gait_imu_vicon/S02-Trial-Walk-1-vicon.c3d");
  if (bytes.empty()) GTEST_SKIP() << "runs where ../shared/data stands beside the checkout";
  const auto found = motion_from_markers(parse_c3d(bytes, "walk.c3d").value());
  ASSERT_THAT(found, IsOk());
  const auto& body = found->subjects[0].motion.frames[1500];
  const double thigh = (body[JointId::HipLeft].position - body[JointId::KneeLeft].position).norm();
  EXPECT_GT(thigh, 0.35);
  EXPECT_LT(thigh, 0.50);
  EXPECT_GT(body[JointId::SpineBase].position.y(), 0.7);
}

}  // namespace
}  // namespace chorus::motion
