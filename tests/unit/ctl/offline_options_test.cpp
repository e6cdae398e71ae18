// The options of offline fusion: the fusion server's own configuration, key by key.
#include "services/ctl/line/offline_options.h"

#include <CLI/CLI.hpp>

#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using ::testing::HasSubstr;

/// The configuration that a command line of these words gives.
Result<pipeline::OfflineConfig> config_of(std::vector<std::string> words) {
  OfflineOptions options;
  CLI::App app;
  add_offline_options(app, options);
  std::reverse(words.begin(), words.end());  // CLI11 takes words from the end
  app.parse(words);
  return offline_config(options);
}

TEST(OfflineOptions, AreTheServersDefaultsWhenNothingIsSaid) {
  const auto config = config_of({});
  ASSERT_THAT(config, IsOk());
  EXPECT_EQ(config->rate_hz, 30.0);
  EXPECT_EQ(config->registration.joints, registration::JointChoice::Core);
  EXPECT_TRUE(config->registration.use_floor);
}

TEST(OfflineOptions, EveryKeyCanBeSetAndTheLastOneStands) {
  const auto config = config_of({"--set", "output.rate_hz=15", "--set", "output.rate_hz=20",
                                 "--set", "registration.use_floor=false"});
  ASSERT_THAT(config, IsOk());
  EXPECT_EQ(config->rate_hz, 20.0);
  EXPECT_FALSE(config->registration.use_floor);
}

TEST(OfflineOptions, JointsHaveAShortForm) {
  EXPECT_EQ(config_of({"--joints", "neck"})->registration.joints, registration::JointChoice::Neck);
  EXPECT_EQ(config_of({"--joints", "all"})->registration.joints, registration::JointChoice::All);
  EXPECT_THROW((void)config_of({"--joints", "toes"}), CLI::ValidationError);
  EXPECT_THROW((void)config_of({"--method", "magic"}), CLI::ValidationError);
}

TEST(OfflineOptions, AFileIsReadAndOverriddenByWords) {
  const chorus::testing::TemporaryFolder folder;
  const auto file = folder.write("f.json", "{ // ours\n \"output\": {\"rate_hz\": 50} }").string();
  EXPECT_EQ(config_of({"--config", file})->rate_hz, 50.0);
  EXPECT_EQ(config_of({"--config", file, "--set", "output.rate_hz=25"})->rate_hz, 25.0);
}

TEST(OfflineOptions, WhatIsWrongIsNamed) {
  const auto unknown = config_of({"--set", "output.rate_hertz=15"});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(to_string(unknown.error()), HasSubstr("rate_hz"));
  EXPECT_FALSE(config_of({"--set", "output.rate_hz=fast"}));
  EXPECT_FALSE(config_of({"--set", "nonsense"}));
  EXPECT_FALSE(config_of({"--config", "/nowhere/f.json"}));
  const chorus::testing::TemporaryFolder folder;
  EXPECT_FALSE(config_of({"--config", folder.write("f.json", "{\"output\": ").string()}));
}

}  // namespace
}  // namespace chorus::ctl
