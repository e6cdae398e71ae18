#include "common/base/rate_report.h"

#include <chrono>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/logged.h"

namespace chorus {
namespace {

using testing::logged;

struct Lines {
  std::size_t count = 0;
  std::uint64_t events = 0;  ///< Sum of the counts in the lines.
};

Lines read_lines(const std::string& text) {
  Lines lines;
  const std::regex pattern("count=([0-9]+)");
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) {
    ++lines.count;
    lines.events += std::stoull((*it)[1].str());
  }
  return lines;
}

TEST(RateReport, SaysTheFirstAtOnce) {
  RateReport dropped("frame dropped");
  const std::string text = logged([&] { dropped.hit("queue full"); });
  EXPECT_NE(text.find("frame dropped count=1 total=1 detail=\"queue full\""), std::string::npos)
      << text;
}

TEST(RateReport, ManyHitsGiveFewLinesAndEveryHitIsCountedOnce) {
  constexpr int kHits = 10'000;
  const auto start = std::chrono::steady_clock::now();
  const std::string text = logged([] {
    RateReport dropped("frame dropped");
    for (int i = 0; i < kHits; ++i) dropped.hit();
  });
  const auto whole_seconds =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - start);
  const Lines lines = read_lines(text);
  EXPECT_EQ(lines.events, static_cast<std::uint64_t>(kHits));
  // At most one line for the first event, one per second, and one for the rest at the end.
  EXPECT_LE(lines.count, 2u + static_cast<std::size_t>(whole_seconds.count()));
}

TEST(RateReport, WhatIsLeftAtTheEndIsSaidWithTheLastReason) {
  const std::string text = logged([] {
    RateReport dropped("frame dropped");
    for (const char* reason : {"queue full", "too old", "malformed"}) dropped.hit(reason);
  });
  EXPECT_NE(text.find("frame dropped count=2 total=3 detail=malformed"), std::string::npos) << text;
}

TEST(RateReport, CountsFromManyThreads) {
  constexpr int kThreads = 4;
  constexpr int kHits = 2'000;
  const std::string text = logged([] {
    RateReport dropped("frame dropped");
    std::vector<std::jthread> threads;
    for (int i = 0; i < kThreads; ++i) {
      threads.emplace_back([&dropped] {
        for (int hit = 0; hit < kHits; ++hit) dropped.hit("x");
      });
    }
    threads.clear();
  });
  EXPECT_EQ(read_lines(text).events, static_cast<std::uint64_t>(kThreads * kHits));
}

TEST(RateReport, SaysNothingWhenNothingHappened) {
  EXPECT_EQ(logged([] { RateReport dropped("frame dropped"); }), "");
}

}  // namespace
}  // namespace chorus
