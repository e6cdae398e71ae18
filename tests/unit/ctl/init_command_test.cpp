// chorus init writes what the services read, and overwrites no file.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>

#include "common/service/config_source.h"
#include "common/tls/certificate.h"
#include "common/tls/credentials.h"
#include "fusion-server/server/fusion_settings.h"
#include "services/ctl/setup/written_config.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Outcome run(std::vector<std::string> words) {
  words.insert(words.begin(), "init");
  return run_chorus(words);
}

server::FusionSettings settings_of(const std::string& text) {
  auto root = ConfigReader::parse(text, "init");
  EXPECT_TRUE(root) << to_string(root.error());
  auto settings = server::read_fusion_settings(*root);
  EXPECT_TRUE(settings) << (settings ? "" : to_string(settings.error()));
  return settings.value_or(server::FusionSettings{});
}

TEST(Init, PrintsNextStepsThatFindTheFile) {
  const chorus::testing::TemporaryFolder folder;
  const Outcome made = run({"fusion", "--out", (folder / "fusion.json").string(), "--no-announce"});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  EXPECT_THAT(made.error,
              HasSubstr("chorus doctor --folder " + (folder / "").parent_path().string()));
  EXPECT_THAT(run({"fusion", "--out", "-", "--sensor", "s1"}).error, HasSubstr("has no URL"));
}

TEST(Init, WritesAFusionConfigurationThatTheServerReads) {
  const Outcome made =
      run({"fusion", "--out", "-", "--sensor", "s1=http://10.0.0.11:8081/,abcdefabcdef", "--sensor",
           "s2=http://10.0.0.12:8081/", "--output", "vrpn=10.0.0.20,10.0.1.0/24", "--output",
           "dtrack=10.0.0.21:5000", "--output", "trackd"});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  const server::FusionSettings settings = settings_of(made.out);
  ASSERT_EQ(settings.live.sensors.size(), 2u);
  EXPECT_EQ(settings.live.sensors[0].token, "abcdefabcdef");
  EXPECT_EQ(settings.live.sensors[1].token, "");
  EXPECT_EQ(settings.at_start.http.address, "0.0.0.0");
  ASSERT_EQ(settings.live.tokens.size(), 2u);
  EXPECT_EQ(settings.live.tokens[0].role, http::Role::Control);
  EXPECT_EQ(settings.live.tokens[1].role, http::Role::Read);
  EXPECT_EQ(settings.live.tokens[0].secret.size(), 32u);
  const auto& vrpn = settings.live.outputs.vrpn;
  EXPECT_TRUE(vrpn.common.enabled);
  EXPECT_EQ(vrpn.protocol.allow, net::AllowList::parse({"10.0.0.20", "10.0.1.0/24"}).value());
  EXPECT_TRUE(settings.live.outputs.dtrack.common.enabled);
  EXPECT_EQ(settings.live.outputs.dtrack.protocol.targets,
            std::vector<std::string>{"10.0.0.21:5000"});
  EXPECT_FALSE(settings.live.outputs.natnet.common.enabled);
  EXPECT_EQ(settings.at_start.state_dir, "/var/lib/chorus/fusion");
  EXPECT_EQ(settings.at_start.viewer_dir, "/usr/share/chorus/viewer");
}

TEST(Init, TakesSensorsFromAFileSoThatNoTokenIsSeen) {
  const testing::TemporaryFolder folder;
  const auto list =
      folder.write("list", "s1=http://10.0.0.11:8081/,abcdefabcdef\n\ns2=http://10.0.0.12:8081/\n");
  const Outcome made = run({"fusion", "--out", "-", "--sensors-from", list.string()});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  ASSERT_EQ(settings_of(made.out).live.sensors.size(), 2u);
  EXPECT_EQ(settings_of(made.out).live.sensors[0].token, "abcdefabcdef");
  EXPECT_EQ(run({"fusion", "--out", "-", "--sensors-from", "/no/such"}).code, kExitFailed);
}

TEST(Init, ACameraIsOneOption) {
  const Outcome made =
      run({"sensor", "--out", "-", "--device", "camera", "--camera", "rtsp://10.0.0.5/1"});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  EXPECT_THAT(made.out, HasSubstr("\"kind\": \"camera\""));
  EXPECT_THAT(made.out, HasSubstr("\"camera\": { \"source\": \"rtsp://10.0.0.5/1\" }"));
}

Environment with_run_folder(const std::string& folder) {
  return [folder](const char* name) {
    return std::string_view(name) == "XDG_RUNTIME_DIR" ? folder.c_str() : nullptr;
  };
}

TEST(Init, ABridgesSocketIsWhereItsUserMayMakeAFile) {
  const testing::TemporaryFolder folder;
  const Environment user = with_run_folder(folder.path().string());
  EXPECT_EQ(push_socket("s1", true, user), "/run/chorus-sensor/push")
      << "systemd makes that folder";
  EXPECT_EQ(push_socket("s1", false, user), (folder / "chorus-s1.push").string());
  EXPECT_NE(push_socket("s1", false, user), push_socket("s2", false, user)) << "both on one host";
  EXPECT_EQ(push_socket("s1", false, with_run_folder((folder / "gone").string())),
            "/tmp/chorus-s1.push");
  EXPECT_EQ(push_socket("s1", false, with_run_folder("")), "/tmp/chorus-s1.push");
}

TEST(Init, ABridgeWrittenForAUserNamesNoFolderOfThePackage) {
  EXPECT_THAT(run({"sensor", "--id", "s1", "--device", "bridge", "--out", "-"}).out,
              AllOf(HasSubstr("/chorus-s1.push\" }"), Not(HasSubstr("/run/chorus-sensor"))));
}

TEST(Init, APhoneIsABridgeWithItsPageAndALinkToOpen) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "sensor.json").string();
  const Outcome plain = run({"sensor", "--id", "door", "--device", "phone", "--no-tls", "--token",
                             "abcdefabcdef", "--out", file});
  ASSERT_EQ(plain.code, kExitOk) << plain.error;
  EXPECT_THAT(plain.error, AllOf(HasSubstr(":8081/capture/#token=abcdefabcdef\n"),
                                 HasSubstr("no browser gives it a camera")));
  const Outcome made =
      run({"sensor", "--device", "phone", "--tls", "/etc/chorus/tls", "--out", "-"});
  EXPECT_THAT(made.out, AllOf(HasSubstr("\"kind\": \"bridge\""), HasSubstr("\"page\": true")));
}

TEST(Init, ATokenInALinkIsPercentEncoded) {
  const testing::TemporaryFolder folder;
  const Outcome made = run({"sensor", "--device", "phone", "--no-tls", "--token", "a+b&c%20-d_e.f#",
                            "--out", (folder / "sensor.json").string()});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  EXPECT_THAT(made.error, HasSubstr("/capture/#token=a%2Bb%26c%2520-d_e.f%23\n"));
}

TEST(Init, LoopbackNeedsNoTokens) {
  const Outcome made = run({"fusion", "--out", "-", "--listen", "127.0.0.1", "--port", "9000"});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  EXPECT_THAT(made.out, Not(HasSubstr("\"tokens\"")));
  EXPECT_EQ(settings_of(made.out).at_start.http.port, 9000);
}

TEST(Init, TwoRunsMakeTwoTokens) {
  EXPECT_NE(new_token(), new_token());
  EXPECT_EQ(new_token().find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(Init, OverwritesNothingAndKeepsTokensFromOthers) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "sensor.json").string();
  const Outcome first = run({"sensor", "--id", "cam-1", "--out", file});
  ASSERT_EQ(first.code, kExitOk) << first.error;
  EXPECT_THAT(first.error, AllOf(HasSubstr("chorus-sensor --config " + file + "\n"),
                                 Not(HasSubstr("systemctl")),  // a unit reads /etc/chorus
                                 HasSubstr("--sensor cam-1=http://")));
  const auto others = std::filesystem::perms::others_all;
  EXPECT_EQ(std::filesystem::status(file).permissions() & others, std::filesystem::perms::none);
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const Outcome second = run({"sensor", "--id", "cam-2", "--out", file});
  EXPECT_EQ(second.code, kExitUsage);
  EXPECT_THAT(second.error, HasSubstr("exists and is not overwritten"));
  std::ifstream again(file);
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>(again), {}}), text);
}

TEST(Init, SaysWhatIsWrongWithAWish) {
  const auto complaint = [](std::vector<std::string> words) {
    words.insert(words.end(), {"--out", "-"});
    const Outcome outcome = run(std::move(words));
    EXPECT_EQ(outcome.code, kExitUsage) << outcome.error;
    EXPECT_EQ(outcome.out, "");
    return outcome.error;
  };
  EXPECT_THAT(complaint({"fusion", "--sensor", "http://10.0.0.1/"}), HasSubstr("ID=URL"));
  EXPECT_THAT(complaint({"fusion", "--sensor", "s1=10.0.0.1"}), HasSubstr("ID=URL"));
  EXPECT_THAT(complaint({"fusion", "--sensor", "s1=http://10.0.0.1/,TOKEN"}),
              HasSubstr("TOKEN stands for one"));
  EXPECT_THAT(complaint({"fusion", "--output", "vprn=1"}), HasSubstr("there are vrpn"));
  EXPECT_THAT(complaint({"fusion", "--output", "vrpn"}), HasSubstr("who may connect"));
  EXPECT_THAT(complaint({"fusion", "--output", "dtrack="}), HasSubstr("where to send"));
  EXPECT_THAT(complaint({"fusion", "--output", "vrpn=render"}), HasSubstr("render"));
  EXPECT_THAT(complaint({"fusion", "--output", "vmc=10.0.0.1"}), HasSubstr("vmc=10.0.0.1:PORT"));
  EXPECT_THAT(complaint({"fusion", "--output", "vmc=10.0.0.1:0"}), HasSubstr("no port"));
  EXPECT_THAT(complaint({"fusion", "--sensor", "s1=http://a/", "--sensor", "s1=http://b/"}),
              HasSubstr("named twice"));
  EXPECT_THAT(complaint({"fusion", "--token", "short"}), HasSubstr("at least 12"));
  EXPECT_THAT(complaint({"sensor", "--listen", "localhost"}), HasSubstr("127.0.0.1"));
  EXPECT_THAT(complaint({"sensor", "--device", "kinect"}), HasSubstr("none of bridge"));
  EXPECT_THAT(complaint({"sensor", "--device", "replay"}), HasSubstr("needs the file"));
  EXPECT_THAT(complaint({"sensor", "--id", "a b"}), HasSubstr("a b"));
}

TEST(Init, SimulatedSensorsOfOneWorkshopStandInDifferentPlaces) {
  const auto place = [](const std::string& id) {
    return run({"sensor", "--id", id, "--device", "simulated", "--out", "-"}).out;
  };
  EXPECT_THAT(place("s1"), HasSubstr("\"index\": 0"));
  EXPECT_THAT(place("s3"), HasSubstr("\"index\": 2"));
  EXPECT_THAT(place("corner-7"), HasSubstr("\"index\": 0"));
  EXPECT_THAT(place("window"), HasSubstr("\"index\": 0"));
  EXPECT_THAT(
      run({"sensor", "--id", "window", "--port", "8082", "--device", "simulated", "--out", "-"})
          .out,
      HasSubstr("\"index\": 1"))
      << "two of one host whose ids have no number";
}

class InitTls : public ::testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] static unsigned mode_of(const std::string& file) {
    return static_cast<unsigned>(std::filesystem::status(file).permissions());
  }

  testing::TemporaryFolder folder_;
};

TEST_F(InitTls, AnAuthorityVouchesForAHost) {
  const Outcome authority = run({"ca", "--out", at("ca"), "--name", "Hall 3"});
  ASSERT_EQ(authority.code, kExitOk);
  EXPECT_THAT(authority.error, HasSubstr("HOST ADDRESS --authority " + at("ca") + "\n"));
  EXPECT_EQ(mode_of(at("ca/ca.key")), 0600u);
  EXPECT_EQ(mode_of(at("ca")), 0700u);
  const Outcome made = run({"certificate", "s1.local", "10.0.0.11", "--authority", at("ca"),
                            "--out", at("s1"), "--days", "90"});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  EXPECT_EQ(mode_of(at("s1/host.key")), 0640u);
  const auto facts = tls::facts_of(testing::bytes_of(at("s1/host.crt")));
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->issuer, "Hall 3");
  EXPECT_THAT(facts->names,
              ::testing::ElementsAre("s1.local", "10.0.0.11", "localhost", "127.0.0.1", "::1"));
  EXPECT_TRUE(tls::Identity::load(at("s1/host.crt"), at("s1/host.key")));
  EXPECT_EQ(testing::bytes_of(at("s1/ca.crt")), testing::bytes_of(at("ca/ca.crt")));
}

TEST_F(InitTls, NothingIsOverwrittenUnlessRenewed) {
  ASSERT_EQ(run({"ca", "--out", at("ca")}).code, kExitOk);
  const std::string authority = testing::bytes_of(at("ca/ca.key"));
  const Outcome twice = run({"ca", "--out", at("ca")});
  EXPECT_EQ(twice.code, kExitUsage);
  EXPECT_THAT(twice.error, HasSubstr("chorus init certificate"));
  EXPECT_THAT(twice.error, ::testing::Not(HasSubstr("edit it"))) << "nobody edits a key";
  EXPECT_EQ(testing::bytes_of(at("ca/ca.key")), authority);
  const std::vector<std::string> again{"certificate", "a",     "--authority",
                                       at("ca"),      "--out", at("t")};
  ASSERT_EQ(run(again).code, kExitOk);
  const std::string first = testing::bytes_of(at("t/host.crt"));
  const Outcome refused = run(again);
  EXPECT_EQ(refused.code, kExitUsage);
  EXPECT_THAT(refused.error, HasSubstr("--renew"));
  EXPECT_EQ(testing::bytes_of(at("t/host.crt")), first);
  std::vector<std::string> renewed = again;
  renewed.emplace_back("--renew");
  EXPECT_EQ(run(renewed).code, kExitOk);
  EXPECT_NE(testing::bytes_of(at("t/host.crt")), first);
  EXPECT_TRUE(tls::Identity::load(at("t/host.crt"), at("t/host.key")));
}

TEST_F(InitTls, ServicesUseWhatIsThere) {
  ASSERT_EQ(run({"ca", "--out", at("ca")}).code, kExitOk);
  ASSERT_EQ(run({"certificate", "a", "--authority", at("ca"), "--out", at("t")}).code, kExitOk);
  const Outcome made =
      run({"fusion", "--out", "-", "--tls", at("t"), "--sensor", "s1=https://10.0.0.11:8081/"});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  const server::FusionSettings settings = settings_of(made.out);
  ASSERT_TRUE(settings.live.identity);
  EXPECT_TRUE(settings.at_start.secure);
  EXPECT_EQ(settings.live.sensors[0].trust, tls::Trust::load(at("t/ca.crt")).value());
  EXPECT_FALSE(settings_of(run({"fusion", "--out", "-", "--no-tls"}).out).live.identity);
}

TEST_F(InitTls, TheAddressThatIsPrintedIsOneOfTheCertificates) {
  ASSERT_EQ(run({"ca", "--out", at("ca")}).code, kExitOk);
  ASSERT_EQ(
      run({"certificate", "localhost", "cam.example", "--authority", at("ca"), "--out", at("t")})
          .code,
      kExitOk);
  EXPECT_THAT(run({"sensor", "--id", "s1", "--tls", at("t"), "--out", at("s.json")}).error,
              HasSubstr("--sensor s1=https://cam.example:8081/"));
  EXPECT_THAT(run({"fusion", "--tls", at("t"), "--out", at("f.json")}).error,
              HasSubstr("https://cam.example:8080/viewer/"));
}

TEST_F(InitTls, MistakesSayWhatToDo) {
  EXPECT_THAT(run({"sensor", "--id", "s1", "--tls", at("none"), "--out", at("n.json")}).error,
              HasSubstr("chorus init certificate --out " + at("none")));
  EXPECT_THAT(run({"fusion", "--sensors-from", at("none"), "--out", at("n2.json")}).error,
              HasSubstr("ID=URL,TOKEN"));
  EXPECT_THAT(run({"certificate", "a", "--authority", at("no"), "--out", at("t")}).error,
              HasSubstr("--authority"));
  ASSERT_EQ(run({"ca", "--out", at("ca")}).code, kExitOk);
  EXPECT_THAT(run({"certificate", "a b", "--authority", at("ca"), "--out", at("t")}).error,
              HasSubstr("neither a host's name"));
  EXPECT_THAT(run({"sensor", "stray", "--out", "-"}).error, HasSubstr("stray"));
}

}  // namespace
}  // namespace chorus::ctl
