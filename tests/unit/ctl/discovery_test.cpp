#include "common/client/discovery.h"

#include <cstdlib>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using client::announcement;
using client::discovered_sensors;
using client::FoundSensor;
using client::read_browsed;

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// As avahi-browse 0.8 printed it, on a host with two interfaces.
constexpr const char* kBrowsed =
    R"(+;d0;IPv4;Chorus\032sensor\032s1\032on\032s1;_chorus-sensor._tcp;local
+;lo;IPv4;Chorus\032sensor\032s1\032on\032s1;_chorus-sensor._tcp;local
=;lo;IPv4;Chorus\032sensor\032s1\032on\032s1;_chorus-sensor._tcp;local;s1.local;127.0.0.1;8081;"tls=1" "id=s1"
=;d0;IPv6;Chorus\032sensor\032s1\032on\032s1;_chorus-sensor._tcp;local;s1.local;fe80::1;8081;"tls=1" "id=s1"
=;d0;IPv4;Chorus\032sensor\032s1\032on\032s1;_chorus-sensor._tcp;local;s1.local;10.9.0.1;8081;"tls=1" "id=s1"
=;d0;IPv4;Chorus\032sensor\032a2;_chorus-sensor._tcp;local;a2.local;10.9.0.2;9000;"tls=0" "id=a2"
)";

TEST(Discovery, EachSensorIsFoundOnceAtItsBestAddress) {
  EXPECT_THAT(read_browsed(kBrowsed),
              ElementsAre(FoundSensor{"a2", "a2.local", "10.9.0.2", 9000, false},
                          FoundSensor{"s1", "s1.local", "10.9.0.1", 8081, true}));
}

constexpr const char* kStranger =
    R"(=;d0;IPv4;other;_chorus-sensor._tcp;local;evil.local;10.9.0.66;8081;"tls=0" "id=s1"
)";

TEST(Discovery, AStrangerWithTheSameIdIsShownBesidesTheSensor) {
  const FoundSensor stranger{"s1", "evil.local", "10.9.0.66", 8081, false};
  const FoundSensor sensor{"s1", "s1.local", "10.9.0.1", 8081, true};
  EXPECT_THAT(read_browsed(std::string(kStranger) + kBrowsed),
              ElementsAre(::testing::_, stranger, sensor));
  EXPECT_THAT(read_browsed(std::string(kBrowsed) + kStranger),
              ElementsAre(::testing::_, stranger, sensor));
}

TEST(Discovery, WithoutTlsAnAddressIsAllThatTellsAStrangerApart) {
  const auto at = [](const std::string& address, bool tls) {
    return "=;d0;IPv4;x;_chorus-sensor._tcp;local;a2.local;" + address +
           ";9000;\"tls=" + (tls ? "1" : "0") + "\" \"id=a2\"\n";
  };
  EXPECT_EQ(read_browsed(at("10.9.0.66", false) + at("10.9.0.2", false)).size(), 2u);
  EXPECT_EQ(read_browsed(at("10.9.0.2", false) + at("fd00::66", false)).size(), 2u);
  EXPECT_EQ(read_browsed(at("10.9.0.66", true) + at("10.9.0.2", true)).size(), 1u)
      << "it is asked by name, and the certificate tells";
  const FoundSensor sensor{"a2", "a2.local", "10.9.0.2", 9000, false};
  EXPECT_THAT(read_browsed(at("fe80::1", false) + at("10.9.0.2", false) + at("127.0.0.1", false)),
              ElementsAre(sensor));
}

/// While it exists, the first avahi-browse in PATH is a script that prints `text`.
class Browsed {
 public:
  explicit Browsed(const std::string& text) : path_(::getenv("PATH")) {
    const auto program = folder_.write("avahi-browse", "#!/bin/sh\ncat <<'END'\n" + text + "END\n");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    ::setenv("PATH", (folder_.path().string() + ":" + path_).c_str(), 1);
  }
  ~Browsed() { ::setenv("PATH", path_.c_str(), 1); }
  Browsed(const Browsed&) = delete;
  Browsed& operator=(const Browsed&) = delete;

 private:
  chorus::testing::TemporaryFolder folder_;
  std::string path_;
};

TEST(Discovery, InitFusionTakesNoSensorThatTwoAnnounce) {
  const Browsed two(std::string(kBrowsed) + kStranger);
  const Outcome refused = run_chorus({"init", "fusion", "--discover", "--out", "-"});
  EXPECT_EQ(refused.code, kExitFailed);
  EXPECT_THAT(refused.error, HasSubstr("s1: is announced more than once"));
  const Outcome named = run_chorus({"init", "fusion", "--discover", "--sensor",
                                    "s1=https://s1.local:8081/,0123456789ab", "--out", "-"});
  ASSERT_EQ(named.code, kExitOk) << named.error;
  EXPECT_THAT(named.out, HasSubstr("https://s1.local:8081/"));
  EXPECT_THAT(named.out, HasSubstr("http://10.9.0.2:9000/")) << "the other one is found";
  EXPECT_THAT(named.out, ::testing::Not(HasSubstr("10.9.0.66")));
}

TEST(DiscoverCommand, ListsEachSensorOnALine) {
  const Browsed found(kBrowsed);
  const Outcome told = run_chorus({"discover"});
  EXPECT_EQ(told.code, kExitOk) << told.error;
  EXPECT_EQ(told.error, "");
  const auto lines = lines_of(told.out);
  ASSERT_EQ(lines.size(), 3u) << told.out;
  EXPECT_THAT(lines[0], ::testing::MatchesRegex("sensor +url +host +address"));
  EXPECT_THAT(lines[1], ::testing::MatchesRegex(
                            "a2 +http://10\\.9\\.0\\.2:9000/ +a2\\.local +10\\.9\\.0\\.2"));
  EXPECT_THAT(lines[2],
              ::testing::MatchesRegex("s1 +https://s1\\.local:8081/ +s1\\.local +10\\.9.*"));
}

TEST(DiscoverCommand, TellsTheSameAsJson) {
  const Browsed found(kBrowsed);
  const auto json = nlohmann::json::parse(run_chorus({"discover", "--json"}).out);
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[0].at("url"), "http://10.9.0.2:9000/");
  EXPECT_EQ(json[1], nlohmann::json({{"id", "s1"},
                                     {"url", "https://s1.local:8081/"},
                                     {"host", "s1.local"},
                                     {"address", "10.9.0.1"},
                                     {"port", 8081},
                                     {"tls", true}}));
}

TEST(DiscoverCommand, NobodyThereIsAFailureThatSaysWhatSensorHostsNeed) {
  const Browsed nobody("");
  const Outcome told = run_chorus({"discover"});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_EQ(told.out, "");
  EXPECT_THAT(told.error, HasSubstr("no sensor announces itself in this network"));
  const Outcome json = run_chorus({"discover", "--json"});
  EXPECT_EQ(json.code, kExitFailed);
  EXPECT_EQ(json.out, "[]\n") << "still JSON";
}

TEST(DiscoverCommand, SaysWhatAvahiLacks) {
  const Browsed missing("END\nexit 127\ncat <<'END'\n");
  EXPECT_THAT(run_chorus({"discover"}).error, HasSubstr("apt install avahi-daemon avahi-utils"));
  const Browsed stopped(
      "Failed to create client object: Daemon not running\nEND\nexit 1\ncat <<'END'\n");
  EXPECT_THAT(run_chorus({"discover"}).error, HasSubstr("systemctl start avahi-daemon"));
  const Browsed broken("Some other reason\nEND\nexit 1\ncat <<'END'\n");
  const Outcome told = run_chorus({"discover"});
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("avahi-browse: failed: Some other reason"));
}

TEST(Discovery, TlsIsAskedByNameAndPlainHttpByAddress) {
  EXPECT_EQ((FoundSensor{"s1", "s1.local", "10.9.0.1", 8081, true}.url()),
            "https://s1.local:8081/");
  EXPECT_EQ((FoundSensor{"s1", "s1.local", "10.9.0.1", 8081, false}.url()),
            "http://10.9.0.1:8081/");
  EXPECT_EQ((FoundSensor{"s1", "s1.local", "fd00::1", 8081, false}.url()),
            "http://[fd00::1]:8081/");
}

TEST(Discovery, WhatAStrangerMakesUpIsLeftOut) {
  const auto line = [](const std::string& host, const std::string& address, const std::string& port,
                       const std::string& texts) {
    return "=;d0;IPv4;x;_chorus-sensor._tcp;local;" + host + ";" + address + ";" + port + ";" +
           texts;
  };
  EXPECT_EQ(read_browsed(line("h.local", "10.0.0.1", "1", "\"id=s1\"")).size(), 1u);
  for (const std::string& bad :
       {line("h.local", "10.0.0.1", "0", "\"id=s1\""),
        line("h.local", "10.0.0.1", "99999", "\"id=s1\""),
        line("h.local", "nowhere", "1", "\"id=s1\""), line("h/../x", "10.0.0.1", "1", "\"id=s1\""),
        line("h.local", "10.0.0.1", "1", "\"id=s 1;reboot\""),
        line("h.local", "10.0.0.1", "1", "\"id=\x1b[31m\""), line("h.local", "10.0.0.1", "1", ""),
        std::string("=;d0;IPv4"), std::string(";;;;;;;;;;"), std::string("\n\n=")})
    EXPECT_THAT(read_browsed(bad), IsEmpty()) << bad;
}

TEST(Discovery, AnAddressIsThatOfOneHost) {
  for (const char* bad : {"0.0.0.0", "0.1.2.3", "224.0.0.1", "239.255.255.250", "255.255.255.255",
                          "::", "ff02::fb", "::ffff:10.0.0.1"})
    EXPECT_THAT(read_browsed("=;d0;IPv4;x;_chorus-sensor._tcp;local;h.local;" + std::string(bad) +
                             ";8081;\"id=s1\""),
                IsEmpty())
        << bad;
}

TEST(Discovery, AFloodDoesNotHideTheRealSensors) {
  std::string text;
  for (int i = 0; i < 20'000; ++i)
    text += "=;d0;IPv4;x;_chorus-sensor._tcp;local;evil.local;10.9.0.66;" +
            std::to_string(1 + i % 60'000) + ";\"tls=0\" \"id=x" + std::to_string(i) + "\"\n";
  const auto found = read_browsed(text + kBrowsed);
  EXPECT_EQ(found.size(), 32u + 2u);
  EXPECT_THAT(found, ::testing::Contains(FoundSensor{"a2", "a2.local", "10.9.0.2", 9000, false}));
  EXPECT_THAT(found, ::testing::Contains(FoundSensor{"s1", "s1.local", "10.9.0.1", 8081, true}));
}

TEST(Discovery, ABrowserThatHangsIsNotWaitedForAndWhatItSaidCounts) {
  const AskLimits limits{std::chrono::milliseconds(300)};
  const Browsed hanging(std::string(kBrowsed) + "END\nsleep 60\ncat <<'END'\n");
  const auto found = discovered_sensors(limits);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->size(), 2u);
  const Browsed silent("END\nexec sleep 60\ncat <<'END'\n");
  const auto nothing = discovered_sensors(limits);
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, ErrorCode::Timeout);
}

TEST(Discovery, TheAnnouncementSaysWhatIsReadBack) {
  const std::string text = announcement("s1", 8081, true);
  for (const char* part :
       {"<type>_chorus-sensor._tcp</type>", "<port>8081</port>", "id=s1", "tls=1"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(Discovery, InitAnnouncesASensorOnlyWhereThatIsAskedFor) {
  const chorus::testing::TemporaryFolder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  const Outcome plain = run_chorus({"init", "sensor", "--id", "s1", "--out", at("a.json")});
  ASSERT_EQ(plain.code, kExitOk) << plain.error;
  EXPECT_EQ(plain.error.find("chorus discover"), std::string::npos);
  const Outcome told = run_chorus({"init", "sensor", "--id", "s1", "--port", "9001", "--out",
                                   at("b.json"), "--announce", folder.path().string()});
  EXPECT_THAT(told.error, HasSubstr("chorus discover finds this sensor"));
  EXPECT_THAT(chorus::testing::bytes_of(folder / "chorus-sensor.service"),
              HasSubstr("<port>9001<"));
  const Outcome unable =
      run_chorus({"init", "sensor", "--id", "s1", "--out", at("c.json"), "--announce", at("none")});
  EXPECT_EQ(unable.code, kExitOk) << "it is only an offer";
  EXPECT_THAT(unable.error, HasSubstr("not announced"));
}

}  // namespace
}  // namespace chorus::ctl
