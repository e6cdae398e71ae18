#include "common/base/log.h"

#include <csignal>
#include <cstdlib>
#include <limits>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/support/logged.h"
#include "tests/support/matchers.h"

namespace chorus {
namespace {

using Json = nlohmann::json;
using ::testing::EndsWith;
using testing::FailsWith;
using ::testing::HasSubstr;
using testing::logged;

TEST(LogText, IsOneLinePerEventWithItsFields) {
  const std::string line = logged(log::Level::Info, log::Format::Text, [] {
    log::warn("sensor lost",
              {{"sensor", "s1"}, {"after_ms", 1500}, {"share", 0.25}, {"again", true}});
  });
  EXPECT_THAT(line,
              EndsWith("Z warn  sensor lost sensor=s1 after_ms=1500 share=0.25 again=true\n"));
}

TEST(LogText, AForeignValueCannotForgeALineOrAField) {
  const std::string line = logged(log::Level::Info, log::Format::Text, [] {
    log::info("request\nrefused",
              {{"path", "/x\n2026 error fake"}, {"agent", "a b=c"}, {"empty", ""}});
  });
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
  EXPECT_THAT(line, HasSubstr(R"(path="/x\n2026 error fake" agent="a b=c" empty="")"));
}

TEST(LogText, AVeryLongValueIsCut) {
  for (const log::Format format : {log::Format::Text, log::Format::Json}) {
    const std::string line = logged(log::Level::Info, format, [] {
      log::info("sensor refused", {{"reason", std::string(500'000, 'x')}});
    });
    EXPECT_LT(line.size(), 10'000U);
    EXPECT_THAT(line, HasSubstr("xxx..."));
  }
}

TEST(LogJson, IsOneObjectPerLineWithNumbersAsNumbers) {
  const std::string line = logged(log::Level::Debug, log::Format::Json, [] {
    log::debug("tick", {{"count", 3},
                        {"text", "3"},
                        {"nan", std::numeric_limits<double>::quiet_NaN()},
                        {"ok", false}});
  });
  const Json object = Json::parse(line);
  EXPECT_EQ(object.at("level"), "debug");
  EXPECT_EQ(object.at("event"), "tick");
  EXPECT_EQ(object.at("count"), 3);
  EXPECT_EQ(object.at("text"), "3");
  EXPECT_EQ(object.at("nan"), "nan");
  EXPECT_EQ(object.at("ok"), false);
  EXPECT_THAT(object.at("time").get<std::string>(), EndsWith("Z"));
}

TEST(LogJson, BytesThatAreNoTextStillGiveALine) {
  const std::string line = logged(log::Level::Info, log::Format::Json, [] {
    log::error("bad", {{"bytes", std::string("\xff\xfe\0 \"x", 6)}});
  });
  EXPECT_FALSE(Json::parse(line).at("bytes").get<std::string>().empty());
}

TEST(LogLevel, DropsWhatIsBelow) {
  const std::string lines = logged(log::Level::Warn, log::Format::Text, [] {
    log::debug("a");
    log::info("b");
    log::warn("c");
    log::error("d");
  });
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 2);
}

void log_much() {
  log::configure(log::Level::Info, log::Format::Text);
  for (int i = 0; i < 2000; ++i) log::info("line", {{"n", i}});
}

TEST(LogDeathTest, WhatWaitsIsWrittenAtTheEndHoweverThatComes) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";  // re-executes the binary: a fresh log
  EXPECT_EXIT(log_much(); std::exit(0), ::testing::ExitedWithCode(0), "n=1999");
  EXPECT_EXIT(log_much(); std::abort(), ::testing::KilledBySignal(SIGABRT), "n=1999");
}

TEST(LogOptions, ReadTheNamesTheConfigUses) {
  EXPECT_EQ(log::parse_level("warn"), log::Level::Warn);
  EXPECT_EQ(log::parse_format("json"), log::Format::Json);
  EXPECT_THAT(log::parse_level("WARN"), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(log::parse_format(""), FailsWith(ErrorCode::InvalidArgument));
}

}  // namespace
}  // namespace chorus
