// What frames of the site show of people whom several cells tell of, at one instant.
#include "fusion-server/site/shown.h"

#include <gtest/gtest.h>

namespace chorus::site {
namespace {

using std::chrono::milliseconds;

constexpr double kPeriod = 1.0 / 30.0;
constexpr std::size_t kPelvis = index_of(JointId::SpineBase);
constexpr std::size_t kHead = index_of(JointId::Head);

Timestamp at_time(double time) {
  return from_unix_ns(1'795'246'200'000'000'000) + from_seconds(time);
}

/// Somebody who walks along x at 1.2 m/s, as cell `cell` tells them: by `off` elsewhere.
SitePerson walker(const char* cell, double time, const Eigen::Vector3d& off = {0, 0, 0}) {
  SitePerson person;
  person.id = SiteId::parse("k1").value();
  person.cell = CellId::parse(cell).value();
  person.at = at_time(time);
  person.velocity = Eigen::Vector3d(1.2, 0, 0);
  person.place = Eigen::Vector3d(1.2 * time, 0.9, 0) + off;
  person.joints[kPelvis] = person.place;
  person.joints[kHead] = person.place + Eigen::Vector3d(0, 0.7, 0);
  person.covariance = 1e-4 * Eigen::Matrix3d::Identity();
  return person;
}

/// Where the head is shown.
Eigen::Vector3d head_of(const ShownPerson& shown) {
  return *shown.told.joints[kHead] + shown.moved[kHead];
}

ShownPerson show(Showing& showing, const SitePerson& person, double time) {
  const auto all = showing.show({&person, 1}, at_time(time));
  EXPECT_EQ(all.size(), 1U);
  return all.front();
}

TEST(Showing, MovesPeopleOnToTheInstantAndSaysHowWellItKnows) {
  Showing showing({});
  const ShownPerson now = show(showing, walker("a", 1.0), 1.0);
  EXPECT_EQ(now.place(), now.told.place);
  EXPECT_TRUE(now.doubt.isZero());
  const ShownPerson later = show(showing, walker("a", 1.0), 1.1);
  EXPECT_NEAR(later.place().x(), 1.2 * 1.1, 1e-9);
  EXPECT_NEAR(head_of(later).x(), 1.2 * 1.1, 1e-9);
  EXPECT_NEAR(later.doubt(0, 0), 0.03 * 0.03, 1e-9);
  // What is seconds old is not sent on for ever.
  EXPECT_NEAR(show(showing, walker("a", 1.0), 9.0).place().x(), 1.2 * 1.5, 1e-9);
}

TEST(Showing, LetsABodyGoOnWhereItWasWhenAnotherCellAnswers) {
  const Eigen::Vector3d off(0.05, 0.01, -0.23);
  Showing showing({});
  double largest = 0.0;  // step against an even pace [m]
  double fastest = 0.0;  // that the difference fades [m/s]
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int i = 0; i < 60; ++i) {
    const double time = i * kPeriod;
    const bool handed_over = i >= 20;
    // The other cell's word is 40 ms older.
    const ShownPerson shown = handed_over ? show(showing, walker("b", time - 0.04, off), time)
                                          : show(showing, walker("a", time), time);
    const Eigen::Vector3d head = head_of(shown);
    const double strayed = (head - before - Eigen::Vector3d(1.2 * kPeriod, 0, 0)).norm();
    if (i == 20) {
      EXPECT_LT(strayed, 1e-6);
      EXPECT_NEAR(shown.doubt.trace(), off.squaredNorm() + 3 * 0.012 * 0.012, 1e-4);
    }
    if (i > 0) largest = std::max(largest, strayed);
    if (i > 20) fastest = std::max(fastest, strayed / kPeriod);
    before = head;
  }
  EXPECT_LT(largest, 0.025);
  EXPECT_NEAR(fastest, 1.5 * off.norm() / 0.5, 0.05);
  // Half a second later the new cell's word stands.
  EXPECT_NEAR(before.z(), off.z(), 1e-9);
}

TEST(Showing, StatesTheDifferenceAsLongAsItIsThere) {
  const Eigen::Vector3d off(0, 0, 0.2);
  Showing showing({});
  (void)show(showing, walker("a", 0.0), 0.0);
  double last = 1.0;
  for (const double time : {0.0333, 0.15, 0.3, 0.45}) {
    const ShownPerson shown = show(showing, walker("b", time, off), time);
    const double wrong = off.z() - shown.place().z();
    EXPECT_NEAR(shown.doubt(2, 2), wrong * wrong, 1e-9);
    EXPECT_LT(shown.doubt(2, 2), last);
    last = shown.doubt(2, 2);
  }
  EXPECT_TRUE(show(showing, walker("b", 0.6, off), 0.6).doubt.isZero());
}

TEST(Showing, KeepsWhatTheCellsPlacesDoNotKnow) {
  Showing showing({});
  SitePerson person = walker("a", 0.0);
  person.cell_covariance = 0.04 * Eigen::Matrix3d::Identity();
  EXPECT_EQ(show(showing, person, 0.0).doubt, person.cell_covariance);
}

TEST(Showing, MakesUpNoPathBetweenCellsThatContradictOneAnother) {
  Showing showing({});
  (void)show(showing, walker("a", 0.0), 0.0);
  const ShownPerson far = show(showing, walker("b", 0.033, {3, 0, 0}), 0.033);
  EXPECT_EQ(far.place(), far.told.place);
  EXPECT_TRUE(far.doubt.isZero());
}

TEST(Showing, BeginsAnewWithWhoWasAway) {
  Showing showing({});
  (void)show(showing, walker("a", 0.0), 0.0);
  EXPECT_TRUE(showing.show({}, at_time(0.1)).empty());
  const ShownPerson back = show(showing, walker("b", 0.15, {0, 0, 0.2}), 0.15);
  EXPECT_EQ(back.place(), back.told.place);
}

TEST(Showing, TakesTheBlendOverWhenTheCellChangesBack) {
  Showing showing({});
  (void)show(showing, walker("a", 0.0), 0.0);
  (void)show(showing, walker("b", 0.1, {0, 0, 0.2}), 0.1);
  const ShownPerson there = show(showing, walker("b", 0.3, {0, 0, 0.2}), 0.3);
  const ShownPerson back = show(showing, walker("a", 0.333), 0.333);
  EXPECT_NEAR(back.place().z(), there.place().z(), 1e-9);
}

TEST(Showing, LetsJointsOfOneCellOnlyGoWithThePelvis) {
  Showing showing({});
  SitePerson headless = walker("a", 0.0);
  headless.joints[kHead].reset();
  (void)show(showing, headless, 0.0);
  const ShownPerson shown = show(showing, walker("b", 0.033, {0, 0, 0.2}), 0.033);
  EXPECT_NEAR(head_of(shown).z(), 0.0, 1e-9);
  EXPECT_NEAR(head_of(shown).y(), 1.6, 1e-9);
}

}  // namespace
}  // namespace chorus::site
