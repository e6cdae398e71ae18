#include "services/ctl/line/new_file.h"

#include <sys/stat.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using fs::perms;

/// Sets the umask of the process while the object exists.
class Umask {
 public:
  explicit Umask(mode_t mask) : before_(::umask(mask)) {}
  ~Umask() { ::umask(before_); }
  Umask(const Umask&) = delete;
  Umask& operator=(const Umask&) = delete;

 private:
  mode_t before_;
};

perms mode_of(const fs::path& path) { return fs::status(path).permissions(); }

TEST(MakeFolder, MakesItAndItsParentsForItsReaders) {
  const chorus::testing::TemporaryFolder folder;
  for (const char* name : {"a/own", "b/own/", "c/own//"}) {
    const auto made = folder / name;
    EXPECT_THAT(make_folder(made.string(), Readers::Owner), chorus::testing::IsOk()) << name;
    EXPECT_EQ(mode_of(made), perms::owner_all) << name;
    EXPECT_THAT(make_folder(made.string(), Readers::Owner), chorus::testing::IsOk()) << "again";
  }
}

TEST(MakeFolder, OthersMayPassThroughOneForTheServicesButNotLookAround) {
  const chorus::testing::TemporaryFolder folder;
  const auto made = folder / "tls/";
  ASSERT_THAT(make_folder(made.string(), Readers::Services), chorus::testing::IsOk());
  EXPECT_EQ(mode_of(made),
            perms::owner_all | perms::group_read | perms::group_exec | perms::others_exec);
}

TEST(NewFiles, HaveTheModeOfTheirReadersWhateverTheUmask) {
  const chorus::testing::TemporaryFolder folder;
  const auto at = [&](const char* name) { return (folder / name).string(); };
  const Umask closed(077);
  ASSERT_THAT(make_folder(at("tls"), Readers::Services), chorus::testing::IsOk());
  ASSERT_THAT(write_file(at("ca.crt"), "", Readers::Everybody), chorus::testing::IsOk());
  ASSERT_THAT(write_file(at("sensor.json"), "", Readers::Services), chorus::testing::IsOk());
  ASSERT_THAT(write_file(at("ca.key"), "", Readers::Owner), chorus::testing::IsOk());
  EXPECT_EQ(mode_of(at("tls")), perms{0751});
  EXPECT_EQ(mode_of(at("ca.crt")), perms{0644});
  EXPECT_EQ(mode_of(at("sensor.json")), perms{0640});
  EXPECT_EQ(mode_of(at("ca.key")), perms{0600});
}

std::string refused(const Result<void>& written) {
  return written ? "it was written" : to_string(written.error());
}

TEST(NewFiles, NeverTakeThePlaceOfAnother) {
  const chorus::testing::TemporaryFolder folder;
  const std::string file = folder.write("sensor.json", "edited by hand").string();
  EXPECT_THAT(refused(write_file(file, "new", Readers::Services)),
              ::testing::HasSubstr("exists and is not overwritten: edit it, move it away"));
  EXPECT_EQ(chorus::testing::bytes_of(file), "edited by hand");
}

TEST(NewFiles, AreReplacedAsAWholeWhereThatIsAskedFor) {
  const chorus::testing::TemporaryFolder folder;
  const std::string file = folder.write("host.crt", "an older and longer one").string();
  (void)folder.write("host.crt.new", "left by a run that was cut off");
  ASSERT_THAT(write_file(file, "new", Readers::Everybody, Overwriting::Yes),
              chorus::testing::IsOk());
  EXPECT_EQ(chorus::testing::bytes_of(file), "new");
  EXPECT_FALSE(fs::exists(folder / "host.crt.new"));
}

TEST(NewFiles, SayWhatIsMissing) {
  const chorus::testing::TemporaryFolder folder;
  const std::string nowhere = (folder / "none/sensor.json").string();
  EXPECT_THAT(refused(write_file(nowhere, "x", Readers::Services)),
              ::testing::HasSubstr("its folder is not there; make it, or give --out FILE"));
  const std::string below = folder.write("file", "x").string() + "/tls";
  EXPECT_THAT(refused(make_folder(below, Readers::Owner)),
              ::testing::HasSubstr("with --out FOLDER"));
}

TEST(NewFiles, OnStandardOutputAreNoFiles) {
  ::testing::internal::CaptureStdout();
  ASSERT_THAT(write_file("-", "{}\n", Readers::Owner), chorus::testing::IsOk());
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "{}\n");
  EXPECT_FALSE(fs::exists("-"));
}

}  // namespace
}  // namespace chorus::ctl
