// The stored registration: there after a restart, never half written.
#include "fusion-server/server/registration_store.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::server {
namespace {

namespace fs = std::filesystem;

class Store : public ::testing::Test {
 protected:
  Store() : folder_(fs::temp_directory_path() / ("chorus-store-" + std::to_string(::getpid()))) {
    fs::remove_all(folder_);
  }
  ~Store() override { fs::remove_all(folder_); }

  static Registration registration(std::uint64_t version) {
    Registration r;
    r.version = version;
    r.verdict = Verdict::Good;
    r.master = testing::sensor_id("s1");
    r.sensors[r.master].world_from_sensor = testing::ring_sensor(1, 6);
    return r;
  }
  void write(const std::string& text) const {
    std::ofstream(folder_ / "registration.json") << text;
  }

  fs::path folder_;
};

TEST_F(Store, KeepsWhatIsSaved) {
  const RegistrationStore store((folder_ / "deep" / "er").string());
  EXPECT_FALSE(store.load()->has_value());
  ASSERT_TRUE(store.save(registration(1)));
  ASSERT_TRUE(store.save(registration(2)));
  const auto loaded = store.load();
  ASSERT_TRUE(loaded);
  EXPECT_EQ((*loaded)->version, 2u);
  EXPECT_FALSE(fs::exists(store.path() + ".partial"));
}

TEST_F(Store, AnEmptyFolderNameKeepsNothingAndFailsNothing) {
  const RegistrationStore store("");
  EXPECT_TRUE(store.save(registration(1)));
  EXPECT_FALSE(store.load()->has_value());
  EXPECT_TRUE(store.forget());
}

TEST_F(Store, ACorruptFileIsAnErrorThatNamesItAndStays) {
  const RegistrationStore store(folder_.string());
  fs::create_directories(folder_);
  write("{\"sensors\": ");
  const auto loaded = store.load();
  ASSERT_FALSE(loaded);
  EXPECT_EQ(loaded.error().context, store.path());
  EXPECT_TRUE(fs::exists(store.path()));
}

TEST_F(Store, ACrashBetweenWritingAndRenamingLeavesTheOldOne) {
  const RegistrationStore store(folder_.string());
  ASSERT_TRUE(store.save(registration(1)));
  std::ofstream(store.path() + ".partial") << "{\"half\": ";
  EXPECT_EQ((*store.load())->version, 1u);
  ASSERT_TRUE(store.save(registration(2)));
  EXPECT_EQ((*store.load())->version, 2u);
}

TEST_F(Store, AFolderThatCannotBeWrittenIsAnErrorAndNotACrash) {
  std::ofstream(folder_.string()) << "a file where the folder should be";
  const RegistrationStore store(folder_.string());
  EXPECT_FALSE(store.save(registration(1)));
  fs::remove(folder_);
}

TEST_F(Store, ForgettingMovesItAside) {
  const RegistrationStore store(folder_.string());
  ASSERT_TRUE(store.save(registration(1)));
  ASSERT_TRUE(store.forget());
  EXPECT_FALSE(store.load()->has_value());
  EXPECT_TRUE(fs::exists(store.path() + ".old"));
  EXPECT_TRUE(store.forget());
}

TEST_F(Store, AMissingFileOfGivenExtrinsicsIsAnError) {
  EXPECT_EQ(load_registration_file((folder_ / "nowhere.json").string()).error().code,
            ErrorCode::Io);
}

}  // namespace
}  // namespace chorus::server
