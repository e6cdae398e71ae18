// A running service says what is in force, what waits, and why a reload changed nothing.
#include "common/service/configuration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.h"

namespace chorus::service {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr Timestamp kServiceStart = Timestamp(std::chrono::seconds(1'700'000'000));

class Configured : public ::testing::Test {
 protected:
  void write(const std::string& text, int age_s) {
    file_ = folder_.write("fusion.json", text);
    std::filesystem::last_write_time(
        file_, std::filesystem::file_time_type::clock::now() - std::chrono::seconds(age_s));
  }
  void start(const std::string& text) {
    write(text, 100);
    configuration_.started({file_.string(), {}}, text, kServiceStart);
  }
  chorus::testing::TemporaryFolder folder_;
  std::filesystem::path file_;
  Configuration configuration_;
};

TEST_F(Configured, NothingIsAmissAtFirst) {
  start(R"({"title": "a", "http": {"port": 8080}})");
  const auto facts = configuration_.facts();
  EXPECT_EQ(facts.file, "fusion.json");
  EXPECT_EQ(json::parse(facts.in_force)["http"]["port"], 8080);
  EXPECT_THAT(facts.waiting, IsEmpty());
  EXPECT_THAT(facts.changed_on_disk, IsEmpty());
  EXPECT_EQ(configuration_.trouble(), "");
}

TEST_F(Configured, AChangeOnDiskIsSeenBeforeTheReload) {
  start(R"({"title": "a", "http": {"port": 8080}})");
  write(R"({"title": "b", "http": {"port": 8080}})", 50);
  EXPECT_THAT(configuration_.facts().changed_on_disk, ElementsAre("title"));
  EXPECT_EQ(configuration_.trouble(), "") << "nobody has asked for it yet";
  write("{ no json", 40);
  EXPECT_NE(configuration_.facts().disk_error, "");
  std::filesystem::remove(file_);
  EXPECT_THAT(configuration_.facts().disk_error, HasSubstr("there is no such file"));
}

TEST_F(Configured, AFailedReloadIsToldUntilOneIsTaken) {
  start(R"({"title": "a"})");
  configuration_.reload_failed({ErrorCode::Malformed, file_.string(), "line 3: unknown key"},
                               kServiceStart + std::chrono::seconds(5));
  EXPECT_THAT(configuration_.trouble(), HasSubstr("the old one stays"));
  EXPECT_THAT(configuration_.trouble(), HasSubstr("line 3: unknown key"));
  EXPECT_THAT(configuration_.trouble(), Not(HasSubstr(folder_.path().string())))
      << "no path of the host";
  const json told = json::parse(configuration_json(configuration_.facts()));
  EXPECT_EQ(told["lastReload"], "2023-11-14T22:13:25.000000000Z");
  EXPECT_THAT(told["lastReloadError"], HasSubstr("unknown key"));
  configuration_.reloaded(R"({"title": "b"})", {}, kServiceStart + std::chrono::seconds(9));
  EXPECT_EQ(configuration_.trouble(), "");
  EXPECT_FALSE(json::parse(configuration_json(configuration_.facts())).contains("lastReloadError"));
}

TEST_F(Configured, WhatWaitsForARestartIsNotInForce) {
  start(R"({"title": "a", "http": {"port": 8080}})");
  write(R"({"title": "b", "http": {"port": 9090}})", 50);
  configuration_.reloaded(R"({"title": "b", "http": {"port": 9090}})", {"http.port"},
                          kServiceStart);
  const auto facts = configuration_.facts();
  EXPECT_EQ(json::parse(facts.in_force)["title"], "b");
  EXPECT_EQ(json::parse(facts.in_force)["http"]["port"], 8080);
  EXPECT_THAT(facts.waiting, ElementsAre("http.port"));
  EXPECT_THAT(facts.changed_on_disk, IsEmpty());
  EXPECT_THAT(configuration_.trouble(), HasSubstr("wait for a restart: http.port"));
}

TEST(WithoutSecrets, KeepsTokensPasswordsAndPathsToItself) {
  const json shown = json::parse(without_secrets(
      R"({"http": {"bearer_token": "abc", "tokens": [{"token": "def", "role": "read"}]},
          "sensors": [{"id": "s1", "url": "http://me:pw@10.0.0.1:8081/", "token": "ghi"}],
          "recording": {"folder": "/var/lib/chorus"}, "viewer_dir": "auto", "empty": ""})"));
  const std::string text = shown.dump();
  for (const char* secret : {"abc", "def", "ghi", "pw", "/var/lib"})
    EXPECT_THAT(text, Not(HasSubstr(secret)));
  EXPECT_EQ(shown["sensors"][0]["url"], "http://10.0.0.1:8081/");
  EXPECT_EQ(shown["http"]["tokens"][0]["role"], "read");
  EXPECT_EQ(shown["viewer_dir"], "auto");
  EXPECT_EQ(without_secrets("no json"), "{}");
}

}  // namespace
}  // namespace chorus::service
