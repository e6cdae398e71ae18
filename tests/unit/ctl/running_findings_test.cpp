// What chorus doctor learns from the programs themselves.
#include "services/ctl/operate/running_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/asked_program.h"
#include "common/http/server.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Texts = std::map<std::string, std::string>;  // By path.

/// A fusion server that gives these answers.
class Running {
 public:
  explicit Running(const Texts& texts) {
    auto router = std::make_shared<http::Router>();
    for (const auto& [path, text] : texts) {
      router->get(path, [text](const http::Request&, const http::PathParams&) {
        return Result<http::DocumentPtr>(http::make_document("application/json", text, {"1"}));
      });
    }
    server_ = std::make_unique<http::Server>(http::ServerConfig{}, router);
    EXPECT_TRUE(server_->start());
  }
  [[nodiscard]] ExaminedService itself() const {
    return {"fusion", "fusion.json", {{"http", {{"port", server_->port()}}}}};
  }

 private:
  std::unique_ptr<http::Server> server_;
};

auto words(const std::string& part) { return Field(&Finding::words, HasSubstr(part)); }

TEST(RunningConfiguration, AFailedReloadIsSaidWithWhy) {
  const Running server(Texts{{"/configuration", R"({"lastReloadError": "line 3: unknown key"})"}});
  const Findings all = configuration_findings(server.itself());
  ASSERT_EQ(all.size(), 1u);
  EXPECT_FALSE(all[0].good);
  EXPECT_THAT(all[0], words("the last reload changed nothing: line 3: unknown key"));
}

TEST(RunningConfiguration, WhatWaitsAndWhatDiffersAreTwoThings) {
  const Running server(Texts{
      {"/configuration", R"({"pendingRestart": ["http.port"], "changedOnDisk": ["title"]})"}});
  EXPECT_THAT(configuration_findings(server.itself()),
              ElementsAre(words("waits for a restart with http.port"), words("title differs")));
  const Running well(Texts{{"/configuration", R"({"pendingRestart": [], "changedOnDisk": []})"}});
  ASSERT_EQ(configuration_findings(well.itself()).size(), 1u);
  EXPECT_TRUE(configuration_findings(well.itself())[0].good);
  EXPECT_THAT(configuration_findings(Running(Texts{}).itself()), IsEmpty()) << "an older server";
}

TEST(FollowedSensors, OneThatTheServerRefusesIsSaidWithItsError) {
  const Running server(Texts{{"/sensors/", R"({"sensors": {"s1": {"state": "live"},
      "s2": {"state": "refused", "lastError": "GET frame answers 401"}}})"}});
  const Findings all = followed_findings(server.itself());
  ASSERT_EQ(all.size(), 1u);
  EXPECT_FALSE(all[0].good);
  EXPECT_THAT(all[0].subject, HasSubstr("s2"));
  EXPECT_THAT(all[0], words("refused: GET frame answers 401"));
  ExaminedService sensor = server.itself();
  sensor.kind = "sensor";
  EXPECT_THAT(followed_findings(sensor), IsEmpty());
}

TEST(AskedProgram, SaysWhatItSaidAndHowItEnded) {
  const auto said = ask_program({"sh", "-c", "echo out; echo err >&2; exit 3"});
  ASSERT_TRUE(said);
  EXPECT_EQ(said->code, 3);
  EXPECT_THAT(said->said, HasSubstr("out\n"));
  EXPECT_THAT(said->said, HasSubstr("err\n"));
  EXPECT_EQ(ask_program({"no-such-program-anywhere"})->code, 127);
  EXPECT_FALSE(ask_program({}));
}

TEST(AskedProgram, IsEndedWhenItTakesTooLongOrSaysTooMuch) {
  const auto slow = ask_program({"sleep", "60"}, {std::chrono::milliseconds(50)});
  ASSERT_TRUE(slow);
  EXPECT_TRUE(slow->cut_short);
  const auto loud = ask_program({"yes"}, {std::chrono::seconds(20), 1000});
  ASSERT_TRUE(loud);
  EXPECT_TRUE(loud->cut_short);
  EXPECT_EQ(loud->said.size(), 1000u);
}

}  // namespace
}  // namespace chorus::ctl
