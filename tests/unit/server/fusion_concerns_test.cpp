// What --check says about settings that are valid but hardly intended.
#include "fusion-server/server/fusion_concerns.h"

#include <gmock/gmock.h>

#include "common/base/config_reader.h"
#include "tests/support/temporary_folder.h"

namespace chorus::server {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Two sensors, without folders, on any port, plus `more` members of the root.
FusionSettings two_sensors_with(const std::string& more) {
  const std::string text = R"({"state_dir": "", "viewer_dir": "", "sensors": [
      {"id": "s1", "url": "http://127.0.0.1:8081/"}, {"id": "s2", "url": "http://10.0.0.2:8080/"}],
      )" + more + "}";
  const auto read = ConfigReader::parse(text, "test").and_then(&read_fusion_settings);
  EXPECT_TRUE(read) << to_string(read.error());
  return read.value_or(FusionSettings{});
}

TEST(SettingConcerns, NothingIsWrongWithWhatFits) {
  EXPECT_THAT(
      setting_concerns(two_sensors_with(R"("http": {"port": 8080}, "registration": {"master": "s2"},
                                       "outputs": {"vrpn": {"enabled": true}})")),
      IsEmpty());
  EXPECT_THAT(setting_concerns({}), IsEmpty());
}

TEST(SettingConcerns, SensorsThatAreNamedAreConfigured) {
  EXPECT_THAT(setting_concerns(two_sensors_with(R"("registration": {"master": "s9"})")),
              Contains("registration.master: \"s9\" is none of the sensors"));
  EXPECT_THAT(setting_concerns(two_sensors_with(R"("registration": {"known_distances":
                                       [{"between": ["s1", "b"], "m": 4}]})")),
              Contains("registration.known_distances: \"b\" is none of the sensors"));
}

TEST(SettingConcerns, ASensorIsNotThisServer) {
  EXPECT_THAT(setting_concerns(two_sensors_with(R"("http": {"port": 8081})")),
              Contains(HasSubstr("the url of s1 is that of this server itself")));
}

TEST(SettingConcerns, NoTwoOutputsShareAPort) {
  EXPECT_THAT(setting_concerns(two_sensors_with(
                  R"("http": {"port": 3883}, "outputs": {"vrpn": {"enabled": true}})")),
              Contains(HasSubstr("outputs.vrpn.port: is the port of http.port too")));
  EXPECT_THAT(setting_concerns(two_sensors_with(R"("http": {"port": 3883})")), IsEmpty())
      << "not enabled";
  EXPECT_THAT(setting_concerns(two_sensors_with(R"("http": {"port": 50105}, "outputs": {
                  "dtrack": {"enabled": true, "command": {"enabled": true}}})")),
              Contains(HasSubstr("outputs.dtrack.command.port: is the port of http.port too")));
  EXPECT_THAT(setting_concerns(
                  two_sensors_with(R"("outputs": {"natnet": {"enabled": true, "command_port": 3883},
                                                   "vrpn": {"enabled": true}})")),
              Contains(HasSubstr("outputs.natnet.command_port: is the port of outputs.vrpn.port")));
  EXPECT_THAT(setting_concerns(two_sensors_with(
                  R"("http": {"port": 1510}, "outputs": {"natnet": {"enabled": true}})")),
              IsEmpty())
      << "one is TCP, the other UDP";
  const auto alone =
      ConfigReader::parse(R"({"http": {"port": 3883}, "outputs": {"vrpn": {"enabled": true}}})",
                          "test")
          .and_then(&read_fusion_settings);
  ASSERT_TRUE(alone);
  EXPECT_THAT(setting_concerns(*alone),
              Contains(HasSubstr("outputs.vrpn.port: is the port of http.port too")))
      << "without sensors, too";
}

TEST(HostConcerns, TheGivenPlacesCanBeReadAndAreThoseOfTheSensors) {
  const chorus::testing::TemporaryFolder folder;
  const auto of_file = [](const std::string& file) {
    return host_concerns(two_sensors_with(R"("http": {"port": 0}, "registration": {"file": ")" +
                                          file + R"(", "auto": false})"));
  };
  EXPECT_THAT(of_file("nothere.json"),
              Contains("registration.file: nothere.json: cannot be read: there is no such file"));
  const auto placing = [&folder](const char* sensor) {
    return folder
        .write("places.json",
               std::string(R"({"sensors": {")") + sensor +
                   R"(": {"x": 1, "y": 2, "z": 3, "qx": 0, "qy": 0, "qz": 0, "qw": 1}}})")
        .string();
  };
  EXPECT_THAT(of_file(placing("zz")), Contains(HasSubstr("places none of the configured sensors")));
  EXPECT_THAT(of_file(placing("s2")), Each(Not(HasSubstr("registration.file"))));
}

TEST(HostConcerns, AStoredRegistrationThatIsDamagedIsToldAndLeftAlone) {
  const chorus::testing::TemporaryFolder folder;
  const auto file = folder.write("registration.json", "{");
  FusionSettings settings = two_sensors_with(R"("http": {"port": 0})");
  settings.at_start.state_dir = folder.path().string();
  EXPECT_THAT(host_concerns(settings),
              Contains(HasSubstr("the stored registration cannot be read")));
  EXPECT_TRUE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace chorus::server
