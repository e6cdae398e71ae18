#include "common/service/concerns.h"

#include <filesystem>
#include <iterator>

#include <gmock/gmock.h>

#include "common/tls/authority.h"
#include "common/tls/certificate.h"
#include "tests/support/temporary_folder.h"

namespace chorus::service {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(UsableFolder, IsOneThatIsThereOrCanBeMade) {
  const chorus::testing::TemporaryFolder folder;
  EXPECT_TRUE(usable_folder((folder / "deep/er").string()));
  EXPECT_FALSE(std::filesystem::exists(folder / "deep")) << "looked at, not made";
  const auto file = folder.write("file", "in the way");
  EXPECT_FALSE(usable_folder(file.string()));
  EXPECT_FALSE(usable_folder((file / "below").string()));
  EXPECT_FALSE(usable_folder("/proc/chorus")) << "even root cannot make it";
  EXPECT_TRUE(usable_folder(folder.path().string()));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1)
      << "nothing is left behind beside the file";
}

TEST(FreeToListen, SeesWhoIsThereAlready) {
  http::ServerConfig config;
  http::Server server(config, std::make_shared<http::Router>());
  ASSERT_TRUE(server.start());
  config.port = server.port();
  const auto taken = free_to_listen(config);
  ASSERT_FALSE(taken);
  EXPECT_THAT(to_string(taken.error()), HasSubstr("http.port"));
  server.stop();
  EXPECT_TRUE(free_to_listen(config));
  config.address = "203.0.113.1";
  EXPECT_FALSE(free_to_listen(config)) << "no address of this host";
}

TEST(Concerns, ACertificateThatIsNotGoodNowIsNamed) {
  using std::chrono::days;
  const auto today = std::chrono::floor<days>(std::chrono::system_clock::now());
  const tls::Validity week{today - days(7), today};
  const auto authority = tls::new_authority("test", {today - days(30), today + days(30)});
  const auto issued = tls::new_certificate(*authority, {"sensor-1.local"}, week);
  http::ServerConfig config;
  EXPECT_FALSE(certificate_concern(config, today)) << "no TLS";
  config.identity = tls::Identity::of(issued->certificate, issued->key).value();
  EXPECT_FALSE(certificate_concern(config, today - days(1)));
  EXPECT_THAT(certificate_concern(config, today + days(1)).value_or(""),
              HasSubstr("has expired on " + tls::date_text(today)));
  EXPECT_THAT(certificate_concern(config, today - days(8)).value_or(""),
              HasSubstr("clock of this host"));
}

TEST(Concerns, NameThePortTheFolderAndTheClock) {
  http::ServerConfig config;
  http::Server server(config, std::make_shared<http::Router>());
  ASSERT_TRUE(server.start());
  config.port = server.port();
  RecordingConfig recording;
  const chorus::testing::TemporaryFolder folder;
  recording.folder = (folder.write("file", "in the way") / "below").string();
  const Concerns all = common_concerns(config, recording);
  EXPECT_THAT(all, Contains(HasSubstr("http.port")));
  EXPECT_THAT(all, Contains(HasSubstr("nothing can be recorded: " + recording.folder)));
  NtpStatus clock;
  EXPECT_THAT(clock_concern(clock).value_or(""), HasSubstr("chrony"));
  clock.synchronised = true;
  EXPECT_FALSE(clock_concern(clock));
}

}  // namespace
}  // namespace chorus::service
