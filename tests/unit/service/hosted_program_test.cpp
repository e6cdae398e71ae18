#include "common/service/hosted_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/logged.h"

namespace chorus::service {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

struct Settings {
  struct Live {
    LogConfig log;
    int volume = 1;
    bool operator==(const Live&) const = default;
  } live;
  struct Start {
    int port = 1;
    int rooms = 1;
    bool operator==(const Start&) const = default;
  } at_start;
};

Result<Settings> read_settings(ConfigReader root) {
  Settings out;
  root.read("volume", out.live.volume, 0, 9);
  root.read("port", out.at_start.port, 0, 9);
  root.read("rooms", out.at_start.rooms, 0, 9);
  if (auto ok = root.finish(); !ok) return pass(ok);
  return out;
}

/// A host that remembers its latest configuration.
struct Host {
  static inline Settings made;
  static inline int volume = 0;

  static Result<std::unique_ptr<Host>> make(const Settings& settings) {
    if (settings.at_start.rooms == 0) return fail(ErrorCode::InvalidArgument, "rooms", "needs one");
    made = settings;
    return std::make_unique<Host>();
  }
  Result<void> start() { return {}; }
  void take(const Settings::Live& live) { volume = live.volume; }
  void stop() {}
};

ConfigReader config(const std::string& text) { return ConfigReader::parse(text, "test").value(); }

/// What a reload with the configuration `text` logs.
std::string reloaded(HostedProgram<Settings, Host>& program, const std::string& text) {
  return chorus::testing::logged([&] { EXPECT_TRUE(program.reload(config(text))); });
}

TEST(HostedProgram, TakesTheLivePartAndNamesTheOther) {
  HostedProgram<Settings, Host> program(&read_settings);
  ASSERT_TRUE(program.prepare(config(R"({"port": 2})")));
  EXPECT_EQ(Host::made.at_start.port, 2);
  EXPECT_EQ(reloaded(program, R"({"port": 2, "volume": 5})"), "");
  EXPECT_EQ(Host::volume, 5);
  const std::string log = reloaded(program, R"({"port": 3, "volume": 6})");
  EXPECT_THAT(log, HasSubstr("changes wait for a restart"));
  EXPECT_THAT(log, HasSubstr("port"));
  EXPECT_THAT(log, Not(HasSubstr("volume")));
  EXPECT_EQ(Host::volume, 6);
  EXPECT_THAT(reloaded(program, R"({"port": 3, "volume": 6})"), HasSubstr("port"))
      << "it still waits";
  EXPECT_EQ(program.configuration()->facts().waiting, std::vector<std::string>{"port"});
  EXPECT_EQ(reloaded(program, R"({"port": 2})"), "") << "as it was started";
  EXPECT_TRUE(program.configuration()->facts().waiting.empty());
}

TEST(HostedProgram, AWrongConfigurationChangesNothing) {
  HostedProgram<Settings, Host> program(&read_settings);
  ASSERT_TRUE(program.prepare(config("{}")));
  Host::volume = 1;
  EXPECT_FALSE(program.reload(config(R"({"volume": 3, "port": 99})")));
  EXPECT_EQ(Host::volume, 1);
}

TEST(HostedProgram, WhatCannotBeMadeIsRefusedBeforeTheStart) {
  HostedProgram<Settings, Host> program(&read_settings);
  const auto refused = program.prepare(config(R"({"rooms": 0})"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(to_string(refused.error()), HasSubstr("rooms"));
}

}  // namespace
}  // namespace chorus::service
