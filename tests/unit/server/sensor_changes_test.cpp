#include "fusion-server/server/sensor_changes.h"

#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fusion-server/server/sensor_desk.h"
#include "tests/support/free_port.h"
#include "tests/support/temporary_folder.h"

namespace chorus::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

client::FollowedService a_service(const std::string& id, int port) {
  return {*SensorId::parse(id), "http://127.0.0.1:" + std::to_string(port) + "/", "secret", {}};
}
SensorId named(const char* id) { return *SensorId::parse(id); }

TEST(SensorChanges, AreReadAsTheyWereWritten) {
  SensorChanges changes{{a_service("s2", 8082)}, {named("s1")}};
  EXPECT_EQ(read_sensor_changes(text_of(changes, Tokens::Written)).value(), changes);
  EXPECT_THAT(text_of(changes, Tokens::Hidden), HasSubstr("(hidden)"));
  EXPECT_THAT(text_of(changes, Tokens::Hidden), Not(HasSubstr("secret")));
  EXPECT_FALSE(read_sensor_changes(R"({"sensors": [{"id": "a b", "url": "http://h/"}]})"));
  EXPECT_FALSE(read_sensor_changes(R"({"sensor": []})"));
  EXPECT_FALSE(read_sensor_changes("nonsense"));
}

TEST(SensorChanges, NobodyTakesAnIdOrAnAddressThatIsTaken) {
  const Services configured{a_service("s1", 8081)};
  const auto first = with_sensors({}, configured, {a_service("s2", 8082)});
  ASSERT_TRUE(first);
  EXPECT_EQ(followed_of(configured, *first).size(), 2u);
  for (const auto& taken : {a_service("s1", 9000), a_service("s2", 9000), a_service("s3", 8081),
                            a_service("s3", 8082)}) {
    const auto refused = with_sensors(*first, configured, {taken});
    ASSERT_FALSE(refused) << taken.id.str();
    EXPECT_EQ(refused.error().code, ErrorCode::Conflict);
  }
}

TEST(SensorChanges, TheConfigurationsSensorsCanBeSilencedButNotTakenOut) {
  const Services configured{a_service("s1", 8081)};
  const SensorChanges added = *with_sensors({}, configured, {a_service("s2", 8082)});
  EXPECT_EQ(without_sensor(added, configured, named("s1")).error().code, ErrorCode::Conflict);
  EXPECT_EQ(without_sensor(added, configured, named("s9")).error().code, ErrorCode::NotFound);
  EXPECT_EQ(*without_sensor(added, configured, named("s2")), SensorChanges{});
  const SensorChanges quiet = *with_silence(added, configured, named("s1"), true);
  ASSERT_EQ(followed_of(configured, quiet).size(), 1u);
  EXPECT_EQ(followed_of(configured, quiet).front().id, named("s2"));
  EXPECT_EQ(*with_silence(quiet, configured, named("s1"), false), added);
  EXPECT_FALSE(with_silence(added, configured, named("s9"), true));
}

struct Desk {
  testing::TemporaryFolder folder;
  int changed = 0;
  Services configured{a_service("s1", 8081)};

  [[nodiscard]] SensorDeskOptions options() {
    return {folder.path().string(), [] { return tls::Trust(); }, [this] { return configured; },
            [this] { ++changed; }, "run1"};
  }
};

TEST(SensorDesk, KeepsWhatWasAddedForTheNextStart) {
  Desk rig;
  {
    SensorDesk desk(rig.options());
    const auto control = desk.control();
    const auto preview = control.preview({a_service("s2", 8082)});
    ASSERT_TRUE(preview);
    EXPECT_FALSE(std::filesystem::exists(control.facts().file)) << "only shown";
    ASSERT_TRUE(control.add({a_service("s2", 8082)}));
    EXPECT_EQ(control.facts().text, *preview) << "what was shown is what was written";
    EXPECT_EQ(rig.changed, 1);
    EXPECT_EQ(desk.followed(rig.configured).size(), 2u);
    EXPECT_FALSE(control.add({a_service("s2", 8083)}));
    EXPECT_EQ(rig.changed, 1);
  }
  SensorDesk again(rig.options());
  EXPECT_EQ(again.followed(rig.configured).size(), 2u);
  EXPECT_EQ(again.followed(rig.configured).back().token, "secret");
}

TEST(SensorDesk, LosesNoneOfTheChangesThatAreMadeAtOnce) {
  constexpr int kEach = 12;
  Desk rig;
  SensorDeskOptions options = rig.options();
  options.changed = [] {};
  SensorDesk desk(options);
  const auto add = [control = desk.control()](int from) {
    for (int i = from; i < from + kEach; ++i)
      EXPECT_TRUE(control.add({a_service("n" + std::to_string(i), 9000 + i)}));
  };
  {
    const std::jthread one(add, 0);
    const std::jthread other(add, kEach);
  }
  EXPECT_EQ(desk.followed({}).size(), 2u * kEach);
}

TEST(SensorDesk, AFileThatCannotBeReadIsNotWrittenOver) {
  Desk rig;
  rig.folder.write("sensors.json", "{ nonsense");
  SensorDesk desk(rig.options());
  EXPECT_EQ(desk.followed(rig.configured).size(), 1u);
  const auto refused = desk.control().add({a_service("s2", 8082)});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("mend or delete it"));
}

/// Takes connections and answers nothing, until it is closed.
struct Mute {
  Mute() {
    const sockaddr_in address = testing::loopback(port);
    EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(::listen(socket, 8), 0);
  }
  ~Mute() { close(); }
  void close() { ::close(std::exchange(socket, -1)); }
  [[nodiscard]] client::FollowedService at(const std::string& path) const {
    return {named("s"), "http://127.0.0.1:" + std::to_string(port) + "/" + path, "", {}};
  }

  std::uint16_t port = testing::free_port();
  int socket = ::socket(AF_INET, SOCK_STREAM, 0);
};

bool is_done(const rest::SetupControl& control, const std::string& url) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < end) {
    const auto trials = control.facts().trials;
    if (const auto found = trials.find(url); found != trials.end() && !found->second.running)
      return true;
    std::this_thread::yield();
  }
  return false;
}

TEST(SensorDesk, TriesFewAddressesAtOnceAndEachOnce) {
  Desk rig;
  Mute mute;
  SensorDesk desk(rig.options());
  const auto control = desk.control();
  for (const char* path : {"a", "b", "c", "d"}) EXPECT_TRUE(control.attempt(mute.at(path)));
  const auto again = control.attempt(mute.at("a"));
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, ErrorCode::Conflict);
  EXPECT_THAT(again.error().message, HasSubstr("this address is being tried already"));
  const auto fifth = control.attempt(mute.at("e"));
  ASSERT_FALSE(fifth);
  EXPECT_EQ(fifth.error().code, ErrorCode::Conflict);
  EXPECT_EQ(control.facts().trials.size(), 4u);
  mute.close();
  EXPECT_TRUE(is_done(control, mute.at("d").url));
  EXPECT_TRUE(control.attempt(mute.at("a"))) << "to be tried again";
}

TEST(SensorDesk, ForgetsAnOutcomeButNoTrialThatIsUnderWay) {
  Desk rig;
  Mute mute;
  SensorDesk desk(rig.options());
  const auto control = desk.control();
  for (int i = 100; i < 131; ++i) {
    const std::string no_url = "x" + std::to_string(i);  // after http:// in the alphabet
    ASSERT_TRUE(control.attempt({named("s"), no_url, "", {}}));
    ASSERT_TRUE(is_done(control, no_url));
  }
  ASSERT_TRUE(control.attempt(mute.at("")));
  ASSERT_TRUE(control.attempt({named("s"), "y", "", {}}));
  const auto trials = control.facts().trials;
  EXPECT_EQ(trials.size(), 32u);
  EXPECT_TRUE(trials.contains(mute.at("").url));
  EXPECT_FALSE(trials.contains("x100"));
  mute.close();
}

}  // namespace
}  // namespace chorus::server
