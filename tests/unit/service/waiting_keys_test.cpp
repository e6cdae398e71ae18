#include "common/service/waiting_keys.h"

#include <gtest/gtest.h>

namespace chorus::service {
namespace {

bool always(const std::string&) { return true; }

TEST(WaitingKeys, NamesWhatDiffersByItsPath) {
  EXPECT_EQ(waiting_keys(R"({"a": 1, "b": {"c": 2, "d": 3}})", R"({"a": 1, "b": {"c": 9, "d": 3}})",
                         always),
            "b.c");
  EXPECT_EQ(waiting_keys(R"({"a": 1})", R"({"a": 1})", always), "");
  EXPECT_EQ(waiting_keys("{}", R"({"b": {"c": 1, "d": {"e": 2}}})", always), "b.c, b.d.e");
  EXPECT_EQ(waiting_keys(R"({"b": {"c": 1}, "z": 1})", R"({"z": 2})", always), "b.c, z");
}

TEST(WaitingKeys, TakesAListAsAWhole) {
  EXPECT_EQ(waiting_keys(R"({"l": [1, {"a": 1}]})", R"({"l": [1, {"a": 2}, 3]})", always), "l");
}

TEST(WaitingKeys, TriesEachChangeAlone) {
  std::string tried;
  const auto notes = [&](const std::string& text) {
    tried += text;
    return text.find("\"live\":2") == std::string::npos;
  };
  EXPECT_EQ(waiting_keys(R"({"gone": 1, "live": 1, "new": {}, "start": 1})",
                         R"({"live": 2, "new": {"x": true}, "start": 2})", notes),
            "gone, new.x, start");
  EXPECT_EQ(tried, R"({"live":1,"new":{},"start":1})"
                   R"({"gone":1,"live":2,"new":{},"start":1})"
                   R"({"gone":1,"live":1,"new":{"x":true},"start":1})"
                   R"({"gone":1,"live":1,"new":{},"start":2})");
}

TEST(WaitingKeys, AValueMayBecomeASection) {
  EXPECT_EQ(waiting_keys(R"({"a": 1})", R"({"a": {"b": 1}})", always), "a");
  EXPECT_EQ(waiting_keys(R"({"a": {"b": 1}})", R"({"a": 1})", always), "a");
}

TEST(WaitingKeys, WhatIsNoConfigurationNamesNothing) {
  EXPECT_EQ(waiting_keys("[1]", "{", always), "");
}

}  // namespace
}  // namespace chorus::service
