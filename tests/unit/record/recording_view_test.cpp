#include "common/record/recording_view.h"

#include <limits>
#include <random>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/record/recording.h"
#include "tests/support/temporary_folder.h"

namespace chorus::record {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;

constexpr Timestamp kBegins{std::chrono::seconds(1'700'000'000)};

/// Ten seconds at 10 Hz: a sensor's and the fused frames; places at 0 and 6 s, a floor at 0 s.
class Recorded : public ::testing::Test {
 protected:
  void SetUp() override {
    auto writer = RecordingWriter::create(path());
    ASSERT_TRUE(writer);
    const auto raw = writer->add_channel({"/sensors/s1/frame", "chorus.Frame", "{}"});
    const auto fused = writer->add_channel({"/frame", "chorus.Frame", "{}"});
    const auto places = writer->add_channel({"/registration", "chorus.Registration", "{}"});
    const auto floor = writer->add_channel({"/sensors/s1/floor-plane", "chorus.FloorPlane", "{}"});
    ASSERT_TRUE(writer->write_metadata("chorus", {{"title", "a cell"}}));
    const auto put = [&](std::uint16_t channel, double at, const std::string& text) {
      const Timestamp when = kBegins + from_seconds(at);
      ASSERT_TRUE(writer->write(channel, {"", 0, when, when, text}));
    };
    put(*places, 0.0, R"({"version": 1})");
    put(*floor, 0.0, R"({"floor": 1})");
    for (int i = 0; i <= 100; ++i) {
      const double at = 0.1 * i;
      if (i == 60) put(*places, at, R"({"version": 2})");
      put(*raw, at, json{{"raw", i}}.dump());
      put(*fused, at, json{{"fused", i}}.dump());
    }
    ASSERT_TRUE(writer->close());
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "cell.mcap"; }
  [[nodiscard]] RecordingView view() const { return std::move(*RecordingView::open({path()})); }

  testing::TemporaryFolder folder_;
};

TEST_F(Recorded, TheOutlineSaysWhatThereIs) {
  const json out = json::parse(view().outline());
  EXPECT_NEAR(out.at("seconds").get<double>(), 10.0, 1e-6);
  EXPECT_THAT(out.at("sensors"), ElementsAre("s1"));
  EXPECT_TRUE(out.at("fused").get<bool>());
  const json& places = out.at("registrations");
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].at("registration").at("version"), 1);
  EXPECT_NEAR(places[0].at("seconds").get<double>(), 0.0, 1e-6);
  EXPECT_EQ(places[1].at("registration").at("version"), 2);
  EXPECT_NEAR(places[1].at("seconds").get<double>(), 6.0, 1e-6);
  EXPECT_FALSE(out.contains("single"));
}

TEST_F(Recorded, AStretchHoldsWhatLiesBetweenAndNoMore) {
  RecordingView shown = view();
  const json out = json::parse(*shown.stretch({5.95, 6.2, 0.0}));
  std::vector<std::string> said;
  for (const json& each : out.at("messages"))
    said.push_back(each.at("topic").get<std::string>() + each.at("message").dump());
  EXPECT_THAT(said, ElementsAre("/registration{\"version\":2}", "/sensors/s1/frame{\"raw\":60}",
                                "/frame{\"fused\":60}", "/sensors/s1/frame{\"raw\":61}",
                                "/frame{\"fused\":61}", "/sensors/s1/frame{\"raw\":62}",
                                "/frame{\"fused\":62}"));
  EXPECT_EQ(json::parse(*shown.stretch({1.0, 3.0, 0.5})).at("messages").size(), 10u)
      << "thinned: five instants of two streams";
  EXPECT_EQ(json::parse(*shown.stretch({0.0, 0.05, 0.0})).at("messages").size(), 3u)
      << "backwards, and nothing but frames and places";
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const Stretch& bad :
       {Stretch{3.0, 2.0}, Stretch{0.0, 60.0}, Stretch{0.0, 1.0, -1.0}, Stretch{std::nan(""), 1.0},
        Stretch{kInfinite, kInfinite}, Stretch{0.0, 1.0, kInfinite}})
    EXPECT_FALSE(shown.stretch(bad));
}

TEST_F(Recorded, InstantsOutsideTheRecordingMeanItsEnds) {
  RecordingView shown = view();
  for (const double far : {1e18, 1e300}) {
    const json end = json::parse(*shown.stretch({far, far, far}));
    EXPECT_EQ(end.at("from"), shown.length());
    EXPECT_EQ(end.at("to"), shown.length());
    EXPECT_EQ(end.at("messages").size(), 2u) << "both frames of the last instant";
    EXPECT_EQ(json::parse(*shown.stretch({-far, -far})).at("to"), 0.0);
    EXPECT_EQ(shown.frame_at(far).error().code, ErrorCode::NotFound);
    EXPECT_EQ(shown.frame_at(-far).error().code, ErrorCode::NotFound);
  }
}

/// Writes the messages of one topic, at instants [s] since kBegins.
void record_frames(const std::filesystem::path& path, const std::string& title,
                   const std::vector<std::pair<double, std::string>>& messages) {
  auto writer = RecordingWriter::create(path);
  ASSERT_TRUE(writer);
  const auto channel = writer->add_channel({"/frame", "chorus.Frame", "{}"});
  ASSERT_TRUE(writer->write_metadata("chorus", {{"title", title}}));
  for (const auto& [at, text] : messages) {
    const Timestamp when = kBegins + from_seconds(at);
    ASSERT_TRUE(writer->write(*channel, {"", 0, when, when, text}));
  }
  ASSERT_TRUE(writer->close());
}

TEST(RecordingView, AStretchThatIsCutGoesOnWhereItEnded) {
  const testing::TemporaryFolder folder;
  std::vector<std::pair<double, std::string>> messages;
  constexpr int kMany = 10;
  std::mt19937 random(1);
  std::string much(300'000, ' ');  // Too much sameness would be refused as a bomb.
  for (char& c : much) c = static_cast<char>('a' + random() % 26);
  for (int i = 0; i < kMany; ++i)  // Two of each instant; the end is no short decimal.
    messages.emplace_back(i / 2 * 0.300012345, json{{"i", i}, {"much", much}}.dump());
  record_frames(folder / "much.mcap", "much", messages);
  auto view = RecordingView::open({folder / "much.mcap"});
  ASSERT_TRUE(view);
  std::set<int> seen;
  double from = 0.0;
  int asked = 0;
  for (; from < view->length() && asked < kMany; ++asked) {
    const std::string text = *view->stretch({from, view->length()});
    EXPECT_LT(text.size(), kMostStretch + 700'000);
    const json out = json::parse(text);
    EXPECT_EQ(out.at("from").get<double>(), from);
    for (const json& each : out.at("messages")) seen.insert(each.at("message").at("i").get<int>());
    ASSERT_GT(out.at("to").get<double>(), from);
    from = out.at("to").get<double>();
  }
  EXPECT_EQ(from, view->length());
  EXPECT_EQ(seen.size(), std::size_t{kMany});
  EXPECT_GT(asked, 1);
}

TEST(RecordingView, ACutStatesWhatIsToBeSaidOfThePartInWhichItBegins) {
  const testing::TemporaryFolder folder;
  record_frames(folder / "1.mcap", "the first part", {{0.0, "{}"}, {1.0, "{}"}});
  record_frames(folder / "2.mcap", "the second part", {{2.0, "{}"}, {3.0, "{}"}});
  const Cut cut{kBegins + from_seconds(1.5), kBegins + from_seconds(3.0)};
  const auto out = folder / "cut.mcap";
  EXPECT_EQ(cut_recording({folder / "1.mcap", folder / "2.mcap"}, cut, out).value(), 2u);
  const std::string bytes = testing::bytes_of(out);
  EXPECT_THAT(bytes, ::testing::HasSubstr("the second part"));
  EXPECT_THAT(bytes, ::testing::Not(::testing::HasSubstr("the first part")));
}

TEST_F(Recorded, ACutEndsWhenItIsStoppedOrTheDiskIsFull) {
  const auto out = folder_.path() / "cut.mcap";
  Cut cut{kBegins, kBegins + from_seconds(8.0)};
  std::stop_source stop;
  stop.request_stop();
  const auto stopped = cut_recording({path()}, cut, out, stop.get_token());
  EXPECT_EQ(stopped.error().code, ErrorCode::Unavailable);
  EXPECT_FALSE(std::filesystem::exists(out));
  cut.min_free_bytes = std::numeric_limits<std::uintmax_t>::max();
  const auto full = cut_recording({path()}, cut, out);
  EXPECT_THAT(to_string(full.error()), ::testing::HasSubstr("min_free_mb"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(Recorded, AFrameIsTheLastOneAtTheInstant) {
  RecordingView shown = view();
  EXPECT_EQ(json::parse(*shown.frame_at(4.27)).at("fused"), 42);
  EXPECT_EQ(json::parse(*shown.frame_at(0.0)).at("fused"), 0);
  EXPECT_EQ(shown.frame_at(12.0).error().code, ErrorCode::NotFound);
  EXPECT_FALSE(shown.frame_at(std::nan("")));
}

TEST_F(Recorded, ACutIsARecordingThatKnowsWhatHeldBefore) {
  const auto out = folder_.path() / "cut.mcap";
  const Cut cut{kBegins + from_seconds(7.0), kBegins + from_seconds(8.0)};
  EXPECT_EQ(cut_recording({path()}, cut, out).value(), 22u);
  const auto cell = read_recording(out);
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->messages.front().log_time, cut.from);
  std::map<std::string, std::vector<std::string>> by_topic;
  for (const Message& message : cell->messages) by_topic[message.topic].push_back(message.data);
  EXPECT_THAT(by_topic["/registration"], ElementsAre(R"({"version": 2})"));
  EXPECT_EQ(by_topic["/sensors/s1/floor-plane"].size(), 1u);
  EXPECT_EQ(by_topic["/frame"].size(), 11u);
  EXPECT_EQ(cell->metadata.at("chorus").at("title"), "a cell");
  EXPECT_EQ(cut_recording({path()}, cut, out).error().code, ErrorCode::Conflict);
  const Cut later{kBegins + from_seconds(70.0), kBegins + from_seconds(80.0)};
  EXPECT_EQ(cut_recording({path()}, later, folder_.path() / "none.mcap").error().code,
            ErrorCode::NotFound);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "none.mcap"));
}

TEST_F(Recorded, ATornTailAndNonsenseAreToldApart) {
  const auto torn = folder_.path() / "torn.mcap";
  std::filesystem::copy(path(), torn);
  std::filesystem::resize_file(torn, std::filesystem::file_size(torn) / 2);
  auto shown = RecordingView::open({torn});
  ASSERT_TRUE(shown);
  EXPECT_FALSE(json::parse(shown->outline()).at("notes").empty());
  EXPECT_FALSE(RecordingView::open({folder_.write("zeros.mcap", std::string(4096, '\0'))}));
  EXPECT_FALSE(RecordingView::open({}));
}

}  // namespace
}  // namespace chorus::record
