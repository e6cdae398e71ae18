// `chorus doctor`: its lines, its JSON and its exit code; certificates, addresses, tokens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/base/version.h"
#include "common/http/server.h"
#include "services/ctl/setup/findings.h"
#include "tests/support/workshop_authority.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using chorus::testing::TemporaryFolder;
using chorus::testing::WorkshopAuthority;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

/// What a service says at the moment when it is asked.
using Text = std::function<std::string()>;

Text said(const std::string& text) {
  return [text] { return text; };
}

/// A service with the given answers by path; what is not named answers 404.
class Answers {
 public:
  explicit Answers(const std::map<std::string, Text>& texts) {
    auto router = std::make_shared<http::Router>();
    for (const auto& [path, text] : texts) {
      router->get(path, [text](const http::Request&, const http::PathParams&) {
        return Result<http::DocumentPtr>(http::make_document("application/json", text(), {"1"}));
      });
    }
    server_ = std::make_unique<http::Server>(http::ServerConfig{}, router);
    EXPECT_TRUE(server_->start());
  }
  [[nodiscard]] std::uint16_t port() const { return server_->port(); }
  [[nodiscard]] std::string url(const std::string& below = "") const {
    return "http://127.0.0.1:" + std::to_string(port()) + "/" + below;
  }
  [[nodiscard]] ExaminedService itself() const {
    return {"sensor", "s", {{"http", {{"port", port()}}}}};
  }

 private:
  std::unique_ptr<http::Server> server_;
};

Text clock_of(Duration ahead, const Json& more = Json::object()) {
  return [ahead, more] {
    Json clock = more;
    clock["nowNanoseconds"] = std::to_string(to_unix_ns(SystemClock().now() + ahead));
    return clock.dump();
  };
}

Finding finding_of(const std::string& url) {
  const Findings all =
      sensor_findings({"fusion", "f", {{"sensors", {{{"id", "s1"}, {"url", url}}}}}});
  EXPECT_EQ(all.size(), 1u);
  return all.at(0);
}

std::vector<std::string> certified(const std::string& file) {
  const Findings all =
      certificate_findings({"sensor", "s", {{"http", {{"tls", {{"certificate", file}}}}}}});
  EXPECT_EQ(all.size(), 1u);
  return {all.at(0).good ? "good" : "wrong", all.at(0).words, all.at(0).advice};
}

TEST(DoctorCommand, SaysThatThereIsNoConfigurationAndHowToGetOne) {
  const TemporaryFolder folder;
  const Outcome told = run_chorus({"doctor", "--folder", folder.path().string()});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.out,
              HasSubstr("WRONG  configuration: there is none in " + folder.path().string()));
  EXPECT_THAT(told.out,
              HasSubstr("       -> chorus init sensor or chorus init fusion writes one\n"));
}

TEST(DoctorCommand, ChecksEveryServiceOfTheFolder) {
  const TemporaryFolder folder;
  const Answers sensor({{"/healthz", said("{}")}, {"/clock", clock_of(Duration{0})}});
  const Json config{{"http", {{"port", sensor.port()}}},
                    {"recording", {{"folder", folder.path().string()}}}};
  (void)folder.write("sensor.json", config.dump());
  (void)folder.write("fusion.json", "{ \"http\": { ");
  const Outcome told = run_chorus({"doctor", "--folder", folder.path().string()});
  EXPECT_EQ(told.code, kExitFailed) << "one is damaged";
  EXPECT_THAT(told.out, HasSubstr("ok     chorus-sensor: answers at " + sensor.url()));
  EXPECT_THAT(told.out, HasSubstr("ok     token of chorus-sensor: none is needed on this host\n"));
  EXPECT_THAT(told.out, HasSubstr("recordings " + folder.path().string() + ": "));
  EXPECT_THAT(told.out, HasSubstr("WRONG  " + (folder / "fusion.json").string()));
  EXPECT_THAT(told.out, HasSubstr("read it as root (sudo chorus doctor)"));
  EXPECT_THAT(told.out, Not(HasSubstr("there is none")));
}

TEST(DoctorCommand, TellsTheSameAsJson) {
  const TemporaryFolder folder;
  const Answers sensor({{"/healthz", said("{}")}, {"/clock", clock_of(Duration{0})}});
  (void)folder.write("sensor.json", Json{{"http", {{"port", sensor.port()}}}}.dump());
  const Outcome told = run_chorus({"doctor", "--folder", folder.path().string(), "--json"});
  const Json json = Json::parse(told.out);
  EXPECT_EQ(json.at("version"), std::string(version()));
  std::vector<std::string> subjects;
  bool all_good = true;
  for (const Json& finding : json.at("findings")) {
    subjects.push_back(finding.at("subject"));
    all_good = all_good && finding.at("good").get<bool>();
    EXPECT_EQ(finding.at("good").get<bool>(), finding.at("advice") == "") << finding;
  }
  EXPECT_THAT(subjects, ElementsAre("clock", "chorus-sensor", "token of chorus-sensor"));
  EXPECT_EQ(told.code, all_good ? kExitOk : kExitFailed) << "this host's own clock decides";
}

TEST(DoctorClock, SaysByHowMuchAndInWhichDirection) {
  const Answers early({{"/clock", clock_of(std::chrono::seconds(10))}});
  EXPECT_THAT(finding_of(early.url()).words,
              MatchesRegex("its clock is (99..|100..) ms ahead of ours"));
  const Answers late({{"/clock", clock_of(-std::chrono::seconds(10))}});
  EXPECT_THAT(finding_of(late.url()).words,
              MatchesRegex("its clock is (99..|100..) ms behind ours"));
}

TEST(DoctorClock, RepeatsWhatTheHostSaysOfItself) {
  const Answers bound({{"/clock", clock_of(Duration{0}, {{"synchronised", true},
                                                         {"maxErrorNanoseconds", "1500000"}})}});
  EXPECT_THAT(finding_of(bound.url()).words,
              HasSubstr("(synchronised, by its own account at most 1.5 ms off)"));
  const Answers vague({{"/clock", clock_of(Duration{0}, {{"synchronised", true}})}});
  EXPECT_THAT(finding_of(vague.url()).words, HasSubstr(" (synchronised)"));
  const Answers free({{"/clock", clock_of(Duration{0}, {{"synchronised", false}})}});
  const Finding finding = finding_of(free.url());
  EXPECT_TRUE(finding.good) << "the tracker corrects it";
  EXPECT_THAT(finding.words, HasSubstr("follows no other clock"));
}

TEST(DoctorSensor, NumbersOfClocksMayBeNumbers) {
  const Json clock{{"nowNanoseconds", to_unix_ns(SystemClock().now() + std::chrono::seconds(10))}};
  const Answers early({{"/clock", said(clock.dump())}});
  EXPECT_THAT(finding_of(early.url()).words, HasSubstr("ahead of ours"));
}

TEST(DoctorSensor, OneWithoutAVersionIsNoReasonToReinstall) {
  const Answers silent(
      {{"/clock", clock_of(Duration{0})}, {"/metrics", said("chorus_frames 3\n")}});
  EXPECT_TRUE(finding_of(silent.url()).good);
  const Answers other({{"/clock", clock_of(Duration{0})},
                       {"/metrics", said("# HELP\nchorus_build{version=\"9.8.7\"} 1\n")}});
  EXPECT_EQ(finding_of(other.url()).words,
            "runs version 9.8.7, and this is " + std::string(version()));
}

TEST(DoctorSensor, AnAddressThatIsNoneOfOursIsNamedWithItsStatus) {
  const Answers other({});
  const Finding finding = finding_of(other.url());
  EXPECT_FALSE(finding.good);
  EXPECT_THAT(finding.advice, HasSubstr("ask chorus doctor on that host"));
  const Finding none = finding_of("10.0.0.1");
  EXPECT_FALSE(none.good);
  EXPECT_THAT(none.words, HasSubstr("10.0.0.1"));
}

TEST(DoctorSensor, TheAuthorityThatIsNotThereIsSaidBeforeTheSensors) {
  const Answers sensor({{"/clock", clock_of(Duration{0})}});
  const Findings all = sensor_findings({"fusion",
                                        "f",
                                        {{"poll", {{"ca", "/nowhere/ca.crt"}}},
                                         {"sensors", {{{"id", "s1"}, {"url", sensor.url()}}}}}});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].subject, "poll.ca");
  EXPECT_FALSE(all[0].good);
  EXPECT_TRUE(all[1].good) << "plain http needs none";
}

TEST(DoctorSensor, OnlyATrackerHasSensors) {
  EXPECT_TRUE(
      sensor_findings({"sensor", "s", {{"sensors", {{{"id", "s1"}, {"url", "x"}}}}}}).empty());
}

TEST(DoctorHealth, PassesOnWhatIsWrongAndWhereToLook) {
  auto router = std::make_shared<http::Router>();
  router->get("/healthz", [](const http::Request&, const http::PathParams&) {
    return Result<http::DocumentPtr>(fail(ErrorCode::Unavailable, "device", "is unplugged"));
  });
  http::Server server({}, router);
  ASSERT_TRUE(server.start());
  ExaminedService service{"sensor", "s", {{"http", {{"port", server.port()}}}}};
  const Finding sensor = health_finding(service);
  EXPECT_FALSE(sensor.good);
  EXPECT_THAT(sensor.words, HasSubstr("is unplugged"));
  EXPECT_THAT(sensor.advice, HasSubstr("is the device there"));
  service.kind = "fusion";
  EXPECT_EQ(health_finding(service).subject, "chorus-fusion");
  EXPECT_THAT(health_finding(service).advice, HasSubstr("then: chorus register"));
}

TEST(DoctorToken, CannotBeTriedWhileNobodyAnswers) {
  const Finding finding = token_finding({"sensor", "s", {{"http", {{"port", 1}}}}});
  EXPECT_FALSE(finding.good);
  EXPECT_THAT(finding.words, HasSubstr("cannot be tried"));
  EXPECT_EQ(finding.advice, "see above");
}

TEST(DoctorCertificate, IsGoodUntilADayThatIsFarAway) {
  const TemporaryFolder folder;
  const WorkshopAuthority authority;
  const auto file =
      folder.write("host.crt", authority.issue({"s1.local", "10.0.0.11"}, 90).certificate);
  const auto found = certified(file.string());
  EXPECT_EQ(found[0], "good") << found[1];
  EXPECT_THAT(found[1], HasSubstr(", for s1.local, 10.0.0.11"));
  EXPECT_EQ(found[2], "");
}

TEST(DoctorCertificate, AsksForAnotherOneAMonthAhead) {
  const TemporaryFolder folder;
  const WorkshopAuthority authority;
  const auto soon = folder.write("soon.crt", authority.issue({"s1.local"}, 29).certificate);
  EXPECT_THAT(certified(soon.string())[1], StartsWith("expires on "));
  EXPECT_THAT(certified(soon.string())[2], HasSubstr("--renew"));
  EXPECT_THAT(certified(soon.string())[2], HasSubstr("systemctl reload chorus-sensor"));
  const auto over = folder.write("over.crt", authority.issue_expired({"s1.local"}).certificate);
  EXPECT_THAT(certified(over.string())[1], StartsWith("has expired on "));
}

TEST(DoctorCertificate, OneOfTheFutureMeansAWrongClock) {
  const TemporaryFolder folder;
  const WorkshopAuthority authority;
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  using std::chrono::hours;
  const auto issued = tls::new_certificate(authority.files(), {"s1.local"},
                                           {now + hours(24), now + hours(24 * 90)});
  const auto file = folder.write("new.crt", issued.value().certificate);
  EXPECT_THAT(certified(file.string())[1], StartsWith("is not good before "));
  EXPECT_EQ(certified(file.string())[2], "set the clock of this host");
}

TEST(DoctorCertificate, OneThatCannotBeReadIsWrongAndNoneIsFine) {
  const TemporaryFolder folder;
  EXPECT_EQ(certified((folder / "none.crt").string())[0], "wrong");
  EXPECT_EQ(certified(folder.write("text.crt", "no certificate").string())[0], "wrong");
  EXPECT_TRUE(certificate_findings({"sensor", "s", Json::object()}).empty());
}

TEST(DoctorDisk, LooksAtRecordingsAndAtAStateFolderThatIsNamed) {
  const TemporaryFolder folder;
  const std::string here = folder.path().string();
  const auto subjects = [](const Json& config) {
    std::vector<std::string> all;
    for (const Finding& each : disk_findings({"fusion", "f", config})) all.push_back(each.subject);
    return all;
  };
  EXPECT_THAT(subjects({{"recording", {{"folder", here}}}, {"state_dir", here}}),
              ElementsAre("recordings " + here, "state " + here));
  EXPECT_THAT(subjects({{"state_dir", "auto"}}), ElementsAre()) << "systemd sees to it";
  EXPECT_THAT(subjects({{"recording", {{"folder", ""}}}}), ElementsAre());
}

TEST(ExaminedService, IsReachedAtItsOwnAddress) {
  const auto url = [](const Json& http) {
    return ExaminedService{"sensor", "s", {{"http", http}}}.url();
  };
  EXPECT_EQ(url(Json::object()), "http://127.0.0.1:8081/");
  EXPECT_EQ(url({{"address", "10.0.0.11"}, {"port", 9000}}), "http://10.0.0.11:9000/");
  EXPECT_EQ(url({{"address", "::"}}), "http://127.0.0.1:8081/");
  EXPECT_EQ(url({{"address", "fd00::11"}}), "http://[fd00::11]:8081/");
  for (const Json& port : std::vector<Json>{0, -1, 65536, "80"})
    EXPECT_EQ(url({{"port", port}}), "http://127.0.0.1:8081/") << port;
}

TEST(ExaminedService, WithTlsIsReachedByANameOfItsCertificate) {
  const TemporaryFolder folder;
  const WorkshopAuthority authority;
  const auto file =
      folder.write("host.crt", authority.issue({"s1.local", "10.0.0.11"}).certificate);
  const auto url = [&](const std::string& address) {
    return ExaminedService{
        "sensor",
        "s",
        {{"http", {{"address", address}, {"tls", {{"certificate", file.string()}}}}}}}
        .url();
  };
  EXPECT_EQ(url("0.0.0.0"), "https://s1.local:8081/");
  EXPECT_EQ(url("10.0.0.11"), "https://10.0.0.11:8081/");
}

TEST(ExaminedService, ReadsWithTheFirstTokenThereIs) {
  const auto token = [](const Json& http) {
    return ExaminedService{"sensor", "s", {{"http", http}}}.read_token();
  };
  EXPECT_EQ(token({{"tokens", {{{"role", "read"}}, {{"token", "second-token"}}}},
                   {"bearer_token", "older-token"}}),
            "second-token");
  EXPECT_EQ(token({{"bearer_token", "older-token"}}), "older-token");
  EXPECT_EQ(token(Json::object()), "");
}

}  // namespace
}  // namespace chorus::ctl
