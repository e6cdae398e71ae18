// The command channel without a network: where commands end, and the answer to each.
#include "fusion-server/dtrack/dtrack_commands.h"

#include <vector>

#include <gtest/gtest.h>

namespace chorus::dtrack {
namespace {

using namespace std::string_literals;

std::vector<std::string> commands_in(CommandReader& reader) {
  std::vector<std::string> all;
  for (std::string command; reader.next(command);) all.push_back(command);
  return all;
}

TEST(DtrackCommandReader, CutsAtNulHoweverTheBytesArrive) {
  const std::string stream = "dtrack2 getmsg\0\0dtrack2 tracking start\0dtra"s;
  const std::vector<std::string> expected{"dtrack2 getmsg", "", "dtrack2 tracking start"};
  for (std::size_t step = 1; step <= stream.size(); ++step) {
    CommandReader reader;
    std::vector<std::string> all;
    for (std::size_t at = 0; at < stream.size(); at += step) {
      ASSERT_TRUE(reader.feed(stream.substr(at, step)));
      for (const auto& command : commands_in(reader)) all.push_back(command);
    }
    EXPECT_EQ(all, expected) << step;
  }
}

TEST(DtrackCommandReader, TakesTwoHundredBytesAndNoMore) {
  CommandReader reader;
  ASSERT_TRUE(reader.feed(std::string(200, 'x') + '\0'));
  EXPECT_EQ(commands_in(reader), (std::vector<std::string>{std::string(200, 'x')}));
  EXPECT_TRUE(reader.feed(std::string(200, 'x')));
  EXPECT_FALSE(reader.feed("x"));
  CommandReader hidden;  // an overlong command follows a good one
  EXPECT_FALSE(hidden.feed("dtrack2 getmsg\0"s.append(201, 'x') + '\0'));
}

struct Said {
  const char* name;
  std::string command;
  bool in_control;
  std::string answer;
};

class DtrackCommand : public ::testing::TestWithParam<Said> {};

TEST_P(DtrackCommand, IsAnswered) {
  Conversation conversation{GetParam().in_control, 0, 0};
  Device device;
  const std::string got = answer(GetParam().command, conversation, device);
  EXPECT_EQ(got.substr(0, GetParam().answer.size()), GetParam().answer);
  EXPECT_EQ(got.find('\0'), got.size() - 1);
  EXPECT_LE(got.size(), 201u);
  EXPECT_EQ(conversation.refused, GetParam().answer.starts_with("dtrack2 err") ? 1u : 0u);
}

INSTANTIATE_TEST_SUITE_P(
    All, DtrackCommand,
    ::testing::Values(
        Said{"access", "dtrack2 get system access", true, "dtrack2 set system access full\0"s},
        Said{"no_access", "dtrack2 get system access", false, "dtrack2 set system access none\0"s},
        Said{"start", "dtrack2 tracking start", true, "dtrack2 ok\0"s},
        Said{"start_by_another", "dtrack2 tracking start", false, "dtrack2 err 2 "},
        Said{"stop", "dtrack2 tracking stop", true, "dtrack2 ok\0"s},
        Said{"status", "dtrack2 get status active", false, "dtrack2 set status active none\0"s},
        Said{"configuration", "dtrack2 get config active_config", false,
             "dtrack2 set config active_config standard\0"s},
        Said{"getmsg", "dtrack2 getmsg", true, "dtrack2 ok\0"s},
        Said{"output", "dtrack2 set output net ch01 udp 10.0.0.1 5000", true, "dtrack2 ok\0"s},
        Said{"set_by_another", "dtrack2 set output net ch01", false, "dtrack2 err 2 "},
        Said{"unknown", "dtrack2 shutdown", true, "dtrack2 err 1 "},
        Said{"longer", "dtrack2 tracking startle", true, "dtrack2 err 1 "},
        Said{"empty", "", true, "dtrack2 err 1 "},
        Said{"binary", "\xff\xfe\x01", true, "dtrack2 err 1 "}),
    [](const auto& each) { return each.param.name; });

TEST(DtrackCommands, StartAndStopAreSeenByAll) {
  Device device;
  Conversation first{true, 0, 0};
  Conversation second;
  (void)answer("dtrack2 tracking start", first, device);
  EXPECT_EQ(answer("dtrack2 get status active", second, device),
            "dtrack2 set status active mea\0"s);
  (void)answer("dtrack2 tracking stop", second, device);  // the second client is not in control
  EXPECT_TRUE(device.measuring);
  (void)answer("dtrack2 tracking stop", first, device);
  EXPECT_FALSE(device.measuring);
  EXPECT_EQ(first.answered, 2u);
}

}  // namespace
}  // namespace chorus::dtrack
