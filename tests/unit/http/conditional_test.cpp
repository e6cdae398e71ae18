#include "common/http/conditional.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

TEST(NoneMatch, ListsWeakTagsAndTheStar) {
  for (const auto list :
       {"\"a\"", "W/\"a\"", "\"b\", \"a\"", "\"x,y\",\"a\"", " * ", "*", "\"b\" , W/\"a\"  "})
    EXPECT_TRUE(none_match_lists(list, "\"a\"")) << list;
  for (const auto list : {"", "\"b\"", "a", "\"A\"", "w/\"a\"", "\"a", "\"a\"b", "**", ",,"})
    EXPECT_FALSE(none_match_lists(list, "\"a\"")) << list;
}

TEST(WaitPreference, FindsTheNumber) {
  EXPECT_EQ(wait_preference("wait=10"), std::chrono::seconds(10));
  EXPECT_EQ(wait_preference("respond-async, Wait = 5 ; foo=bar"), std::chrono::seconds(5));
  EXPECT_EQ(wait_preference("wait=0"), std::chrono::seconds(0));
  EXPECT_EQ(wait_preference("wait=99999999999"), std::chrono::seconds(86400));
}

TEST(WaitPreference, AbsentOrNoNumber) {
  for (const auto prefer : {"", "wait", "wait=", "wait=x", "wait=-1", "wait=1.5", "waiting=3",
                            "return=minimal", "wait=99999999999999999999999"})
    EXPECT_FALSE(wait_preference(prefer)) << prefer;
}

}  // namespace
}  // namespace chorus::http
