#include "common/record/recording_view.h"

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
  EXPECT_EQ(out.at("registration").at("version"), 2) << "the last one";
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
  for (const Stretch& bad :
       {Stretch{3.0, 2.0}, Stretch{0.0, 60.0}, Stretch{0.0, 1.0, -1.0}, Stretch{std::nan(""), 1.0}})
    EXPECT_FALSE(shown.stretch(bad));
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
