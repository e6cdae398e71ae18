#include "common/http/router.h"

#include <gtest/gtest.h>

#include "common/http/route_table.h"

namespace chorus::http {
namespace {

Getter nothing() {
  return [](const Request&, const PathParams&) -> Result<DocumentPtr> {
    return make_document("text/plain", "", {});
  };
}

Action done() {
  return
      [](const Request&, const PathParams&) -> Result<ActionResult> { return ActionResult{204}; };
}

Router example() {
  Router router;
  for (const auto pattern : {"/", "/frame", "/frames/{seq}", "/sensors/", "/sensors/{id}",
                             "/sensors/{id}/frame", "/sensors/all/{what}"})
    router.get(pattern, nothing());
  router.action(Method::Post, "/registration", done());
  router.action(Method::Delete, "/registration", done());
  router.files("/viewer/", "/nowhere");
  router.files("/viewer/deep/", "/nowhere");
  return router;
}

std::string matched(std::string_view path) {
  const Router router = example();
  const auto match = router.match(path);
  return match ? match->entry->pattern : "none";
}

TEST(Router, LiteralsAndNames) {
  EXPECT_EQ(matched("/"), "/");
  EXPECT_EQ(matched("/frame"), "/frame");
  EXPECT_EQ(matched("/frames/7"), "/frames/{seq}");
  const Router router = example();
  EXPECT_EQ(router.match("/sensors/s1/frame")->params, (PathParams{{"id", "s1"}}));
}

TEST(Router, ALiteralWinsOverAName) {
  EXPECT_EQ(matched("/sensors/all/frame"), "/sensors/all/{what}");
  EXPECT_EQ(matched("/sensors/s1/frame"), "/sensors/{id}/frame");
}

TEST(Router, TheTrailingSlashIsSignificant) {
  EXPECT_EQ(matched("/sensors/"), "/sensors/");
  EXPECT_EQ(matched("/sensors"), "none");
  EXPECT_EQ(matched("/frame/"), "none");
  EXPECT_EQ(matched("/frames/"), "none");
}

TEST(Router, UnknownPathsAreNotFound) {
  for (const auto path : {"", "frame", "//", "/nope", "/frames/1/2", "/viewer", "/{seq}"})
    EXPECT_EQ(matched(path), "none") << path;
}

TEST(Router, TheLongestPrefixServesFiles) {
  const Router router = example();
  const std::string path = "/viewer/deep/a/b.js";
  const auto match = router.match(path);
  EXPECT_EQ(match->entry->pattern, "/viewer/deep/");
  EXPECT_EQ(match->rest, "a/b.js");
  EXPECT_EQ(matched("/viewer/"), "/viewer/");
}

TEST(Router, AllowNamesWhatThereIs) {
  const Router router = example();
  EXPECT_EQ(allowed_methods(*router.match("/registration")->entry), "OPTIONS, POST, DELETE");
  EXPECT_EQ(allowed_methods(*router.match("/frame")->entry), "GET, HEAD, OPTIONS");
}

TEST(Router, ALiveDocumentMayHaveAGetterForOneQueryKey) {
  Router router;
  router.live("/frame", std::make_shared<LiveDocument>());
  router.by_query("/frame", "at", nothing());
  const auto match = router.match("/frame");
  EXPECT_EQ(match->entry->query_key, "at");
  EXPECT_TRUE(match->entry->by_query);
  EXPECT_DEATH(router.by_query("/frame", "at", nothing()), "by_query");
  EXPECT_DEATH(router.by_query("/other", "at", nothing()), "live");
}

TEST(RouterDeathTest, FillingAPatternTwiceAsserts) {
  Router router = example();
  EXPECT_DEATH(router.get("/frame", nothing()), "readable");
  EXPECT_DEATH(router.action(Method::Post, "/registration", done()), "added");
}

}  // namespace
}  // namespace chorus::http
