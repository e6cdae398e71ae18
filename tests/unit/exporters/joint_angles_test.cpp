#include "common/exporters/joint_angles.h"

#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/unit/exporters/poses.h"

namespace chorus::exporters {
namespace {

std::vector<std::vector<std::string>> rows_of(const std::string& text, char separator) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    auto& row = rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, separator);) row.push_back(field);
  }
  return rows;
}

std::size_t column_of(const std::vector<std::string>& header, const std::string& name) {
  const auto found = std::find(header.begin(), header.end(), name);
  EXPECT_NE(found, header.end()) << name;
  return static_cast<std::size_t>(found - header.begin());
}

/// Somebody who stands and bends the right knee by the angle, the shank back.
Skeleton<WorldSpace> knee_bent(double angle) {
  Skeleton<WorldSpace> body = testing::standing_person({0, 0, 0}, 0.0);
  const Eigen::Vector3d knee = body[JointId::KneeRight].position;
  const double length = (body[JointId::AnkleRight].position - knee).norm();
  const Eigen::Vector3d thigh = (knee - body[JointId::HipRight].position).normalized();
  // standing_person() faces +z at yaw 0, so the left is +x.
  const Eigen::AngleAxisd bend(angle, Eigen::Vector3d::UnitX());
  body[JointId::AnkleRight].position = knee + length * (bend * thigh);
  return body;
}

TEST(JointAngles, OfABentKneeAreThoseOfItsBend) {
  std::vector<Skeleton<WorldSpace>> frames;
  for (const double angle : {20.0, 60.0, 90.0}) frames.push_back(knee_bent(deg(angle)));
  const Take take = take_of({frames}, 30.0);
  const auto mot = mot_of(take.persons.front(), 30.0);
  ASSERT_TRUE(mot) << to_string(mot.error());
  const std::string text = mot->substr(mot->find("endheader\n") + 10);
  const auto rows = rows_of(text, '\t');
  const std::size_t knee = column_of(rows[0], "knee_angle_r");
  EXPECT_NEAR(std::stod(rows[1][knee]), 20.0, 1.0);
  EXPECT_NEAR(std::stod(rows[2][knee]), 60.0, 1.0);
  EXPECT_NEAR(std::stod(rows[3][knee]), 90.0, 1.0);
  EXPECT_NEAR(std::stod(rows[1][column_of(rows[0], "knee_angle_l")]), 0.0, 8.0) << "stands";
  EXPECT_NEAR(std::stod(rows[3][0]), 2.0 / 30.0, 1e-6);
}

TEST(JointAngles, HaveDeviationsThatGrowWithThoseOfTheJoints) {
  std::array<double, 2> sd{};
  for (std::size_t i = 0; i < 2; ++i) {
    Take take = take_of({{knee_bent(deg(60))}}, 30.0);
    const double sigma = i == 0 ? 0.01 : 0.02;
    take.persons[0].poses[0].variance.fill(sigma * sigma);
    const auto rows = rows_of(angles_csv_of(take), ',');
    sd[i] = std::stod(rows[1][column_of(rows[0], "rightKnee.flexionNegative_sd_deg")]);
  }
  // 10 mm at a shank and a thigh of 0.4 m: hip, knee (twice) and ankle give some 3.5 degrees.
  EXPECT_GT(sd[0], 2.0);
  EXPECT_LT(sd[0], 5.0);
  EXPECT_NEAR(sd[1] / sd[0], 2.0, 0.1);
}

TEST(JointAngles, AreEmptyWhereNothingIsKnown) {
  Take take = take_of({{knee_bent(deg(60))}}, 30.0);
  auto rows = rows_of(angles_csv_of(take), ',');
  EXPECT_FALSE(rows[1][column_of(rows[0], "rightKnee.flexionNegative_deg")].empty());
  EXPECT_TRUE(rows[1][column_of(rows[0], "rightKnee.flexionNegative_sd_deg")].empty());
  take.persons[0].poses[0].skeleton[JointId::AnkleRight].state = JointState::NotTracked;
  rows = rows_of(angles_csv_of(take), ',');
  EXPECT_TRUE(rows[1][column_of(rows[0], "rightKnee.flexionNegative_deg")].empty());
}

TEST(JointAngles, DoNotLeapWhereSomebodyTurnsRound) {
  std::vector<Skeleton<WorldSpace>> frames;
  for (int i = 0; i < 90; ++i) frames.push_back(testing::standing_person({0, 0, 0}, deg(8.0 * i)));
  const Take take = take_of({frames}, 30.0);
  const auto mot = mot_of(take.persons.front(), 30.0);
  ASSERT_TRUE(mot);
  const auto rows = rows_of(mot->substr(mot->find("endheader\n") + 10), '\t');
  const std::size_t yaw = column_of(rows[0], "pelvis_rotation");
  for (std::size_t i = 2; i < rows.size(); ++i)
    EXPECT_NEAR(std::stod(rows[i][yaw]) - std::stod(rows[i - 1][yaw]), 8.0, 0.1) << i;
}

TEST(JointAngles, MotIsWhatOpenSimsReaderAsksFor) {
  // Lines up to "endheader", of which "key=value" are facts; then "time" and labels; then rows of
  // as many numbers, without an empty line or field between them.
  const Take take = take_of({walk()}, 30.0);
  const std::string mot = mot_of(take.persons.front(), 30.0).value();
  const std::size_t end = mot.find("\nendheader\n");
  ASSERT_NE(end, std::string::npos);
  const std::string head = mot.substr(0, end);
  EXPECT_EQ(head.substr(0, head.find('\n')), "Coordinates");
  const auto rows = rows_of(mot.substr(end + 11), '\t');
  for (const std::string& fact : std::vector<std::string>{
           "version=1", "inDegrees=yes", "nRows=" + std::to_string(take.frames),
           "nColumns=" + std::to_string(rows[0].size())})
    EXPECT_NE(head.find("\n" + fact), std::string::npos) << fact;
  ASSERT_EQ(rows.size(), take.frames + 1);
  EXPECT_EQ(rows[0][0], "time");
  EXPECT_EQ(std::set<std::string>(rows[0].begin(), rows[0].end()).size(), rows[0].size());
  for (std::size_t r = 1; r < rows.size(); ++r) {
    ASSERT_EQ(rows[r].size(), rows[0].size());
    for (const std::string& field : rows[r]) {
      std::size_t read = 0;
      ASSERT_NO_THROW((void)std::stod(field, &read)) << field;
      ASSERT_EQ(read, field.size()) << field;
    }
  }
}

TEST(JointAngles, RefuseNobody) {
  PersonTrack unseen;
  unseen.poses.resize(3);
  EXPECT_FALSE(mot_of(unseen, 30.0));
}

}  // namespace
}  // namespace chorus::exporters
