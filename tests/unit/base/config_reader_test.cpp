#include "common/base/config_reader.h"

#include <limits>

#include "common/base/units.h"
#include "tests/support/matchers.h"

namespace chorus {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::FailsWith;
using ::testing::HasSubstr;
using testing::IsOk;
using ::testing::Not;

ConfigReader reader_of(std::string_view text) {
  auto reader = ConfigReader::parse(text, "test.json");
  if (!reader) ADD_FAILURE() << to_string(reader.error());
  return reader ? *reader : *ConfigReader::parse("{}", "test.json");
}

std::string complaint_of(const ConfigReader& reader) {
  const auto verdict = reader.finish();
  return verdict ? "" : to_string(verdict.error());
}

TEST(ConfigText, ReadsEveryKindOfValueAndComments) {
  auto root = reader_of(R"({
    // a comment
    "flag": true, "port": 8081, "distance_m": 2.5, "name": "left", /* another */
    "position_m": [0, 1.5, -2], "tags": ["x", "y"], "gap_ms": 50.5, "hold_s": 2, "angle_deg": 25,
    "kind": "replay"})");
  bool flag = false;
  int port = 0;
  double distance = 0;
  std::string name;
  std::vector<double> position;
  std::vector<std::string> tags;
  Duration gap{};
  Duration hold{};
  double angle = 0;
  std::size_t kind = 0;
  root.read("flag", flag);
  root.read("port", port, 1, 65535);
  root.read("distance_m", distance, 0, 10);
  root.read("name", name);
  root.read("position_m", position);
  root.read("tags", tags);
  root.read_ms("gap_ms", gap, 0ms, 1s);
  root.read_s("hold_s", hold, 0s, 10s);
  root.read_deg("angle_deg", angle, 0, 90);
  root.read_choice("kind", kind, {"simulated", "replay"});
  EXPECT_THAT(root.finish(), IsOk());
  EXPECT_TRUE(flag);
  EXPECT_EQ(port, 8081);
  EXPECT_EQ(distance, 2.5);
  EXPECT_EQ(name, "left");
  EXPECT_THAT(position, ElementsAre(0, 1.5, -2));
  EXPECT_THAT(tags, ElementsAre("x", "y"));
  EXPECT_EQ(gap, 50'500us);
  EXPECT_EQ(hold, 2s);
  EXPECT_DOUBLE_EQ(angle, deg(25));
  EXPECT_EQ(kind, 1u);
}

TEST(ConfigText, AbsentKeysLeaveTheDefaults) {
  auto root = reader_of("{}");
  int port = 8080;
  Duration gap = 40ms;
  double angle = 0.1;
  std::size_t kind = 1;
  root.read("port", port, 1, 65535);
  root.read_ms("gap_ms", gap, 0ms, 1s);
  root.read_deg("angle_deg", angle, 0, 90);
  root.read_choice("kind", kind, {"a", "b"});
  auto quality = root.child("quality");
  quality.read("port", port, 1, 2);
  EXPECT_TRUE(root.items("sensors").empty());
  EXPECT_FALSE(root.has("port"));
  EXPECT_THAT(root.finish(), IsOk());
  EXPECT_EQ(port, 8080);
  EXPECT_EQ(gap, 40ms);
  EXPECT_EQ(angle, 0.1);
  EXPECT_EQ(kind, 1u);
}

TEST(ConfigMistakes, UnknownKeysAreNamedWithPathAndNearestKey) {
  auto root =
      reader_of(R"({"prot": 1, "quality": {"best_distence_m": 2}, "sensors": [{}, {"urll": ""}],
                            "entirely_different": 0})");
  int port = 0;
  double best = 0;
  std::string url;
  root.read("port", port, 1, 65535);
  auto quality = root.child("quality");
  quality.read("best_distance_m", best, 0, 10);
  for (ConfigReader& sensor : root.items("sensors")) sensor.read("url", url);
  EXPECT_THAT(root.finish(), FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(
      complaint_of(root),
      AllOf(HasSubstr("test.json"), HasSubstr("prot: unknown key; did you mean 'port'?"),
            HasSubstr("quality.best_distence_m: unknown key; did you mean 'best_distance_m'?"),
            HasSubstr("sensors.1.urll: unknown key; did you mean 'url'?"),
            HasSubstr("entirely_different: unknown key"),
            Not(HasSubstr("entirely_different: unknown key;"))));
}

TEST(ConfigMistakes, NoMessageShowsAToken) {
  const std::string secret = "9123456789012";
  for (const std::string& text :
       {R"({"bearer_token": )" + secret + "}", R"({"tokens": [")" + secret + "\"]}",
        R"({"sensors": {"id": "s1", "token": ")" + secret + "\"}}"}) {
    auto root = reader_of(text);
    std::string token;
    root.read("bearer_token", token);
    EXPECT_TRUE(root.items("tokens").empty());
    EXPECT_TRUE(root.items("sensors").empty());
    EXPECT_THAT(complaint_of(root), AllOf(HasSubstr("must be"), Not(HasSubstr(secret)))) << text;
  }
  const auto cut = ConfigReader::parse(R"({"token": ")" + secret + ", \"x\": 1}", "test.json");
  ASSERT_FALSE(cut);
  EXPECT_THAT(to_string(cut.error()), AllOf(HasSubstr("line 1"), Not(HasSubstr(secret))));
  auto root = reader_of("{}");
  const auto set = root.set("http.bearer_token=\"" + secret);
  ASSERT_FALSE(set);
  EXPECT_THAT(to_string(set.error()),
              AllOf(HasSubstr("http.bearer_token"), Not(HasSubstr(secret))));
}

TEST(ConfigMistakes, WrongTypesAndRangesAreAllReportedAndLeaveTheDefaults) {
  auto root = reader_of(
      R"({"flag": 1, "port": 70000, "whole": 1.5, "huge": 1e300, "big": 18446744073709551615,
      "name": 3, "position_m": [1, "2"], "tags": "x", "gap_ms": -1, "kind": "other", "quality": 3,
      "sensors": [1], "list": {}})");
  bool flag = false;
  int number = 42;
  double real = 4.2;
  std::string name = "n";
  std::vector<double> position{7};
  std::vector<std::string> tags{"t"};
  Duration gap = 5ms;
  std::size_t kind = 0;
  root.read("flag", flag);
  root.read("port", number, 1, 65535);
  root.read("whole", number, 0, 10);
  root.read("big", number, 0, std::numeric_limits<int>::max());
  root.read("huge", real, 0, 10);
  root.read("name", name);
  root.read("position_m", position);
  root.read("tags", tags);
  root.read_ms("gap_ms", gap, 0ms, 1s);
  root.read_choice("kind", kind, {"simulated", "replay"});
  EXPECT_FALSE(root.child("quality").has("x"));
  EXPECT_TRUE(root.items("sensors").empty());
  EXPECT_TRUE(root.items("list").empty());
  const std::string complaint = complaint_of(root);
  for (const char* key :
       {"flag: must be true or false", "port: must be from 1 to 65535, not 70000",
        "whole: must be a whole number", "big: must be from 0", "huge: must be from 0 to 10",
        "name: must be a text", "position_m: must be a list of numbers",
        "tags: must be a list of texts", "gap_ms: must be from 0 to 1000",
        "kind: must be one of simulated, replay", "quality: must be an object",
        "sensors.0: must be an object", "list: must be a list"}) {
    EXPECT_THAT(complaint, HasSubstr(key));
  }
  EXPECT_EQ(number, 42);
  EXPECT_EQ(real, 4.2);
  EXPECT_EQ(name, "n");
  EXPECT_THAT(position, ElementsAre(7));
  EXPECT_EQ(gap, 5ms);
}

TEST(ConfigMistakes, TheCallersOwnAreReportedWithTheRest) {
  auto root = reader_of(R"({"quality": {}})");
  root.child("quality").complain("reach_m", "must be below best_distance_m");
  EXPECT_THAT(complaint_of(root), HasSubstr("quality.reach_m: must be below best_distance_m"));
}

TEST(ConfigMistakes, AskingTwiceForOneChildForgetsNothing) {
  auto root = reader_of(R"({"quality": {"a": 1, "b": 2}})");
  int value = 0;
  root.child("quality").read("a", value, 0, 9);
  root.child("quality").read("b", value, 0, 9);
  EXPECT_THAT(root.finish(), IsOk());
  EXPECT_EQ(value, 2);
}

TEST(ConfigBytes, MalformedTextIsRefusedWithItsPlace) {
  for (const char* bad :
       {"", "{", "[]", "null", "{\"a\": NaN}", "{\"a\": 1,}", "{\"a\": 1e999}", "{} {}",
        "{\"a\": \"\xff\"}", "{\"a\": 1, \"b\": {\"c\": 1, \"c\": 2}}"}) {
    EXPECT_THAT(ConfigReader::parse(bad, "test.json"), FailsWith(ErrorCode::Malformed)) << bad;
  }
  const auto reader = ConfigReader::parse("{\n  \"a\": oops\n}", "test.json");
  ASSERT_FALSE(reader);
  EXPECT_THAT(to_string(reader.error()), AllOf(HasSubstr("test.json"), HasSubstr("line 2")));
}

TEST(ConfigBytes, HostileTextIsRefusedCheaply) {
  const std::string deep = "{\"a\": " + std::string(20'000, '[');
  EXPECT_THAT(ConfigReader::parse(deep, "x"), FailsWith(ErrorCode::Malformed));
  const std::string large = "{\"a\": \"" + std::string(2'000'000, 'x') + "\"}";
  EXPECT_THAT(ConfigReader::parse(large, "x"), FailsWith(ErrorCode::TooLarge));
}

TEST(ConfigSet, ReplacesAndCreatesValuesByPath) {
  auto root = reader_of(R"({"port": 1, "sensors": [{"port": 1}]})");
  ASSERT_THAT(root.set("port=8082"), IsOk());
  ASSERT_THAT(root.set("sensors.0.port=8083"), IsOk());
  ASSERT_THAT(root.set("sensors.1.port=8084"), IsOk());
  ASSERT_THAT(root.set("http.bind=127.0.0.1"), IsOk());
  ASSERT_THAT(root.set("position_m=[1, 2]"), IsOk());
  ASSERT_THAT(root.set("note=a=b"), IsOk());
  ASSERT_THAT(root.set("empty="), IsOk());
  int port = 0;
  root.read("port", port, 1, 65535);
  EXPECT_EQ(port, 8082);
  auto sensors = root.items("sensors");
  ASSERT_EQ(sensors.size(), 2u);
  sensors[0].read("port", port, 1, 65535);
  EXPECT_EQ(port, 8083);
  sensors[1].read("port", port, 1, 65535);
  EXPECT_EQ(port, 8084);
  std::string text;
  root.child("http").read("bind", text);
  EXPECT_EQ(text, "127.0.0.1");
  std::vector<double> position;
  root.read("position_m", position);
  EXPECT_THAT(position, ElementsAre(1, 2));
  root.read("note", text);
  EXPECT_EQ(text, "a=b");
  root.read("empty", text);
  EXPECT_EQ(text, "");
  EXPECT_THAT(root.finish(), IsOk());
}

TEST(ConfigSet, RefusesWhatNamesNoPlace) {
  auto root = reader_of(R"({"port": 1, "sensors": [{}]})");
  for (const char* bad : {"port", "=1", "", "port.x=1", "sensors.7.port=1", "sensors.x=1", "a..b=1",
                          ".=1", "list.5=1"}) {
    EXPECT_THAT(root.set(bad), FailsWith(ErrorCode::InvalidArgument)) << bad;
  }
  EXPECT_THAT(root.set("a=[1,"), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(root.set("a=" + std::string(100, '[')), FailsWith(ErrorCode::Malformed));
  std::string deep = "a";
  for (int i = 0; i < 100; ++i) deep += ".a";
  EXPECT_THAT(root.set(deep + "=1"), FailsWith(ErrorCode::InvalidArgument));
}

TEST(ConfigSet, MistakesInAssignmentsAreFoundLikeThoseInTheFile) {
  auto root = reader_of("{}");
  ASSERT_THAT(root.set("prot=1"), IsOk());
  int port = 0;
  root.read("port", port, 1, 65535);
  EXPECT_THAT(complaint_of(root), HasSubstr("did you mean 'port'?"));
}

}  // namespace
}  // namespace chorus
