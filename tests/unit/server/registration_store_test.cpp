// The stored registration: available after a restart, never half written.
#include "fusion-server/server/registration_store.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <future>

#include <gtest/gtest.h>

#include "fusion-server/server/initial_registration.h"
#include "fusion-server/server/state_keeper.h"
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

TEST_F(Store, KeepsTheOneBeforeForAnUndo) {
  const RegistrationStore store(folder_.string());
  EXPECT_FALSE(store.load_earlier());
  ASSERT_TRUE(store.save(registration(2), registration(1)));
  EXPECT_EQ((*store.load())->version, 2u);
  ASSERT_TRUE(store.load_earlier());
  EXPECT_EQ(store.load_earlier()->version, 1u);
  std::ofstream(store.path() + ".old") << "{\"half\": ";
  EXPECT_FALSE(store.load_earlier()) << "no reason to refuse the one in use";
  EXPECT_FALSE(RegistrationStore("").load_earlier());
}

TEST_F(Store, IdsOfPeopleBeginAtOneOnlyWhereNobodyHasBeen) {
  const RegistrationStore store(folder_.string());
  EXPECT_EQ(*store.load_next_person(), 1u);
  ASSERT_TRUE(store.save_next_person(4711));
  EXPECT_EQ(*store.load_next_person(), 4711u);
  for (const char* wrong : {"", "[]", "{", R"({"nextPerson": -3})", R"({"nextPerson": "7"})",
                            R"({"nextPerson": 18446744073709551615})", "{}"}) {
    std::ofstream(folder_ / "people.json") << wrong;
    EXPECT_FALSE(store.load_next_person()) << wrong;
  }
  EXPECT_EQ(*RegistrationStore("").load_next_person(), 1u);
}

TEST_F(Store, TheKeeperTellsWhatFailedUntilSomethingSucceeds) {
  ::testing::internal::CaptureStderr();
  std::ofstream(folder_.string()) << "a file where the folder should be";
  StateKeeper keeper(RegistrationStore(folder_.string()), "");
  EXPECT_TRUE(keeper.status().trouble.empty());
  Worker worker;
  // Once this returns, all jobs that were posted before have been done.
  const auto settle = [&worker] {
    std::promise<void> done;
    worker.post([&done] { done.set_value(); });
    done.get_future().wait();
  };
  keeper.keep(worker, registration(1));
  settle();
  EXPECT_NE(keeper.status().trouble.find(folder_.string()), std::string::npos);
  fs::remove(folder_);
  keeper.people(worker, 7);
  settle();
  EXPECT_GT(*RegistrationStore(folder_.string()).load_next_person(), 7u + 50u);
  EXPECT_FALSE(keeper.status().trouble.empty()) << "the registration is still not stored";
  keeper.keep(worker, registration(1));
  settle();
  EXPECT_EQ(keeper.status().trouble, "");
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("state not stored"), std::string::npos);
}

TEST_F(Store, TheKeeperSaysWhenARegistrationIsYetToBeWritten) {
  StateKeeper keeper(RegistrationStore(folder_.string()), "", "it was cut off");
  Worker worker;
  std::promise<void> go_on;
  worker.post([&go_on] { go_on.get_future().wait(); });
  EXPECT_FALSE(keeper.status().writing);
  keeper.people(worker, 7);
  EXPECT_FALSE(keeper.status().writing);
  keeper.keep(worker, registration(1));
  EXPECT_TRUE(keeper.status().writing);
  EXPECT_EQ(keeper.status().damage, "it was cut off");
  std::promise<void> done;
  worker.post([&done] { done.set_value(); });
  go_on.set_value();
  done.get_future().wait();
  EXPECT_FALSE(keeper.status().writing);
  EXPECT_EQ(keeper.status().damage, "") << "a good file has replaced it";
}

TEST_F(Store, ADamagedFileIsKeptAsideAndTheOneBeforeIsUsed) {
  ::testing::internal::CaptureStderr();
  const RegistrationStore store(folder_.string());
  ASSERT_TRUE(store.save(registration(2), registration(1)));
  write("{\"sensors\": ");
  const auto found = initial_registration({}, store);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->registration.version, 1u);
  EXPECT_NE(found->damage.find("registration.json.damaged"), std::string::npos) << found->damage;
  EXPECT_TRUE(fs::exists(store.path() + ".damaged"));
  EXPECT_EQ((*store.load())->version, 1u) << "the next start finds it, too";
  write("[]");
  const auto none = initial_registration({}, store);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->registration.sensors.empty());
  EXPECT_NE(none->damage.find("have to be registered anew"), std::string::npos) << none->damage;
  EXPECT_TRUE(fs::exists(store.path() + ".damaged-2")) << "the first is still there";
  EXPECT_FALSE(store.load()->has_value());
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("stored registration damaged"),
            std::string::npos);
}

TEST_F(Store, AMissingFileOfGivenExtrinsicsIsAnError) {
  FusionSettings settings;
  settings.at_start.registration_file = "nowhere.json";
  const auto refused = initial_registration(settings, RegistrationStore(folder_.string()));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().context, "registration.file");

  EXPECT_EQ(load_registration_file((folder_ / "nowhere.json").string()).error().code,
            ErrorCode::Io);
}

}  // namespace
}  // namespace chorus::server
