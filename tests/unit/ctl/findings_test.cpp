#include "services/ctl/setup/findings.h"

#include <pwd.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include <gmock/gmock.h>

#include "common/base/version.h"
#include "common/http/server.h"
#include "common/net/asio.h"
#include "tests/support/temporary_folder.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;

/// A service that answers /clock, /metrics and /healthz, with a token of role read.
struct Fake {
  Fake() : server(config(), routes()) { EXPECT_TRUE(server.start()); }

  static http::ServerConfig config() {
    http::ServerConfig config;
    config.tokens = {{"0123456789ab", http::Role::Read}};
    return config;
  }
  std::shared_ptr<http::Router> routes() {
    auto router = std::make_shared<http::Router>();
    const auto text = [&](const char* path, auto make) {
      router->get(
          path, [make](const http::Request&, const http::PathParams&) -> Result<http::DocumentPtr> {
            return http::make_document("application/json", make(), {"1"});
          });
    };
    text("/clock", [this] {
      return nlohmann::json{{"nowNanoseconds", to_unix_ns(SystemClock().now() + ahead)}}.dump();
    });
    text("/metrics", [this] { return "chorus_build{version=\"" + version + "\"} 1\n"; });
    text("/healthz", [] { return std::string("{}"); });
    router->for_everybody("/healthz");
    return router;
  }
  [[nodiscard]] ExaminedService fusion(const std::string& token) const {
    const std::string url = "http://127.0.0.1:" + std::to_string(server.port()) + "/";
    return {"fusion", "f", {{"sensors", {{{"id", "s1"}, {"url", url}, {"token", token}}}}}};
  }
  [[nodiscard]] ExaminedService itself(const std::string& token) const {
    return {"sensor", "s", {{"http", {{"port", server.port()}, {"tokens", {{{"token", token}}}}}}}};
  }

  Duration ahead{0};
  std::string version{chorus::version()};
  http::Server server;
};

Finding only(const Findings& all) {
  EXPECT_EQ(all.size(), 1u);
  return all.at(0);
}

TEST(Doctor, FindsASensorWell) {
  const Fake fake;
  const Finding finding = only(sensor_findings(fake.fusion("0123456789ab")));
  EXPECT_TRUE(finding.good) << finding.words;
  EXPECT_EQ(finding.subject, "sensor s1");
}

/// Accepts connections and closes them at once.
class HangsUp {
 public:
  HangsUp() : acceptor_(io_, {asio::ip::address_v4::loopback(), 0}) {
    accept();
    thread_ = std::thread([this] { io_.run(); });
  }
  ~HangsUp() {
    io_.stop();
    thread_.join();
  }
  [[nodiscard]] std::string url() const {
    return "https://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port()) + "/";
  }

 private:
  void accept() {
    acceptor_.async_accept([this](net::error_code failed, asio::ip::tcp::socket) {
      if (!failed) accept();
    });
  }
  asio::io_context io_;
  asio::ip::tcp::acceptor acceptor_;
  std::thread thread_;
};

TEST(Doctor, AHostThatHangsUpIsNotSaidToHaveABadCertificate) {
  const HangsUp host;
  const ExaminedService fusion{
      "fusion", "f", {{"sensors", {{{"id", "s1"}, {"url", host.url()}, {"token", ""}}}}}};
  const Finding finding = only(sensor_findings(fusion));
  EXPECT_THAT(finding.words, HasSubstr("certificate")) << "its message asks about one";
  EXPECT_THAT(finding.advice, HasSubstr("is chorus-sensor running there"));
}

TEST(Doctor, SaysWhatToDoAboutAWrongToken) {
  const Fake fake;
  const Finding finding = only(sensor_findings(fake.fusion("another-token")));
  EXPECT_FALSE(finding.good);
  EXPECT_THAT(finding.advice, HasSubstr("http.tokens"));
}

TEST(Doctor, SeesAClockThatIsOff) {
  Fake fake;
  for (const int ms : {-200, 200}) {
    fake.ahead = std::chrono::milliseconds(ms);
    const Finding finding = only(sensor_findings(fake.fusion("0123456789ab")));
    EXPECT_FALSE(finding.good) << ms;
    EXPECT_THAT(finding.advice, HasSubstr("chrony"));
  }
}

TEST(Doctor, SeesAnotherVersion) {
  Fake fake;
  fake.version = "0.0.9";
  const Finding finding = only(sensor_findings(fake.fusion("0123456789ab")));
  EXPECT_FALSE(finding.good);
  EXPECT_THAT(finding.words, HasSubstr("0.0.9"));
}

TEST(Doctor, SeesThatNobodyIsThere) {
  ExaminedService service{
      "fusion", "f", {{"sensors", {{{"id", "s1"}, {"url", "http://127.0.0.1:1/"}}}}}};
  const Finding finding = only(sensor_findings(service));
  EXPECT_FALSE(finding.good);
  EXPECT_THAT(finding.advice, HasSubstr("firewall"));
  service.config = {{"http", {{"port", 1}}}};
  EXPECT_THAT(health_finding(service).advice, HasSubstr("systemctl start chorus-fusion"));
  EXPECT_FALSE(token_finding(service).good);
  EXPECT_THAT(only(sensor_findings(service)).advice, HasSubstr("chorus init fusion --sensor"));
}

TEST(Doctor, TriesTheTokensOfTheFileOnTheRunningService) {
  const Fake fake;
  EXPECT_TRUE(health_finding(fake.itself("")).good) << "without a token";
  EXPECT_TRUE(token_finding(fake.itself("0123456789ab")).good);
  EXPECT_THAT(token_finding(fake.itself("an-older-token")).advice, HasSubstr("systemctl reload"));
}

TEST(Doctor, LooksAtTheClockAndTheDisk) {
  NtpStatus clock;
  EXPECT_THAT(clock_finding(clock).advice, HasSubstr("chrony"));
  clock.synchronised = true;
  EXPECT_TRUE(clock_finding(clock).good);
  const testing::TemporaryFolder folder;
  const ExaminedService service{
      "sensor", "s", {{"recording", {{"folder", (folder / "not/yet").string()}}}}};
  EXPECT_THAT(only(disk_findings(service)).words, HasSubstr("MB free"));
  EXPECT_TRUE(disk_findings({"sensor", "s", nlohmann::json::object()}).empty());
}

TEST(Doctor, SeesAFolderThatTheServiceMayNotWriteTo) {
  const testing::TemporaryFolder folder;
  const auto there = folder.path() / "state";
  std::filesystem::create_directory(there);
  const ExaminedService service{"fusion", "f", {{"state_dir", there.string()}}};
  const auto own = only(disk_findings(service, ::getpwuid(::getuid())->pw_name));
  EXPECT_TRUE(own.good) << own.words;
  std::filesystem::permissions(there, std::filesystem::perms::owner_all);
  const auto closed = only(disk_findings(service, "nobody"));
  EXPECT_FALSE(closed.good);
  EXPECT_THAT(closed.advice, HasSubstr("chown -R nobody: " + there.string()));
  std::filesystem::permissions(there, std::filesystem::perms::all);
  EXPECT_TRUE(only(disk_findings(service, "nobody")).good);
  EXPECT_TRUE(only(disk_findings(service, "nobody-of-this-name")).good);
}

TEST(Doctor, TellsAnotherProgramAtThePortFromAnIllService) {
  http::Server other(http::ServerConfig{}, std::make_shared<http::Router>());
  ASSERT_TRUE(other.start());
  const ExaminedService service{"sensor", "s", {{"http", {{"port", other.port()}}}}};
  EXPECT_THAT(health_finding(service).advice, HasSubstr("another program has the port"));
  const std::string url = "http://127.0.0.1:" + std::to_string(other.port()) + "/";
  const ExaminedService fusion{"fusion", "f", {{"sensors", {{{"id", "s1"}, {"url", url}}}}}};
  EXPECT_THAT(only(sensor_findings(fusion)).advice, HasSubstr("no other program"));
}

TEST(Doctor, SaysThatAnAddressIsNone) {
  const ExaminedService fusion{
      "fusion", "f", {{"sensors", {{{"id", "s1"}, {"url", "10.0.0.11:8081"}}}}}};
  EXPECT_THAT(only(sensor_findings(fusion)).advice, HasSubstr("mend \"url\""));
}

TEST(Doctor, ReadsConfigurationsWithComments) {
  const testing::TemporaryFolder folder;
  const auto good = folder.write(
      "sensor.json", "// why\n{ \"http\": { \"port\": 9001, \"address\": \"0.0.0.0\" } }");
  const auto service = examined_service("sensor", good.string());
  ASSERT_TRUE(service);
  EXPECT_EQ(service->url(), "http://127.0.0.1:9001/");
  EXPECT_EQ((ExaminedService{"fusion", "f", nlohmann::json::object()}.url()),
            "http://127.0.0.1:8080/");
  EXPECT_FALSE(examined_service("sensor", folder.write("a.json", "[1]").string()));
  EXPECT_FALSE(examined_service("sensor", (folder / "none.json").string()));
}

}  // namespace
}  // namespace chorus::ctl
