#include "fusion-server/server/sensor_changes.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fusion-server/server/sensor_desk.h"
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
            [this] { ++changed; }};
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

TEST(SensorDesk, AFileThatCannotBeReadIsNotWrittenOver) {
  Desk rig;
  rig.folder.write("sensors.json", "{ nonsense");
  SensorDesk desk(rig.options());
  EXPECT_EQ(desk.followed(rig.configured).size(), 1u);
  const auto refused = desk.control().add({a_service("s2", 8082)});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("mend or delete it"));
}

}  // namespace
}  // namespace chorus::server
