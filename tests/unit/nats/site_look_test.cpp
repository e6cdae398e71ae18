// Frames of the site: one instant, growing sequences, our own people moved with the others.
#include "fusion-server/nats/site_look.h"

#include <gtest/gtest.h>

namespace chorus::nats {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kPelvis = index_of(JointId::SpineBase);
const Timestamp kBegin = from_unix_ns(1'795'246'200'000'000'000);

site::CellId cell(const char* name) { return site::CellId::parse(name).value(); }

std::shared_ptr<const Snapshot> snapshot_of(std::uint64_t sequence, Duration after) {
  auto made = std::make_shared<Snapshot>();
  made->sequence = sequence;
  made->instant = kBegin + after;
  made->bodies.resize(1);
  made->bodies[0].id = PersonId{5};
  made->bodies[0].variance.fill(1e-4);
  Joint& pelvis = made->bodies[0].skeleton.joints[kPelvis];
  pelvis.position = Eigen::Vector3d(1, 0.9, 2);
  pelvis.state = JointState::Tracked;
  pelvis.covariance = Covariance(Eigen::Matrix3d(1e-4 * Eigen::Matrix3d::Identity()));
  return made;
}

site::SitePerson person_of(const char* by, Duration after) {
  site::SitePerson person;
  person.id = site::SiteId::parse("k1").value();
  person.cell = cell(by);
  person.body = PersonId{5};
  person.at = kBegin + after;
  person.place = Eigen::Vector3d(1, 0.9, 2);
  person.velocity = Eigen::Vector3d(1, 0, 0);
  person.joints[kPelvis] = person.place;
  return person;
}

TEST(ALook, OfASnapshotHasItsInstantAndALaterOneIsMovedOn) {
  SiteLook window(cell("a"), {});
  site::CellPlace place;
  place.cell = cell("a");
  place.clock_added = milliseconds(7);
  const auto mine = person_of("a", milliseconds(7));
  const auto first = window.show({&mine, 1}, {snapshot_of(40, {}), {}, place});
  EXPECT_EQ(first->sequence, 40U);
  EXPECT_EQ(first->instant, kBegin + milliseconds(7));
  EXPECT_EQ(first->bodies[0].skeleton.joints[kPelvis].position, Eigen::Vector3d(1, 0.9, 2));
  const auto second = window.show({&mine, 1}, {snapshot_of(40, {}), milliseconds(20), place});
  EXPECT_EQ(second->sequence, 41U);
  EXPECT_EQ(second->instant, kBegin + milliseconds(27));
  const FusedBody& moved = second->bodies[0];
  EXPECT_NEAR(moved.skeleton.joints[kPelvis].position.x(), 1.02, 1e-9);
  const double doubt = 0.3 * 0.02 * 0.3 * 0.02;
  EXPECT_NEAR(moved.skeleton.joints[kPelvis].covariance.matrix()(0, 0), 1e-4 + doubt, 1e-9);
  EXPECT_NEAR(moved.variance[kPelvis], 1e-4 + doubt, 1e-9);
}

TEST(ALook, NeverGoesBack) {
  SiteLook window(cell("a"), {});
  const auto late = window.show({}, {snapshot_of(40, {}), milliseconds(50), {}});
  const auto next = window.show({}, {snapshot_of(41, milliseconds(33)), {}, {}});
  EXPECT_GT(next->instant, late->instant);
  EXPECT_LT(next->instant - late->instant, milliseconds(1));
  EXPECT_EQ(next->sequence, 41U);
  EXPECT_EQ(window.show({}, {snapshot_of(41, milliseconds(33)), milliseconds(30), {}})->sequence,
            42U);
  EXPECT_EQ(window.show({}, {snapshot_of(42, milliseconds(66)), {}, {}})->sequence, 43U);
  // A clock that was set back by an hour is followed.
  const auto back = window.show({}, {snapshot_of(43, -std::chrono::hours(1)), {}, {}});
  EXPECT_EQ(back->instant, kBegin - std::chrono::hours(1));
}

TEST(ALook, BlendsOurOwnBodyIntoThatOfANeighbour) {
  SiteLook window(cell("a"), {});
  site::CellPlace place;
  place.cell = cell("a");
  const auto theirs = [] {
    site::SitePerson person = person_of("b", {});
    person.velocity.setZero();
    return person;
  }();
  auto mine = person_of("a", milliseconds(33));
  mine.velocity.setZero();
  auto own = std::make_shared<Snapshot>(*snapshot_of(41, milliseconds(33)));
  own->bodies[0].skeleton.joints[kPelvis].position.x() = 1.2;
  mine.place.x() = 1.2;
  mine.joints[kPelvis]->x() = 1.2;
  (void)window.show({&theirs, 1}, {snapshot_of(40, {}), {}, place});
  const auto handed = window.show({&mine, 1}, {own, {}, place});
  const Joint& pelvis = handed->bodies[0].skeleton.joints[kPelvis];
  EXPECT_NEAR(pelvis.position.x(), 1.0, 1e-9);
  EXPECT_NEAR(pelvis.covariance.matrix()(0, 0), 1e-4 + 0.04, 1e-6);
}

}  // namespace
}  // namespace chorus::nats
