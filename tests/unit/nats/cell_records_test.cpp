#include "fusion-server/nats/cell_records.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "fusion-server/nats/subjects.h"

namespace chorus::nats {
namespace {

using ::testing::HasSubstr;

site::CellPlace place_of(const char* cell) {
  site::CellPlace place;
  place.cell = site::CellId::parse(cell).value();
  place.site_from_cell.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
  place.site_from_cell.translation() = Eigen::Vector3d(4, 0.01, -7);
  place.covariance.diagonal() << 1e-4, 1e-4, 1e-4, 0.01, 0.01, 0.01;
  place.clock_added = std::chrono::milliseconds(-40);
  place.clock_sigma = std::chrono::milliseconds(3);
  place.version = 5;
  return place;
}

void expect_same(const site::CellPlace& one, const site::CellPlace& other) {
  EXPECT_EQ(one.cell, other.cell);
  EXPECT_TRUE(one.site_from_cell.isApprox(other.site_from_cell, 1e-9));
  EXPECT_TRUE(one.covariance.isApprox(other.covariance, 1e-9));
  EXPECT_EQ(one.clock_added, other.clock_added);
  EXPECT_EQ(one.clock_sigma, other.clock_sigma);
  EXPECT_EQ(one.version, other.version);
}

TEST(ACellsCard, ComesBackWithItsPlaceOrWithout) {
  CellCard card{place_of("a").cell, 9, "http://10.0.0.5:8080/", "0.5.0", place_of("a")};
  auto back = read_card(write_card(card));
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->boot, 9U);
  EXPECT_EQ(back->url, card.url);
  ASSERT_TRUE(back->place);
  expect_same(*back->place, *card.place);
  card.place.reset();
  back = read_card(write_card(card));
  ASSERT_TRUE(back);
  EXPECT_FALSE(back->place);
  EXPECT_LT(write_card({card.cell, 9, "", "", place_of("a")}).size(), kMostRecordBytes);
}

TEST(ACellsCard, IsRefusedIfItsPlaceIsNone) {
  EXPECT_THAT(read_card(R"({"cell":"a","boot":1,"place":{"x":1}})").error().context,
              HasSubstr("qw"));
  EXPECT_FALSE(read_card(R"({"cell":"a","boot":1,"place":7})"));
  EXPECT_FALSE(read_card(R"({"cell":"a b","boot":1})"));
  EXPECT_FALSE(read_card("{}"));
  EXPECT_FALSE(read_card(""));
  const std::string long_url(5000, 'x');
  EXPECT_EQ(read_card(R"({"cell":"a","boot":1,"url":")" + long_url + "\"}").error().code,
            ErrorCode::TooLarge);
}

TEST(AClaim, ComesBackInEachState) {
  site::Claim claim;
  claim.id = site::SiteId::parse("k1").value();
  claim.cell = site::CellId::parse("b").value();
  for (const auto state : {site::ClaimState::Held, site::ClaimState::Released}) {
    claim.state = state;
    const auto back = read_claim(claim_key(claim.id), write_claim(claim), 17);
    ASSERT_TRUE(back) << to_string(back.error());
    EXPECT_EQ(back->id, claim.id);
    EXPECT_EQ(back->cell, claim.cell);
    EXPECT_EQ(back->state, state);
    EXPECT_EQ(back->revision, 17U);
    EXPECT_FALSE(back->same_as);
  }
  claim.state = site::ClaimState::Joined;
  EXPECT_FALSE(read_claim(claim_key(claim.id), write_claim(claim), 1)) << "to nobody";
  claim.same_as = site::SiteId::parse("k0").value();
  EXPECT_EQ(read_claim(claim_key(claim.id), write_claim(claim), 1)->same_as, claim.same_as);
}

TEST(AClaim, IsRefusedIfItIsNone) {
  EXPECT_FALSE(read_claim("cell.k1", R"({"cell":"a","state":"held"})", 1));
  EXPECT_FALSE(read_claim("person.", R"({"cell":"a","state":"held"})", 1));
  EXPECT_FALSE(read_claim("person.k1", R"({"cell":"a","state":"mine"})", 1));
  EXPECT_FALSE(read_claim("person.k1", R"({"state":"held"})", 1));
  EXPECT_FALSE(read_claim("person.k1", "mine", 1));
  EXPECT_TRUE(read_claim("person.k1", R"({"cell":"a","state":"held"})", 1));
}

TEST(AFileOfPlaces, ComesBackAndNamesTheCellThatIsWrong) {
  const auto back = read_places(write_places({place_of("a"), place_of("b")}));
  ASSERT_TRUE(back) << to_string(back.error());
  ASSERT_EQ(back->size(), 2U);
  expect_same((*back)[1], place_of("b"));
  EXPECT_TRUE(
      read_places("// typed\n{\"cells\": {\"a\": {\"x\": 0, \"y\": 0, \"z\": 0, \"qx\": 0, "
                  "\"qy\": 0, \"qz\": 0, \"qw\": 1}}}"));
  EXPECT_THAT(read_places(R"({"cells": {"b": {"x": 0}}})").error().context, HasSubstr("cells.b"));
  EXPECT_FALSE(read_places("{}"));
  EXPECT_FALSE(read_places("[]"));
}

TEST(ASubject, NamesItsCellWithinTheSite) {
  EXPECT_EQ(subject_of("hall", "a", kPeople), "chorus.hall.a.people");
  EXPECT_EQ(cell_of("chorus.hall.a.people", "hall")->str(), "a");
  EXPECT_EQ(cell_of("chorus.hall.a.ask.frame", "hall")->str(), "a");
  EXPECT_FALSE(cell_of("chorus.yard.a.people", "hall"));
  EXPECT_FALSE(cell_of("chorus.hall..people", "hall"));
}

TEST(ASameAs, ComesBackAndIsToldFromOtherEvents) {
  const site::SameAs joined{site::SiteId::parse("k0").value(), site::SiteId::parse("k1").value()};
  const auto back = read_same_as(write_same_as(joined));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->kept, joined.kept);
  EXPECT_EQ(back->joined, joined.joined);
  EXPECT_FALSE(read_same_as(R"({"event":"Joined","siteId":"k0","other":"k1"})"));
  EXPECT_FALSE(read_same_as(R"({"event":"SameAs","siteId":"k0"})"));
  EXPECT_FALSE(read_same_as("SameAs"));
}

TEST(AnEvent, IsNamedAndLeavesOutWhatIsEmpty) {
  site::SiteEvent event;
  event.kind = site::SiteEventKind::CellMistrusted;
  event.cell = site::CellId::parse("b").value();
  EXPECT_EQ(write_event(event), R"({"at":"0","cell":"b","event":"CellMistrusted"})");
}

}  // namespace
}  // namespace chorus::nats
