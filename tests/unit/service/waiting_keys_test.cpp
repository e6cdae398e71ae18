#include "common/service/waiting_keys.h"

#include <gtest/gtest.h>

namespace chorus::service {
namespace {

using Keys = std::vector<std::string>;

bool always(const std::string&) { return true; }

TEST(WaitingKeys, NamesWhatDiffersByItsPath) {
  EXPECT_EQ(waiting_keys(R"({"a": 1, "b": {"c": 2, "d": 3}})", R"({"a": 1, "b": {"c": 9, "d": 3}})",
                         always),
            Keys{"b.c"});
  EXPECT_EQ(waiting_keys(R"({"a": 1})", R"({"a": 1})", always), Keys{});
  EXPECT_EQ(waiting_keys("{}", R"({"b": {"c": 1, "d": {"e": 2}}})", always),
            (Keys{"b.c", "b.d.e"}));
  EXPECT_EQ(waiting_keys(R"({"b": {"c": 1}, "z": 1})", R"({"z": 2})", always), (Keys{"b.c", "z"}));
}

TEST(WaitingKeys, TakesAListAsAWhole) {
  EXPECT_EQ(waiting_keys(R"({"l": [1, {"a": 1}]})", R"({"l": [1, {"a": 2}, 3]})", always),
            Keys{"l"});
}

TEST(WaitingKeys, TriesEachChangeAlone) {
  std::string tried;
  const auto notes = [&](const std::string& text) {
    tried += text;
    return text.find("\"live\":2") == std::string::npos;
  };
  EXPECT_EQ(waiting_keys(R"({"gone": 1, "live": 1, "new": {}, "start": 1})",
                         R"({"live": 2, "new": {"x": true}, "start": 2})", notes),
            (Keys{"gone", "new.x", "start"}));
  EXPECT_EQ(tried, R"({"live":1,"new":{},"start":1})"
                   R"({"gone":1,"live":2,"new":{},"start":1})"
                   R"({"gone":1,"live":1,"new":{"x":true},"start":1})"
                   R"({"gone":1,"live":1,"new":{},"start":2})");
}

TEST(WaitingKeys, AValueMayBecomeASection) {
  EXPECT_EQ(waiting_keys(R"({"a": 1})", R"({"a": {"b": 1}})", always), Keys{"a"});
  EXPECT_EQ(waiting_keys(R"({"a": {"b": 1}})", R"({"a": 1})", always), Keys{"a"});
}

TEST(WaitingKeys, WhatWaitsIsNotInForce) {
  EXPECT_EQ(with_keys_of(R"({"a": 2, "b": {"c": 2}, "n": 1})", R"({"a": 1, "b": {"c": 1}})",
                         {"b.c", "n"}),
            R"({"a":2,"b":{"c":1}})");
  EXPECT_EQ(with_keys_of("no json", "{}", {"a"}), "no json");
}

TEST(WaitingKeys, WhatIsNoConfigurationNamesNothing) {
  EXPECT_EQ(waiting_keys("[1]", "{", always), Keys{});
}

}  // namespace
}  // namespace chorus::service
