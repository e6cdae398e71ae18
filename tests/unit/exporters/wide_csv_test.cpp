#include "common/exporters/wide_csv.h"

#include <gmock/gmock.h>

#include "common/body/bones.h"
#include "common/exporters/skeleton_fit.h"
#include "common/exporters/trc.h"
#include "tests/unit/exporters/poses.h"

namespace chorus::exporters {
namespace {

using ::testing::StartsWith;

std::vector<std::vector<std::string>> cells_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows{{""}};
  for (const char c : text) {
    if (c == '\n')
      rows.push_back({""});
    else if (c == ',')
      rows.back().emplace_back();
    else
      rows.back().back() += c;
  }
  rows.pop_back();
  return rows;
}

std::size_t column(const std::vector<std::string>& header, const std::string& name) {
  const auto found = std::ranges::find(header, name);
  EXPECT_NE(found, header.end()) << name;
  return static_cast<std::size_t>(found - header.begin());
}

TEST(WideCsv, HasOneRowAFrameAndUnitsInItsHeader) {
  auto second = asymmetric_person();
  testing::hide(second[JointId::Head]);
  const auto rows = cells_of(
      wide_csv_of(take_of({{asymmetric_person(), second}}, 25.0), ColumnNames::Chorus, "").value());
  ASSERT_EQ(rows.size(), 3U);
  for (const auto& row : rows) EXPECT_EQ(row.size(), 4 + 8 * kJointCount);
  const std::size_t head = column(rows[0], "Head.x_m");
  EXPECT_EQ(rows[0][head + 7], "Head.sd_mm");
  EXPECT_NEAR(std::stod(rows[1][head]), asymmetric_person()[JointId::Head].position.x(), 1e-6);
  EXPECT_EQ(rows[2][head], "");
  EXPECT_EQ(rows[2][1], "0.040000");
  const std::size_t elbow = column(rows[0], "ElbowRight.qx");
  EXPECT_NEAR(std::stod(rows[1][elbow]), asymmetric_person()[JointId::ElbowRight].orientation.x(),
              1e-6);
}

TEST(WideCsv, QuaternionsDoNotChangeTheirSignFromFrameToFrame) {
  auto frames = turning();  // three times around: q would come back as -q
  for (std::size_t i = 0; i < frames.size(); i += 2)
    for (Joint& joint : frames[i].joints) joint.orientation.coeffs() *= -1.0;
  for (const ColumnNames names : {ColumnNames::Chorus, ColumnNames::Motive}) {
    const auto rows = cells_of(wide_csv_of(take_of({frames}, 30.0), names, "turn").value());
    const bool motive = names == ColumnNames::Motive;
    const std::size_t first = motive ? 7 : 1;
    const std::size_t at = motive ? 2 : column(rows[0], "SpineMid.qx");
    for (std::size_t r = first + 1; r < rows.size(); ++r) {
      double dot = 0.0;
      for (std::size_t k = 0; k < 4; ++k)
        dot += std::stod(rows[r][at + k]) * std::stod(rows[r - 1][at + k]);
      ASSERT_GT(dot, 0.9) << r;
    }
  }
}

TEST(WideCsv, OfMotiveHasItsHeaderAndBonesThatReachTheirChildren) {
  const Take take = take_of({walk()}, 30.0);
  const std::string text = wide_csv_of(take, ColumnNames::Motive, "walk,1").value();
  EXPECT_THAT(text, StartsWith("Format Version,1.23,Take Name,walk 1,Take Notes,,"));
  const auto rows = cells_of(text);
  ASSERT_EQ(rows.size(), 7 + take.frames);
  EXPECT_EQ(rows[1].size(), 1U);
  EXPECT_EQ(rows[6][0], "Frame");
  EXPECT_EQ(rows[6][1], "Time (Seconds)");
  for (std::size_t r = 2; r < rows.size(); ++r) ASSERT_EQ(rows[r].size(), rows[6].size()) << r;
  const auto place = [&](std::size_t row, std::size_t at) {
    return Eigen::Vector3d(std::stod(rows[row][at + 4]), std::stod(rows[row][at + 5]),
                           std::stod(rows[row][at + 6]));
  };
  const std::size_t thigh = column(rows[3], "P1:LThigh");
  const std::size_t shin = column(rows[3], "P1:LShin");
  // The bone's rotation takes its rest direction (down in the T-pose) to the knee.
  const SkeletonFit fit = fit_skeleton(take.persons[0]).value();
  for (const std::size_t row : {7U, 20U, 60U}) {
    const Eigen::Quaterniond q(std::stod(rows[row][thigh + 3]), std::stod(rows[row][thigh]),
                               std::stod(rows[row][thigh + 1]), std::stod(rows[row][thigh + 2]));
    const auto knee = std::ranges::find(fit.joints, JointId::KneeLeft, &FittedJoint::id);
    EXPECT_LT((place(row, thigh) + q * knee->offset - place(row, shin)).norm(), 1e-4) << row;
  }
}

TEST(WideCsv, OfPose2SimHasItsMarkersAndSoHasTrc) {
  const Take take = take_of({{asymmetric_person()}, {asymmetric_person()}}, 30.0);
  const auto rows = cells_of(wide_csv_of(take, ColumnNames::Pose2Sim, "").value());
  const std::size_t knee = column(rows[0], "P2_RKnee_x_m");
  EXPECT_NEAR(std::stod(rows[1][knee]), asymmetric_person()[JointId::KneeRight].position.x(), 1e-6);
  const std::string trc = trc_of(take, "a.trc", ColumnNames::Pose2Sim);
  EXPECT_THAT(trc, ::testing::HasSubstr("\t34\tmm\t"));
  EXPECT_THAT(trc, ::testing::HasSubstr("\tP1_RBigToe\t\t"));
}

TEST(WideCsv, OfMotiveRefusesPeopleWithoutAPelvis) {
  auto body = asymmetric_person();
  testing::hide(body[JointId::SpineBase]);
  const Take take = take_of({{body}}, 30.0);
  EXPECT_FALSE(wide_csv_of(take, ColumnNames::Motive, ""));
  EXPECT_TRUE(wide_csv_of(take, ColumnNames::Chorus, ""));
}

}  // namespace
}  // namespace chorus::exporters
