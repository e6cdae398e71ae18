// Events read from bytes, however the network splits them.
#include "common/http/event_reader.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

constexpr std::size_t kMax = 1000;

std::vector<ServerEvent> read(std::string_view text, std::size_t piece) {
  EventReader reader(kMax);
  std::vector<ServerEvent> all;
  for (std::size_t i = 0; i < text.size(); i += piece) {
    auto some = reader.take(text.substr(i, piece));
    if (!some) {
      ADD_FAILURE() << to_string(some.error());
      break;
    }
    all.insert(all.end(), some->begin(), some->end());
  }
  return all;
}

TEST(EventReader, ReadsTheSameEventsHoweverTheBytesAreCut) {
  const std::string text =
      "\xEF\xBB\xBFretry: 1000\n\n: hello\nid: 1\ndata: {\"n\":1}\n\n"
      "id:2\r\ndata: <a>\r\ndata:   <b> .\r\ndata:\r\n\r\n"
      "event: x\rdata\rdata:last\r\r"
      "id: 9\n\ndata: unfinished";
  const std::vector<ServerEvent> expected{
      {"1", "{\"n\":1}"}, {"2", "<a>\n  <b> .\n"}, {"2", "\nlast"}};
  for (std::size_t piece = 1; piece <= text.size(); ++piece)
    EXPECT_EQ(read(text, piece), expected) << piece;
}

TEST(EventReader, AnEventWithoutDataIsNoneButItsIdHolds) {
  EXPECT_EQ(read("id: 7\n\n:\n\ndata: x\n\n", 3), (std::vector<ServerEvent>{{"7", "x"}}));
}

TEST(EventReader, AByteOrderMarkIsTextEverywhereButAtTheBeginning) {
  EXPECT_EQ(read("data: a\n\n\xEF\xBB\xBF"
                 "data: b\n\ndata: c\n\n",
                 4),
            (std::vector<ServerEvent>{{"", "a"}, {"", "c"}}));
}

TEST(EventReader, WhatGrowsBeyondTheBoundIsRefused) {
  EventReader endless_line(kMax);
  EXPECT_TRUE(endless_line.take("data: " + std::string(kMax - 10, 'x')));
  const auto refused = endless_line.take(std::string(20, 'x'));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::TooLarge);
  EventReader many_lines(kMax);
  bool held = true;
  for (std::size_t i = 0; i < kMax && held; ++i) held = many_lines.take("data: x\n").has_value();
  EXPECT_FALSE(held);
  EventReader no_events(kMax);
  held = true;
  for (std::size_t i = 0; i < kMax && held; ++i) held = no_events.take(":\n\n").has_value();
  EXPECT_FALSE(held);
}

TEST(EventReader, ManySmallEventsAreNoLargeOne) {
  EventReader reader(kMax);
  for (std::size_t i = 0; i < kMax; ++i) {
    const auto some = reader.take("data: " + std::to_string(i) + "\n\n");
    ASSERT_TRUE(some);
    ASSERT_EQ(some->size(), 1u);
  }
}

}  // namespace
}  // namespace chorus::http
