#include "common/service/recording_views.h"

#include <future>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/http/route_table.h"
#include "common/record/recording.h"
#include "tests/support/temporary_folder.h"

namespace chorus::service {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// A folder with one recording of two seconds, "walk", and the routes to look at it.
class Looked : public ::testing::Test {
 protected:
  Looked() : views_(options()) {
    std::filesystem::create_directory(folder_ / "walk");
    auto writer = record::RecordingWriter::create(folder_ / "walk/walk.mcap");
    const auto frames = writer->add_channel({"/frame", "chorus.Frame", "{}"});
    for (int i = 0; i <= 20; ++i) {
      const Timestamp when{std::chrono::seconds(1'700'000'000) +
                           std::chrono::milliseconds(100 * i)};
      EXPECT_TRUE(writer->write(*frames, {"", 0, when, when, json{{"fused", i}}.dump()}));
    }
    EXPECT_TRUE(writer->close());
    views_.add_routes(router_);
  }

  [[nodiscard]] RecordingViewsOptions options() {
    RecordingViewsOptions options;
    options.files_of =
        [this](const std::string& name) -> Result<std::vector<std::filesystem::path>> {
      if (name == "walk") return std::vector{folder_ / "walk/walk.mcap"};
      if (name == "running") return fail(ErrorCode::Unavailable, name, "is being written");
      return fail(ErrorCode::NotFound, name, "there is no recording of this name");
    };
    options.folder = folder_.path();
    options.mark_running = [this](const std::string& name,
                                  const std::string& text) -> Result<std::optional<double>> {
      if (name != "running") return std::nullopt;
      said_ = text;
      return 3.25;
    };
    options.made = [this](const record::RecordingReport& report) { made_.set_value(report); };
    return options;
  }

  /// The body of the answer, or the error as text.
  [[nodiscard]] std::string ask(const std::string& path, http::Method method = http::Method::Get,
                                std::string_view body = {},
                                std::map<std::string, std::string, std::less<>> query = {}) {
    const auto match = router_.match(path);
    if (!match) return to_string(match.error());
    http::Request request;
    request.method = method;
    request.body = body;
    request.query = std::move(query);
    http::DocumentPtr document;
    if (method == http::Method::Get) {
      const auto answer = match->entry->getter(request, match->params);
      if (!answer) return to_string(answer.error());
      document = *answer;
    } else {
      const auto answer = match->entry->actions.at(method)(request, match->params);
      if (!answer) return to_string(answer.error());
      document = answer->document;
    }
    return document ? std::string((*document->choose("*/*"))->body()) : "";
  }

  testing::TemporaryFolder folder_;
  std::string said_;  ///< The text of the last mark of a running recording.
  std::promise<record::RecordingReport> made_;
  RecordingViews views_;
  http::Router router_;
};

TEST_F(Looked, SaysWhatThereIsAndShowsIt) {
  const json outline = json::parse(ask("/recordings/walk/outline"));
  EXPECT_NEAR(outline.at("seconds").get<double>(), 2.0, 1e-6);
  EXPECT_TRUE(outline.at("writable").get<bool>());
  const auto get = http::Method::Get;
  EXPECT_EQ(json::parse(ask("/recordings/walk/frame", get, "", {{"at", "1.04"}})).at("fused"), 10);
  const json stretch =
      json::parse(ask("/recordings/walk/stretch", get, "", {{"from", "0.95"}, {"to", "1.15"}}));
  EXPECT_EQ(stretch.at("messages").size(), 2u);
  EXPECT_THAT(ask("/recordings/walk/stretch"), HasSubstr("`from` and `to`"));
  EXPECT_THAT(ask("/recordings/walk/frame", get, "", {{"at", "soon"}}), HasSubstr("seconds"));
  EXPECT_THAT(ask("/recordings/none/outline"), HasSubstr("no recording of this name"));
}

TEST_F(Looked, MarksAreKeptInOrderAndTakenAway) {
  EXPECT_EQ(json::parse(ask("/recordings/walk/marks")), json::array());
  const auto mark = [&](const char* body) {
    return ask("/recordings/walk/marks", http::Method::Post, body);
  };
  (void)mark(R"({"seconds": 1.5, "text": "later"})");
  const json all = json::parse(mark(R"({"seconds": 0.5, "text": "<b>first</b>"})"));
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].at("text"), "<b>first</b>");
  EXPECT_THAT(mark(R"({"seconds": -1, "text": "x"})"), HasSubstr("0 or more"));
  EXPECT_THAT(mark(R"({"seconds": 1, "text": "two\nlines"})"), HasSubstr("one line"));
  EXPECT_THAT(mark("nonsense"), HasSubstr("JSON object"));
  const std::string id = std::to_string(all[0].at("id").get<int>());
  EXPECT_EQ(json::parse(ask("/recordings/walk/marks/" + id, http::Method::Delete)).size(), 1u);
  EXPECT_THAT(ask("/recordings/walk/marks/" + id, http::Method::Delete), HasSubstr("no such mark"));
}

TEST_F(Looked, ARunningRecordingIsMarkedAtThePresent) {
  std::filesystem::create_directory(folder_ / "running");
  const auto mark = [&](const char* name, const char* body) {
    return ask(std::string("/recordings/") + name + "/marks", http::Method::Post, body);
  };
  const json all = json::parse(mark("running", R"({"text": "takes the drill"})"));
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].at("seconds"), 3.25);
  EXPECT_EQ(said_, "takes the drill");
  EXPECT_EQ(stored_marks(folder_ / "running/marks.json")->at(0).text, "takes the drill");
  EXPECT_EQ(json::parse(ask("/recordings/running/marks")), all) << "readable while it runs";
  EXPECT_THAT(ask("/recordings/none/marks"), HasSubstr("no recording of this name"));
  EXPECT_THAT(mark("running", R"({"seconds": 1, "text": "x"})"), HasSubstr("leave `seconds` out"));
  EXPECT_THAT(mark("walk", R"({"text": "x"})"), HasSubstr("say where the mark is"));
  EXPECT_THAT(mark("none", R"({"text": "x"})"), HasSubstr("no recording of this name"));
}

TEST_F(Looked, MarksThatCannotBeReadStayAsTheyAre) {
  for (const char* text :
       {"", "[{", R"({"id": 1})", R"([{"id": 1e300, "seconds": 1, "text": "x"}])",
        R"([{"seconds": 1, "text": "x"}])", R"([{"id": 1, "seconds": -1, "text": "x"}])"}) {
    folder_.write("walk/marks.json", text);
    for (const auto& answer :
         {ask("/recordings/walk/marks"),
          ask("/recordings/walk/marks", http::Method::Post, R"({"seconds": 1, "text": "x"})"),
          ask("/recordings/walk/marks/1", http::Method::Delete)})
      EXPECT_THAT(answer, HasSubstr("mend or delete it")) << text;
    EXPECT_EQ(testing::bytes_of(folder_ / "walk/marks.json"), text);
    const json outline = json::parse(ask("/recordings/walk/outline"));
    EXPECT_THAT(outline.at("notes").dump(), HasSubstr("mend or delete it"));
    EXPECT_EQ(outline.at("marks"), json::array());
  }
  folder_.write("walk/marks.json", R"([{"id": 2147483647, "seconds": 1, "text": "the last"}])");
  EXPECT_THAT(ask("/recordings/walk/marks", http::Method::Post, R"({"seconds": 1, "text": "x"})"),
              HasSubstr("no higher `id`"));
}

TEST_F(Looked, ACutLeavesTheDiskItsFreeSpace) {
  RecordingViewsOptions scarce = options();
  scarce.min_free_bytes = std::numeric_limits<std::uintmax_t>::max();
  RecordingViews views(std::move(scarce));
  router_ = http::Router();
  views.add_routes(router_);
  EXPECT_THAT(
      ask("/recordings/walk/cut", http::Method::Post, R"({"from": 0, "to": 1, "name": "part"})"),
      HasSubstr("min_free_mb"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "part"));
}

TEST_F(Looked, ACutBecomesARecordingOfItsOwn) {
  const auto cut = [&](const char* body) {
    return ask("/recordings/walk/cut", http::Method::Post, body);
  };
  EXPECT_THAT(cut(R"({"from": 1, "to": 0.5, "name": "a"})"), HasSubstr("later"));
  EXPECT_THAT(cut(R"({"from": 0, "to": 1, "name": "../a"})"), HasSubstr("A-Z"));
  EXPECT_THAT(cut(R"({"from": 7, "to": 8, "name": "a"})"), HasSubstr("2.0 s long"));
  EXPECT_THAT(cut(R"({"from": 0, "to": 1, "name": "walk"})"), HasSubstr("of this name already"));
  EXPECT_EQ(cut(R"({"from": 1.5, "to": 1e300, "name": "part"})"), "");
  const record::RecordingReport made = made_.get_future().get();
  EXPECT_EQ(made.name, "part");
  EXPECT_EQ(made.frames, 6u);
  const auto stored = record::read_index(folder_ / "part");
  ASSERT_TRUE(stored);
  EXPECT_EQ(stored->state, record::RecordingState::Finished);
}

}  // namespace
}  // namespace chorus::service
