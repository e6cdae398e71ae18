#include "fusion-server/rest/prop_resources.h"

#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/unit/rest/asked.h"

namespace chorus::rest {
namespace {

using ::testing::HasSubstr;
using testing::kStart;

struct Shelf {
  std::shared_ptr<workplace::PropBoard> board = std::make_shared<workplace::PropBoard>(
      std::vector<workplace::Prop>{{.name = "driver", .other = {}, .size = {0.2, 0.05, 0.05}}});
  http::Router router;
  PropResources props{{"run1"}, board};

  Shelf() { props.add_routes(router); }
  std::string shown() { return body(ask(router, "/props/"), "application/json"); }
};

TEST(Props, AreTakenUpAndPutDown) {
  Shelf shelf;
  shelf.props.publish(snapshot(1));
  EXPECT_THAT(shelf.shown(), HasSubstr("\"propTracked\": false"));
  ASSERT_TRUE(shelf.board->take_up("driver", 7));
  shelf.props.publish(snapshot(2));
  const std::string held = shelf.shown();
  EXPECT_THAT(held, HasSubstr("\"propTracked\": true"));
  EXPECT_THAT(held, HasSubstr("\"heldBy\": 7"));
  EXPECT_THAT(held, HasSubstr("\"qw\""));
  ASSERT_TRUE(shelf.board->put_down("driver"));
  shelf.props.publish(snapshot(3));
  EXPECT_THAT(shelf.shown(), HasSubstr("\"propTracked\": false"));
  EXPECT_THAT(shelf.shown(), HasSubstr("\"qw\""));  // where it lies
}

TEST(Props, TermsAreDeclared) {
  const auto prop = workplace::Prop{
      .name = "box", .joint = JointId::HandLeft, .other = JointId::HandRight, .size = {1, 1, 1}};
  workplace::PropPose pose;
  pose.sigma = 0.01;
  const auto node = props_node(kStart, {prop}, {{{3, 1}, pose, true}});
  EXPECT_EQ(resource::undeclared_terms(node), std::vector<std::string>{});
}

TEST(Props, WhoTakesOneUpIsNamedOrTheOnlyOne) {
  EXPECT_EQ(parse_holder("", {4}).value(), 4u);
  EXPECT_EQ(parse_holder(R"({"person": 5})", {4, 5}).value(), 5u);
  const auto message = [](const char* text, const std::vector<std::uint64_t>& here) {
    return to_string(parse_holder(text, here).error());
  };
  EXPECT_THAT(message("", {}), HasSubstr("nobody"));
  EXPECT_THAT(message("", {4, 5}), HasSubstr("4, 5"));
  EXPECT_THAT(message(R"({"person": 6})", {4, 5}), HasSubstr("4, 5"));
  EXPECT_THAT(message(R"({"person": "x"})", {4}), HasSubstr("NUMBER"));
  EXPECT_THAT(message(R"({"persons": 4})", {4}), HasSubstr("NUMBER"));
}

}  // namespace
}  // namespace chorus::rest
