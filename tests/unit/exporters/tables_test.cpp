// TRC and CSV, read back by splitting lines.
#include <gmock/gmock.h>

#include <sstream>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/exporters/csv.h"
#include "common/exporters/number_text.h"
#include "common/exporters/trc.h"
#include "tests/unit/exporters/poses.h"

namespace chorus::exporters {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

Take two_rows() {
  auto second = asymmetric_person();
  testing::hide(second[JointId::Head]);
  Take take = take_of({{asymmetric_person(), second}}, 25.0);
  take.persons[0].poses[0].variance[index_of(JointId::Head)] = 4e-4;
  return take;
}

TEST(TrcExport, HasTheRowsOfMotionAnalysis) {
  const auto lines = split(trc_of(two_rows(), "walk.trc"), '\n');
  ASSERT_EQ(lines.size(), 9u);
  EXPECT_EQ(lines[0], "PathFileType\t4\t(X/Y/Z)\twalk.trc");
  EXPECT_EQ(lines[1],
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\t"
            "OrigNumFrames");
  EXPECT_EQ(lines[2], "25.000000\t25.000000\t2\t25\tmm\t25.000000\t1\t2");
  EXPECT_THAT(lines[3], StartsWith("Frame#\tTime\tSpineBase\t\t\tSpineMid\t\t\tNeck\t\t\tHead\t"));
  EXPECT_THAT(lines[4], StartsWith("\t\tX1\tY1\tZ1\tX2\tY2\tZ2"));
  EXPECT_THAT(lines[4], ::testing::EndsWith("\tX25\tY25\tZ25\t"));
  EXPECT_EQ(lines[5], "");
  EXPECT_EQ(lines[8], "");
  for (const std::size_t row : {3U, 4U, 6U, 7U})
    EXPECT_EQ(split(lines[row], '\t').size(), 2 + 3 * kJointCount + 1) << "a tab ends each row";
}

/// Splits a line like OpenSim's FileAdapter: an empty token at its end does not count.
std::vector<std::string> tokens_of_opensim(const std::string& line) {
  auto tokens = split(line, '\t');
  if (tokens.back().empty()) tokens.pop_back();
  return tokens;
}

TEST(TrcExport, OpenSimCountsTheColumnsOfEveryRowEvenIfTheLastIsMissing) {
  auto second = asymmetric_person();
  testing::hide(second[JointId::ThumbRight]);
  const auto take = take_of({{asymmetric_person(), second}}, 30.0);
  const auto lines = split(trc_of(take, "walk.trc"), '\n');
  EXPECT_EQ(tokens_of_opensim(lines[6]).size(), 2 + 3 * kJointCount);
  EXPECT_EQ(tokens_of_opensim(lines[7]).size(), 2 + 3 * kJointCount);
}

TEST(TrcExport, CoordinatesAreMillimetresAndMissingOnesEmpty) {
  const auto lines = split(trc_of(two_rows(), "walk.trc"), '\n');
  const auto first = split(lines[6], '\t');
  const auto second = split(lines[7], '\t');
  EXPECT_EQ(first[0], "1");
  EXPECT_EQ(second[1], "0.040000");
  const auto person = asymmetric_person();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const std::size_t field = 2 + 3 * j + static_cast<std::size_t>(axis);
      EXPECT_NEAR(std::stod(first[field]), to_mm(person.joints[j].position[axis]), 1e-5);
      EXPECT_EQ(second[field].empty(), j == index_of(JointId::Head));
    }
  }
}

TEST(TrcExport, SeveralPersonsHaveNamesOfTheirOwn) {
  const auto lines =
      split(trc_of(take_of({{asymmetric_person()}, {asymmetric_person()}}, 30), "x"), '\n');
  const auto names = split(lines[3], '\t');
  EXPECT_EQ(names[2], "P1_SpineBase");
  EXPECT_EQ(names[2 + 3 * kJointCount], "P2_SpineBase");
}

TEST(CsvExport, SaysEverythingThereIsToSayOfAJoint) {
  const auto lines = split(csv_of(two_rows()), '\n');
  ASSERT_EQ(lines.size(), 1 + 2 * kJointCount + 1);
  EXPECT_EQ(lines[0], "frame,time_s,utc,person,joint,state,x_m,y_m,z_m,qx,qy,qz,qw,sd_mm");
  const auto person = asymmetric_person();
  const auto head = split(lines[1 + index_of(JointId::Head)], ',');
  ASSERT_EQ(head.size(), 14u);
  EXPECT_EQ(head[2], "2026-11-21T07:30:00.000000000Z");
  EXPECT_EQ(head[4], "Head");
  EXPECT_NEAR(std::stod(head[6]), person[JointId::Head].position.x(), 1e-6);
  EXPECT_NEAR(std::stod(head[8]), person[JointId::Head].position.z(), 1e-6);
  EXPECT_EQ(head[9], "") << "leaves have no orientation";
  EXPECT_EQ(head[13], "20.000");
  const auto elbow = split(lines[1 + index_of(JointId::ElbowRight)], ',');
  EXPECT_NEAR(std::stod(elbow[9]), person[JointId::ElbowRight].orientation.x(), 1e-6);
  EXPECT_NEAR(std::stod(elbow[12]), person[JointId::ElbowRight].orientation.w(), 1e-6);
  EXPECT_EQ(elbow[13], "") << "not known";
  EXPECT_THAT(split(lines[1 + kJointCount + index_of(JointId::Head)], ','),
              ElementsAre("1", "0.040000", "2026-11-21T07:30:00.040000000Z", "1", "Head",
                          "NotTracked", "", "", "", "", "", "", "", ""));
}

TEST(NumberText, NeverSaysMinusZeroNanOrAnExponent) {
  const auto fixed = [](double value, int digits) {
    std::string text;
    append_fixed(text, value, digits);
    return text;
  };
  EXPECT_EQ(fixed(-0.00001, 3), "0.000");
  EXPECT_EQ(fixed(NAN, 2), "0.00");
  EXPECT_EQ(fixed(-INFINITY, 1), "0.0");
  EXPECT_EQ(fixed(-1.25, 2), "-1.25");
  EXPECT_EQ(fixed(1e20, 0), "100000000000000000000");
  std::string exact;
  append_exact(exact, 1.0 / 120);
  EXPECT_EQ(std::stod(exact), 1.0 / 120);
}

}  // namespace
}  // namespace chorus::exporters
