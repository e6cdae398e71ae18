#include "fusion-server/nats/people_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/body/bones.h"

namespace chorus::nats {
namespace {

using ::testing::HasSubstr;

constexpr Timestamp kAt = from_unix_ns(1'795'246'200'123'456'789);

site::Person somebody(std::uint64_t id) {
  site::Person person;
  person.body = PersonId{id};
  person.site_id = site::SiteId::parse("kx3-a-1").value();
  person.site_certainty = 0.97;
  person.since = kAt - std::chrono::seconds(3);
  person.named = kAt - std::chrono::seconds(2);
  person.place = {1.23456, 0.95, -2.5};
  person.velocity = {0.5, 0, -1.25};
  person.covariance << 0.01, 0.001, 0, 0.001, 0.02, 0, 0, 0, 0.03;
  person.joints[index_of(JointId::Head)] = Eigen::Vector3d(1.2, 1.7, -2.4);
  person.lengths.mean[2] = -0.9;
  person.lengths.variance[2] = 0.0004;
  person.sides = 0.99;
  person.carried = std::chrono::milliseconds(250);
  return person;
}

site::CellPeople people_of(std::size_t count) {
  site::CellPeople people{site::CellId::parse("a").value(), 7, 12, kAt, {}};
  for (std::size_t i = 0; i < count; ++i) people.people.push_back(somebody(i + 1));
  return people;
}

nlohmann::json as_json(const site::CellPeople& people) {
  return nlohmann::json::parse(write_people(people));
}

Error error_of(const nlohmann::json& message) {
  const auto read = read_people(message.dump());
  return read ? Error{ErrorCode::Internal, "", "was accepted"} : read.error();
}

TEST(AMessageOfPeople, ComesBackAsItWasWritten) {
  const auto back = read_people(write_people(people_of(1)));
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_EQ(back->cell.str(), "a");
  EXPECT_EQ(back->boot, 7U);
  EXPECT_EQ(back->sequence, 12U);
  EXPECT_EQ(back->at, kAt);
  ASSERT_EQ(back->people.size(), 1U);
  const site::Person& one = back->people[0];
  const site::Person wanted = somebody(1);
  EXPECT_EQ(one.body, wanted.body);
  EXPECT_EQ(one.site_id, wanted.site_id);
  EXPECT_DOUBLE_EQ(one.site_certainty, 0.97);
  EXPECT_EQ(one.since, wanted.since);
  EXPECT_EQ(one.named, wanted.named);
  EXPECT_TRUE(one.place.isApprox(wanted.place, 1e-9));
  EXPECT_TRUE(one.velocity.isApprox(wanted.velocity, 1e-9));
  EXPECT_TRUE(one.covariance.isApprox(wanted.covariance, 1e-6));
  EXPECT_EQ(one.joints[index_of(JointId::Head)], wanted.joints[index_of(JointId::Head)]);
  EXPECT_FALSE(one.joints[index_of(JointId::Neck)]);
  EXPECT_DOUBLE_EQ(one.lengths.mean[2], -0.9);
  EXPECT_DOUBLE_EQ(one.lengths.variance[2], 0.0004);
  EXPECT_FALSE(one.lengths.variance[0] > 0.0);
  EXPECT_DOUBLE_EQ(one.sides.value(), 0.99);
  EXPECT_EQ(one.carried, Duration(std::chrono::milliseconds(250)));
}

TEST(AMessageOfPeople, IsLean) {
  EXPECT_LT(write_people(people_of(1)).size(), 700U);
  EXPECT_EQ(as_json(people_of(kMostPeople + 3)).at("people").size(), kMostPeople);
}

TEST(AMessageOfPeople, SaysNothingOfWhatIsNotKnown) {
  site::CellPeople people = people_of(1);
  people.people[0] = {};
  const auto back = read_people(write_people(people));
  ASSERT_TRUE(back) << to_string(back.error());
  EXPECT_FALSE(back->people[0].site_id);
  EXPECT_FALSE(back->people[0].named);
  EXPECT_FALSE(back->people[0].sides);
  EXPECT_FALSE(back->people[0].carried);
  EXPECT_TRUE(back->people[0].covariance.isZero());
}

TEST(AMessageOfPeople, ThatIsWrongIsRefusedByName) {
  using nlohmann::json;
  const json good = as_json(people_of(2));
  const std::vector<std::pair<std::string, json>> wrong{
      {"/version", 2},
      {"/cell", "a.b"},
      {"/cell", nullptr},
      {"/sequence", -1},
      {"/at", "soon"},
      {"/at", 1795246200},
      {"/at", "9999999999999999999"},
      {"/people", json::object()},
      {"/people/0", 7},
      {"/people/1/id", 1},
      {"/people/0/place", {1, 2}},
      {"/people/0/place", {1, 2, 1e7}},
      {"/people/0/place", {1, 2, "3"}},
      {"/people/0/velocity", nullptr},
      {"/people/0/siteId", "a b"},
      {"/people/0/siteCertainty", 1.5},
      {"/people/0/covariance", {-1, 0, 0, 1, 0, 1}},
      {"/people/0/covariance", {1, 0, 0, 1, 0}},
      {"/people/0/joints", {{"Tail", {1, 2, 3}}}},
      {"/people/0/joints", {{"Head", {1, 2}}}},
      {"/people/0/lengths", {nullptr}},
      {"/people/0/lengths/2", {1, 0}},
      {"/people/0/sides", 2},
      {"/people/0/carriedFor", -1},
  };
  for (const auto& [pointer, value] : wrong) {
    json bad = good;
    bad[json::json_pointer(pointer)] = value;
    EXPECT_EQ(error_of(bad).code, ErrorCode::Malformed) << pointer << " = " << value;
  }
  json bad = good;
  bad["people"][1]["place"] = "here";
  EXPECT_EQ(error_of(bad).context, "people.1.place");
}

TEST(AMessageOfPeople, ThatIsTooLargeIsNotReadAtAll) {
  EXPECT_EQ(read_people(std::string(kMostPeopleBytes + 1, ' ')).error().code, ErrorCode::TooLarge);
  nlohmann::json many = as_json(people_of(1));
  for (std::size_t i = 0; i < 10'000; ++i) many["people"].push_back(1);
  EXPECT_EQ(error_of(many).context, "people");
}

TEST(AMessageOfPeople, NeverTellsOfPlacesThatAreNotFinite) {
  site::CellPeople people = people_of(1);
  people.people[0].velocity.x() = std::nan("");
  people.people[0].covariance(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(read_people(write_people(people)));
}

}  // namespace
}  // namespace chorus::nats
