#include "common/http/live_document.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

TEST(LiveDocument, IsNullUntilTheFirstPublish) {
  LiveDocument live;
  EXPECT_EQ(live.current(), nullptr);
  const auto first = make_document("text/plain", "1", {});
  live.publish(first);
  EXPECT_EQ(live.current(), first);
}

TEST(LiveDocument, MakesADocumentOnceWhenItIsAskedFor) {
  LiveDocument live;
  int made = 0;
  live.publish_lazily([&] { return ++made, make_document("text/plain", "1", {}); });
  EXPECT_EQ(made, 0);
  const auto first = live.current();
  EXPECT_NE(first, nullptr);
  EXPECT_EQ(live.current(), first);
  EXPECT_EQ(made, 1);
}

TEST(LiveDocument, TheLastPublishedCounts) {
  LiveDocument live;
  const auto ready = make_document("text/plain", "ready", {});
  const auto lazy = make_document("text/plain", "lazy", {});
  live.publish_lazily([&] { return lazy; });
  live.publish(ready);
  EXPECT_EQ(live.current(), ready);
  live.publish_lazily([&] { return lazy; });
  EXPECT_EQ(live.current(), lazy);
}

TEST(LiveDocument, TellsEverySubscriberAfterTheChange) {
  LiveDocument live;
  std::vector<DocumentPtr> seen;
  for (int i = 0; i < 2; ++i) live.subscribe([&] { seen.push_back(live.current()); });
  const auto next = make_document("text/plain", "2", {});
  live.publish(next);
  EXPECT_EQ(seen, (std::vector<DocumentPtr>{next, next}));
}

TEST(LiveDocument, SubscribersMayPublishAgain) {
  LiveDocument live;
  const auto last = make_document("text/plain", "last", {});
  live.subscribe([&] {
    if (live.current() != last) live.publish(last);
  });
  live.publish(make_document("text/plain", "first", {}));
  EXPECT_EQ(live.current(), last);
}

}  // namespace
}  // namespace chorus::http
