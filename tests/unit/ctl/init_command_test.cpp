// chorus init writes what the services read, and overwrites nothing.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>

#include "common/service/config_source.h"
#include "fusion-server/server/fusion_settings.h"
#include "services/ctl/written_config.h"
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
  const auto& vrpn = settings.at_start.outputs.vrpn;
  EXPECT_TRUE(vrpn.common.enabled);
  EXPECT_EQ(vrpn.protocol.allow, net::AllowList::parse({"10.0.0.20", "10.0.1.0/24"}).value());
  EXPECT_TRUE(settings.at_start.outputs.dtrack.common.enabled);
  EXPECT_EQ(settings.at_start.outputs.dtrack.protocol.targets,
            std::vector<std::string>{"10.0.0.21:5000"});
  EXPECT_FALSE(settings.at_start.outputs.natnet.common.enabled);
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
  EXPECT_THAT(first.error, AllOf(HasSubstr("systemctl restart chorus-sensor"),
                                 HasSubstr("--sensor cam-1=http://")));
  const auto others = std::filesystem::perms::others_all;
  EXPECT_EQ(std::filesystem::status(file).permissions() & others, std::filesystem::perms::none);
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const Outcome second = run({"sensor", "--id", "cam-2", "--out", file});
  EXPECT_EQ(second.code, kExitFailed);
  EXPECT_THAT(second.error, HasSubstr("exists and is not overwritten"));
  std::ifstream again(file);
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>(again), {}}), text);
}

TEST(Init, SaysWhatIsWrongWithAWish) {
  const auto complaint = [](std::vector<std::string> words) {
    words.insert(words.end(), {"--out", "-"});
    const Outcome outcome = run(std::move(words));
    EXPECT_EQ(outcome.code, kExitFailed);
    EXPECT_EQ(outcome.out, "");
    return outcome.error;
  };
  EXPECT_THAT(complaint({"fusion", "--sensor", "http://10.0.0.1/"}), HasSubstr("ID=URL"));
  EXPECT_THAT(complaint({"fusion", "--sensor", "s1=10.0.0.1"}), HasSubstr("ID=URL"));
  EXPECT_THAT(complaint({"fusion", "--output", "vprn=1"}), HasSubstr("there are vrpn"));
  EXPECT_THAT(complaint({"fusion", "--output", "vrpn"}), HasSubstr("who may connect"));
  EXPECT_THAT(complaint({"fusion", "--output", "dtrack="}), HasSubstr("where to send"));
  EXPECT_THAT(complaint({"sensor", "--device", "kinect"}), HasSubstr("none of bridge"));
  EXPECT_THAT(complaint({"sensor", "--device", "replay"}), HasSubstr("needs the file"));
  EXPECT_THAT(complaint({"sensor", "--id", "a b"}), HasSubstr("a b"));
}

}  // namespace
}  // namespace chorus::ctl
