#include "common/http/problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace chorus::http {
namespace {

TEST(Problem, TellsWhatAndWhatToChange) {
  const Error error{ErrorCode::NotFound, "skeletons/9", "nobody has this id"};
  Problem problem = problem_of(error);
  problem.instance = "/skeletons/9";
  const auto json = nlohmann::json::parse(problem_json(problem));
  EXPECT_EQ(json, (nlohmann::json{{"type", "about:blank"},
                                  {"title", "Not Found"},
                                  {"status", 404},
                                  {"detail", "nobody has this id"},
                                  {"instance", "/skeletons/9"},
                                  {"code", "not-found"},
                                  {"context", "skeletons/9"}}));
}

TEST(Problem, BytesThatAreNoTextAreReplaced) {
  const auto json = problem_json({400, "malformed", "/\xff", "", "quote \" and \n"});
  EXPECT_EQ(nlohmann::json::parse(json)["instance"], "/\xEF\xBF\xBD");
}

TEST(Problem, HeadKeepsTheLengthOfTheBody) {
  const Problem problem{404, "not-found"};
  const Answer get = problem_answer(problem, false);
  const Answer head = problem_answer(problem, true);
  EXPECT_EQ(head.own, get.own);
  EXPECT_EQ(head.body, "");
  EXPECT_THAT(std::string(get.own),
              ::testing::HasSubstr("Content-Length: " + std::to_string(get.body.size())));
}

TEST(Problem, UnavailableSaysWhenToAskAgain) {
  EXPECT_EQ(problem_answer({503}, false).extra, "Retry-After: 1\r\n");
  EXPECT_EQ(problem_answer({404}, false).extra, "");
}

}  // namespace
}  // namespace chorus::http
