#include "common/service/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/version.h"

namespace chorus::service {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

About example() {
  return {"chorus-example",
          "An example.",
          "  chorus-example --id 7\n",
          {{"--id", "id", "Its id"},
           {"--recording", "device.replay.recording", "A file", true, "device.kind=\"replay\""}}};
}

CommandLine read(std::vector<const char*> words) {
  words.insert(words.begin(), "chorus-example");
  return read_command_line(example(), static_cast<int>(words.size()), words.data());
}

TEST(CommandLine, SaysNothingByItself) {
  const CommandLine none = read({});
  EXPECT_FALSE(none.exit);
  EXPECT_FALSE(none.check_only);
  EXPECT_EQ(none.source.path, "");
  EXPECT_THAT(none.source.assignments, IsEmpty());
}

TEST(CommandLine, OptionsStandForAssignmentsAndSetWins) {
  const CommandLine given =
      read({"--set", "log.level=warn", "--config", "a.json", "--log-level", "debug", "--port", "0",
            "--log-format", "json", "--set", "x=[1, 2]", "--check"});
  EXPECT_TRUE(given.check_only);
  EXPECT_EQ(given.source.path, "a.json");
  EXPECT_THAT(given.source.assignments,
              ElementsAre("http.port=0", "log.level=\"debug\"", "log.format=\"json\"",
                          "log.level=warn", "x=[1, 2]"));
}

TEST(CommandLine, AServicesOwnOptionsAreTextsAndMayImply) {
  const CommandLine given = read({"--recording", "a \"b\".mcap", "--id", "7"});
  EXPECT_THAT(given.source.assignments,
              ElementsAre("id=\"7\"", "device.kind=\"replay\"",
                          "device.replay.recording=\"a \\\"b\\\".mcap\""));
}

TEST(CommandLine, OptionsThatContradictEachOtherAreRefused) {
  About about = example();
  about.shortcuts.push_back({"--camera", "source", "A camera", true, "device.kind=\"camera\""});
  about.shortcuts.push_back({"--device", "device.kind", "Its kind"});
  const auto with = [&](std::vector<const char*> words) {
    words.insert(words.begin(), "chorus-example");
    return read_command_line(about, static_cast<int>(words.size()), words.data()).exit;
  };
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(with({"--device", "simulated", "--camera", "a.mp4"}), kExitMistaken);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("--camera sets device.kind to \"camera\", --device to \"simulated\""));
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(with({"--recording", "a.mcap", "--camera", "a.mp4"}), kExitMistaken);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("leave one of them out"));
  EXPECT_FALSE(with({"--device", "camera", "--camera", "a.mp4"})) << "they say the same";
}

TEST(CommandLine, HelpAndVersionEndWell) {
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(read({"--help"}).exit, kExitStopped);
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("chorus-example --id 7"));
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(read({"--version"}).exit, kExitStopped);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(),
            "chorus-example " + std::string(version()) + "\n");
}

TEST(CommandLine, MistakesAreExplained) {
  for (const std::vector<const char*>& words :
       {std::vector<const char*>{"--no-such"}, {"--config"}, {"stray"}}) {
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(read(words).exit, kExitMistaken) << words[0];
    EXPECT_NE(::testing::internal::GetCapturedStderr(), "");
  }
}

}  // namespace
}  // namespace chorus::service
