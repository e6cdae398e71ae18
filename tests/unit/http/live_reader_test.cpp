#include "common/http/live_reader.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace chorus::http {
namespace {

DocumentPtr version(int number) {
  std::vector<Variant> variants;
  variants.push_back({"application/json", [number] { return std::to_string(number); }});
  variants.push_back(
      {"application/json", [number] { return "p" + std::to_string(number); }, "pose"});
  return std::make_shared<const Document>(std::move(variants),
                                          DocumentOptions{std::to_string(number)});
}

class LiveReaderTest : public ::testing::Test {
 protected:
  LiveReaderTest() { entry_.live = std::make_shared<LiveDocument>(); }

  static LiveWish wish(std::string_view query, std::string_view last = {}) {
    RequestHead head;
    head.query = query;
    head.last_event_id = last;
    auto read = live_wish_of(head);
    EXPECT_TRUE(read);
    return read.value_or(LiveWish{});
  }
  static std::string text(const std::shared_ptr<const std::string_view>& message) {
    return message ? std::string(*message) : "-";
  }

  Router::Entry entry_;
  SteadyTime now_{std::chrono::hours(1)};
};

TEST_F(LiveReaderTest, AtMostTheAskedRateAndAlwaysTheNewest) {
  LiveReader reader(entry_, wish("max_rate=10"));
  std::string got;
  // A hundred versions a second for a second, each a little late.
  for (int i = 0; i < 100; ++i) {
    entry_.live->publish(version(i));
    got += text(reader.message(now_ + std::chrono::milliseconds(10 * i + i % 3))) + " ";
  }
  EXPECT_EQ(std::ranges::count(got, '-'), 90) << got;
  ASSERT_TRUE(reader.held_until());
  EXPECT_EQ(text(reader.message(*reader.held_until())), "99") << "the last one is not lost";
  EXPECT_EQ(text(reader.message(now_ + std::chrono::hours(1))), "-") << "and comes once";
}

TEST_F(LiveReaderTest, WithoutARateEachVersionAndWithAFormThatForm) {
  LiveReader reader(entry_, wish("form=pose"));
  for (int i = 0; i < 3; ++i) {
    entry_.live->publish(version(i));
    EXPECT_EQ(text(reader.message(now_)), "p" + std::to_string(i));
    EXPECT_FALSE(reader.held_until());
  }
  LiveReader events(entry_, wish("profile=pose"));
  EXPECT_EQ(*events.event("application/json", Coding::Identity, now_), "id: 2\ndata: p2\n\n");
}

TEST_F(LiveReaderTest, WhoReconnectsWithTheNewestVersionWaits) {
  entry_.live->publish(version(4));
  LiveReader reader(entry_, wish("", "4"));
  EXPECT_EQ(text(reader.message(now_)), "-");
  entry_.live->publish(version(5));
  EXPECT_EQ(text(reader.message(now_)), "5");
}

class Numbers : public LoggedEvents {
 public:
  std::optional<One> after(std::uint64_t id) const override {
    if (id >= 3) return std::nullopt;
    return One{id + 1, "n" + std::to_string(id + 1)};
  }
};

TEST_F(LiveReaderTest, OfLoggedEventsEachOneOnceInOrder) {
  entry_.log = std::make_shared<Numbers>();
  LiveReader reader(entry_, wish("max_rate=1&after=1", "0"));
  EXPECT_TRUE(reader.has_more());
  EXPECT_EQ(*reader.event("application/json", Coding::Identity, now_), "id: 1\ndata: n1\n\n")
      << "Last-Event-ID counts before the address";
  EXPECT_EQ(text(reader.message(now_)), "n2");
  EXPECT_EQ(text(reader.message(now_)), "n3");
  EXPECT_FALSE(reader.has_more());
  EXPECT_EQ(reader.event("application/json", Coding::Identity, now_), nullptr);
}

TEST_F(LiveReaderTest, OtherRatesAreRefused) {
  for (const std::string_view query : {"max_rate=0", "max_rate=-1", "max_rate=nan", "max_rate=x",
                                       "max_rate=", "max_rate=1e9", "max_rate=inf"}) {
    RequestHead head;
    head.query = query;
    EXPECT_FALSE(live_wish_of(head)) << query;
  }
}

}  // namespace
}  // namespace chorus::http
