#include "common/base/rate_report.h"

#include <chrono>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace chorus {
namespace {

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
  ::testing::internal::CaptureStderr();
  dropped.hit("queue full");
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("frame dropped count=1 total=1 detail=\"queue full\""), std::string::npos)
      << text;
}

TEST(RateReport, ManyHitsGiveFewLinesAndEveryHitIsCountedOnce) {
  constexpr int kHits = 10'000;
  ::testing::internal::CaptureStderr();
  const auto start = std::chrono::steady_clock::now();
  {
    RateReport dropped("frame dropped");
    for (int i = 0; i < kHits; ++i) dropped.hit();
  }
  const auto whole_seconds =
      std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - start);
  const Lines lines = read_lines(::testing::internal::GetCapturedStderr());
  EXPECT_EQ(lines.events, static_cast<std::uint64_t>(kHits));
  // At most one line for the first event, one per second, and one for the rest at the end.
  EXPECT_LE(lines.count, 2u + static_cast<std::size_t>(whole_seconds.count()));
}

TEST(RateReport, WhatIsLeftAtTheEndIsSaidWithTheLastReason) {
  ::testing::internal::CaptureStderr();
  {
    RateReport dropped("frame dropped");
    for (const char* reason : {"queue full", "too old", "malformed"}) dropped.hit(reason);
  }
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(text.find("frame dropped count=2 total=3 detail=malformed"), std::string::npos) << text;
}

TEST(RateReport, CountsFromManyThreads) {
  constexpr int kThreads = 4;
  constexpr int kHits = 2'000;
  ::testing::internal::CaptureStderr();
  {
    RateReport dropped("frame dropped");
    std::vector<std::jthread> threads;
    for (int i = 0; i < kThreads; ++i) {
      threads.emplace_back([&dropped] {
        for (int hit = 0; hit < kHits; ++hit) dropped.hit("x");
      });
    }
    threads.clear();
  }
  EXPECT_EQ(read_lines(::testing::internal::GetCapturedStderr()).events,
            static_cast<std::uint64_t>(kThreads * kHits));
}

TEST(RateReport, SaysNothingWhenNothingHappened) {
  ::testing::internal::CaptureStderr();
  { RateReport dropped("frame dropped"); }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace chorus
