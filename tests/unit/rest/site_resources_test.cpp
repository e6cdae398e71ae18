#include "fusion-server/rest/site_resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace chorus::rest {
namespace {

using ::testing::IsEmpty;

site::SiteView view_of_one() {
  site::SiteView view;
  view.site = "hall";
  view.own = site::CellId::parse("a").value();
  site::SitePerson person;
  person.id = site::SiteId::parse("k1").value();
  person.certainty = 0.98765;
  person.cell = site::CellId::parse("b").value();
  person.body = PersonId{3};
  person.place = {1.234567, 0.9, -2};
  person.seen_by = {view.own, person.cell};
  view.people.push_back(person);
  site::KnownCell own;
  own.state.cell = view.own;
  own.state.placed = true;
  own.url = "http://10.0.0.5:8080/";
  own.software = "0.5.0";
  own.place = site::CellPlace{};
  site::KnownCell other;
  other.state.cell = person.cell;
  other.state.mistrusted = true;
  other.state.last = from_unix_ns(1'795'246'200'000'000'000);
  other.state.learned = 12.34;
  other.state.off = {0.0512, -0.2};
  view.cells = {own, other};
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->sequence = 5;
  snapshot->bodies.resize(1);
  snapshot->bodies[0].id = PersonId{77};
  view.snapshot = snapshot;
  view.connection = {true, "nats://10.0.0.9:4222", "may not", 1, 2, 3, "garbage"};
  return view;
}

nlohmann::json json_of(const resource::Node& node) {
  return nlohmann::json::parse(resource::write(node, resource::Format::Json));
}

TEST(SitePeople, AreListedBySiteIdWithTheirCell) {
  const auto node = site_people_node(view_of_one());
  EXPECT_THAT(resource::undeclared_terms(node), IsEmpty());
  const auto one = json_of(node).at("sitePeople").at("k1");
  EXPECT_EQ(one.at("bodyId"), 77);
  EXPECT_EQ(one.at("cell"), "b");
  EXPECT_EQ(one.at("cellBodyId"), 3);
  EXPECT_EQ(one.at("x"), 1.23457);
  EXPECT_EQ(one.at("siteCertainty"), 0.988);
  EXPECT_EQ(one.at("cells"), nlohmann::json({"a", "b"}));
}

TEST(SiteCells, SayHowTheyAreAndWhetherWeAreConnected) {
  const auto node = site_cells_node(view_of_one());
  EXPECT_THAT(resource::undeclared_terms(node), IsEmpty());
  const auto all = json_of(node);
  EXPECT_EQ(all.at("connected"), true);
  EXPECT_EQ(all.at("cell"), "a");
  EXPECT_EQ(all.at("lastRefusal"), "garbage");
  EXPECT_EQ(all.at("siteCells").at("a").at("state"), "own");
  EXPECT_EQ(all.at("siteCells").at("a").at("qw"), 1.0);
  EXPECT_EQ(all.at("siteCells").at("b").at("state"), "mistrusted");
  EXPECT_FALSE(all.at("siteCells").at("b").contains("x"));
  EXPECT_EQ(all.at("siteCells").at("b").at("learnedFor"), 12.3);
  EXPECT_EQ(all.at("siteCells").at("b").at("offX"), 0.051);
  EXPECT_EQ(all.at("siteCells").at("b").at("offZ"), -0.2);
  EXPECT_FALSE(all.at("siteCells").at("a").contains("offX"));
}

}  // namespace
}  // namespace chorus::rest
