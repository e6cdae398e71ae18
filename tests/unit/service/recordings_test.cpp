#include "common/service/recordings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>

#include <nlohmann/json.hpp>

#include "common/http/client.h"
#include "common/http/server.h"
#include "common/record/cell_reader.h"
#include "common/record/marks.h"
#include "tests/support/temporary_folder.h"

namespace chorus::service {
namespace {

using record::RecordingState;
using Stream = Recordings::Stream;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::Pair;

RecordingsOptions options_in(const std::string& folder) {
  RecordingsOptions options;
  options.config.folder = folder;
  options.config.limits.min_free_bytes = 0;
  options.has_fused = true;
  options.serving.run = "run";
  return options;
}

record::RawFrame raw(int i) {
  auto frame = std::make_shared<resource::FrameResource>();
  frame->sequence = static_cast<std::uint64_t>(i) + 1;
  frame->captured = from_unix_ns(1'795'246'200'000'000'000) + std::chrono::milliseconds(33) * i;
  frame->source = "s1";
  return {*SensorId::parse("s1"), frame, frame->captured, {}, {}};
}

TEST(RecordingRequest, SaysWhatIsWrong) {
  const auto empty = parse_recording_request(" \n", true);
  ASSERT_TRUE(empty);
  EXPECT_TRUE(empty->raw && empty->fused && empty->name.empty());
  EXPECT_FALSE(parse_recording_request("", false)->fused) << "a sensor has none";
  const auto all =
      parse_recording_request(R"({"name":"walk-1","seconds":2.5,"raw":false,"fused":true})", true);
  ASSERT_TRUE(all) << to_string(all.error());
  EXPECT_EQ(all->name, "walk-1");
  EXPECT_EQ(all->duration, std::chrono::milliseconds(2500));
  EXPECT_FALSE(all->raw);
  for (const char* body :
       {"[]", "{", R"({"name":"../x"})", R"({"name":"-rf"})", R"({"name":5})", R"({"seconds":0})",
        R"({"seconds":"5"})", R"({"seconds":1e9})", R"({"raw":1})", R"({"nmae":"x"})",
        R"({"raw":false,"fused":false})", R"({"name":""})", R"({"name":"a.mcap"})",
        R"({"name":"a","name":"b"})", R"({"name":[[[[[[[[]]]]]]]]})"}) {
    const auto wrong = parse_recording_request(body, true);
    ASSERT_FALSE(wrong) << body;
    EXPECT_EQ(wrong.error().code, ErrorCode::InvalidArgument) << body;
  }
  EXPECT_EQ(parse_recording_request(R"({"name":5})", true).error().message, "\"name\" is a text");
  EXPECT_THAT(parse_recording_request(R"({"fused":true})", false).error().message,
              HasSubstr("no fused frames"));
}

TEST(Recordings, RunsOneAtATimeAndOnlyWhatWasAskedFor) {
  const chorus::testing::TemporaryFolder folder;
  Recordings recordings(options_in((folder / "rec").string()));
  EXPECT_FALSE(recordings.recorder(Stream::Any));
  ASSERT_TRUE(recordings.start({"walk", Duration{0}, true, false}));
  EXPECT_TRUE(recordings.recorder(Stream::Raw));
  EXPECT_FALSE(recordings.recorder(Stream::Fused));
  const auto second = recordings.start({"other", Duration{0}, true, true});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::Conflict);
  EXPECT_THAT(second.error().message, HasSubstr("DELETE /recordings/walk"));
  for (int i = 0; i < 10; ++i) recordings.recorder(Stream::Raw)->offer(raw(i));
  const auto recorder = recordings.recorder(Stream::Any);
  ASSERT_TRUE(recordings.stop("walk"));
  ASSERT_TRUE(recorder->wait(std::chrono::seconds(20)));
  EXPECT_TRUE(recordings.stop("walk")) << "twice is harmless";
  EXPECT_EQ(recordings.stop("never").error().code, ErrorCode::NotFound);
  EXPECT_TRUE(recordings.start({"other", Duration{0}, true, true}));
  const auto again = recordings.start({"walk", Duration{0}, true, true});
  EXPECT_EQ(again.error().code, ErrorCode::Conflict);
  EXPECT_THAT(recordings.metrics_text(), HasSubstr("\nchorus_recording_frames_total 10\n"));
  EXPECT_THAT(recordings.metrics_text(), HasSubstr("\nchorus_recording_active 1\n"));
}

TEST(Recordings, MarksAreKeptInTheFilesOfTheOneThatRuns) {
  const chorus::testing::TemporaryFolder folder;
  Recordings recordings(options_in((folder / "rec").string()));
  EXPECT_EQ(recordings.mark("walk", "x").error().code, ErrorCode::NotFound);
  ASSERT_TRUE(recordings.start({"walk", Duration{0}, true, true}));
  const auto recorder = recordings.recorder(Stream::Any);
  for (int i = 0; i < 3; ++i) recorder->offer(raw(i));
  const auto at = recordings.mark("walk", "takes the \"drill\"");
  ASSERT_TRUE(at && *at);
  EXPECT_GE(**at, 0.0);
  ASSERT_TRUE(recordings.mark("walk", "puts it down"));
  ASSERT_TRUE(recordings.stop("walk"));
  ASSERT_TRUE(recorder->wait(std::chrono::seconds(20)));
  EXPECT_EQ(recorder->report().frames, 3u) << "a mark is no frame";
  EXPECT_FALSE(recordings.mark("walk", "x").value()) << "it has ended";
  const auto files = recordings.files_of("walk");
  ASSERT_TRUE(files);
  const auto marks = record::marks_in(*files);
  ASSERT_TRUE(marks) << to_string(marks.error());
  ASSERT_EQ(marks->size(), 2u);
  EXPECT_EQ((*marks)[0].text, "takes the \"drill\"");
  EXPECT_NEAR(seconds((*marks)[0].at - recorder->report().started), **at, 1e-6);
  const auto cell = record::read_cell(*files, {});
  ASSERT_TRUE(cell) << to_string(cell.error());
  EXPECT_EQ(cell->sensors.at(0).frames.size(), 3u) << "readers of frames pass over marks";
}

TEST(Recordings, ANameThatIsTakenAsksForAnotherAndDoesNotSayWhereFilesAre) {
  const chorus::testing::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "rec/walk");
  Recordings recordings(options_in((folder / "rec").string()));
  const auto refused = recordings.start({"walk", Duration{0}, true, true});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Conflict);
  EXPECT_THAT(refused.error().message, HasSubstr("choose another `name`"));
  EXPECT_THAT(to_string(refused.error()), Not(HasSubstr((folder / "rec").string())));
}

TEST(Recordings, TooLittleSpaceIsUnavailableAndDoesNotSayWhereFilesAre) {
  const chorus::testing::TemporaryFolder folder;
  auto options = options_in((folder / "rec").string());
  options.config.limits.min_free_bytes = std::uintmax_t{1} << 60;
  Recordings recordings(options);
  const auto refused = recordings.start({"walk", Duration{0}, true, true});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Unavailable);
  EXPECT_THAT(to_string(refused.error()), Not(HasSubstr((folder / "rec").string())));
  EXPECT_THAT(refused.error().message, HasSubstr("min_free_mb"));
}

TEST(Recordings, AreOffWithoutAFolder) {
  Recordings recordings(options_in(""));
  const auto refused = recordings.start({});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::Forbidden);
  EXPECT_THAT(refused.error().message, HasSubstr("recording.folder"));
}

TEST(Recordings, OfEarlierRunsAreStillThere) {
  const chorus::testing::TemporaryFolder folder;
  const std::string place = (folder / "rec").string();
  {
    Recordings before(options_in(place));
    ASSERT_TRUE(before.start({"walk", Duration{0}, true, true}));
    before.recorder(Stream::Raw)->offer(raw(0));
  }
  std::filesystem::create_directory(folder / "rec/no recording");
  Recordings after(options_in(place));
  const auto report = after.stop("walk");
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(report->state, RecordingState::Finished);
  EXPECT_EQ(report->frames, 1u);
}

/// The routes in a real server.
class RecordingRoutes : public ::testing::Test {
 protected:
  RecordingRoutes() : recordings_(options_in((folder_ / "rec").string())) {
    auto router = std::make_shared<http::Router>();
    recordings_.add_routes(*router);
    server_ = std::make_unique<http::Server>(http::ServerConfig{}, router);
    EXPECT_TRUE(server_->start());
  }

  http::ClientResponse ask(const std::string& method, const std::string& target,
                           const std::string& body = {},
                           const std::string& accept = "application/json") {
    const auto answer = http::fetch({"127.0.0.1", server_->port(), "/"},
                                    {method, target, {{"Accept", accept}}, body});
    EXPECT_TRUE(answer) << to_string(answer.error());
    return answer ? *answer : http::ClientResponse{};
  }

  chorus::testing::TemporaryFolder folder_;
  Recordings recordings_;
  std::unique_ptr<http::Server> server_;
};

TEST_F(RecordingRoutes, StartDescribeStopDownload) {
  const auto started = ask("POST", "/recordings/", R"({"name":"walk"})");
  EXPECT_EQ(started.status, 201);
  EXPECT_EQ(started.headers.at("location"), "/recordings/walk");
  EXPECT_EQ(nlohmann::json::parse(started.body).at("state"), "recording");
  EXPECT_EQ(ask("POST", "/recordings/").status, 409);
  for (int i = 0; i < 30; ++i) recordings_.recorder(Stream::Raw)->offer(raw(i));
  const auto recorder = recordings_.recorder(Stream::Any);
  const auto ended = ask("DELETE", "/recordings/walk");
  // The writer may or may not be done by now; the answer says whether it is.
  EXPECT_THAT(
      (std::pair(ended.status, nlohmann::json::parse(ended.body).at("state").get<std::string>())),
      AnyOf(Pair(202, "stopping"), Pair(200, "finished")));
  ASSERT_TRUE(recorder->wait(std::chrono::seconds(20)));
  const auto described = nlohmann::json::parse(ask("GET", "/recordings/walk").body);
  EXPECT_EQ(described.at("state"), "finished");
  EXPECT_EQ(described.at("frames"), 30);
  const auto whole = ask("GET", described.at("download").get<std::string>(), {}, "*/*");
  EXPECT_EQ(whole.status, 200);
  EXPECT_EQ(whole.body.size(), described.at("bytes").get<std::size_t>());
  const auto read = record::read_recording_bytes(whole.body);
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->truncated);
  const auto part = ask("GET", described.at("files").at(0).get<std::string>(), {}, "*/*");
  EXPECT_EQ(part.body, whole.body);
  const auto list = nlohmann::json::parse(ask("GET", "/recordings/").body);
  EXPECT_EQ(list.at("recordings").at(0).at("name"), "walk");
  EXPECT_THAT(ask("GET", "/recordings/", {}, "text/turtle").body, HasSubstr("ldp:contains <walk>"));
}

TEST_F(RecordingRoutes, EndingOneWaitsForNobodyAndHalfAFileIsNotHandedOut) {
  ASSERT_EQ(ask("POST", "/recordings/", R"({"name":"walk"})").status, 201);
  const auto recorder = recordings_.recorder(Stream::Any);
  std::promise<void> disk;  // a slow disk: the writer waits until this is set
  recorder->offer(record::FusedFrame{{}, {}, [slow = disk.get_future().share()] {
                                       slow.wait();
                                       return resource::FrameResource{};
                                     }});
  EXPECT_EQ(ask("DELETE", "/recordings/walk").status, 202);
  const auto half = ask("GET", "/recordings/walk.mcap", {}, "*/*");
  EXPECT_EQ(half.status, 503);
  EXPECT_EQ(half.headers.at("retry-after"), "1");
  EXPECT_EQ(ask("POST", "/recordings/").status, 409);
  disk.set_value();
  ASSERT_TRUE(recorder->wait(std::chrono::seconds(20)));
  EXPECT_EQ(ask("DELETE", "/recordings/walk").status, 200) << "it has ended";
  const auto whole =
      record::read_recording_bytes(ask("GET", "/recordings/walk.mcap", {}, "*/*").body);
  ASSERT_TRUE(whole);
  EXPECT_FALSE(whole->truncated);
}

TEST_F(RecordingRoutes, LeadNowhereElse) {
  ASSERT_EQ(ask("POST", "/recordings/", R"({"name":"walk"})").status, 201);
  std::ofstream(folder_ / "rec/walk/secret") << "never to be seen";
  for (const char* target :
       {"/recordings/walk/secret", "/recordings/walk/index.json", "/recordings/walk/..%2f..%2fx",
        "/recordings/..%2fx", "/recordings/%2e%2e/walk", "/recordings/.mcap",
        "/recordings/other.mcap"}) {
    const auto answer = ask("GET", target, {}, "*/*");
    EXPECT_GE(answer.status, 400) << target;
    EXPECT_LT(answer.status, 500) << target;
    EXPECT_THAT(answer.body, Not(HasSubstr("never to be seen"))) << target;
  }
  EXPECT_EQ(ask("PUT", "/recordings/walk").status, 405);
}

TEST_F(RecordingRoutes, ADocumentThatHasNotChangedIsNotSentAgain) {
  const auto first = ask("GET", "/recordings/");
  const auto answer =
      http::fetch({"127.0.0.1", server_->port(), "/recordings/"},
                  {"GET",
                   "/recordings/",
                   {{"Accept", "application/json"}, {"If-None-Match", first.headers.at("etag")}},
                   {}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 304);
}

TEST_F(RecordingRoutes, TheListComesInPages) {
  const chorus::testing::TemporaryFolder folder;
  const auto root = std::filesystem::path(folder / "rec");
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    Recordings earlier(options_in(root.string()));
    ASSERT_TRUE(earlier.start({name, Duration{0}, true, true}));
    ASSERT_TRUE(earlier.stop(name));
    ASSERT_TRUE(earlier.recorder(Stream::Any)->wait(std::chrono::seconds(10)));
  }
  Recordings recordings(options_in(root.string()));
  auto router = std::make_shared<http::Router>();
  recordings.add_routes(*router);
  http::Server server(http::ServerConfig{}, router);
  ASSERT_TRUE(server.start());
  const auto get = [&](const std::string& query) {
    const auto answer =
        http::fetch({"127.0.0.1", server.port(), "/"},
                    {"GET", "/recordings/" + query, {{"Accept", "application/json"}}, {}});
    EXPECT_TRUE(answer);
    return answer ? *answer : http::ClientResponse{};
  };
  std::string seen;
  std::string query = "?limit=2";
  for (int pages = 0; pages < 5 && !query.empty(); ++pages) {
    const auto answer = get(query);
    ASSERT_EQ(answer.status, 200) << query;
    const auto listed = nlohmann::json::parse(answer.body).at("recordings");
    EXPECT_LE(listed.size(), 2u);
    for (const auto& one : listed) seen += one.at("name");
    const std::string& links = answer.headers.at("link");
    const auto next = links.find(">; rel=\"next\"");
    const auto from = next == std::string::npos ? next : links.rfind('<', next) + 1;
    query = next == std::string::npos ? "" : links.substr(from, next - from);
  }
  EXPECT_EQ(seen, "abcde");
  EXPECT_THAT(get("").headers.at("link"), Not(HasSubstr("rel=\"next\""))) << "all on one page";
  for (const auto wrong : {"?limit=0", "?limit=1001", "?limit=x", "?limit=-1", "?limit="})
    EXPECT_EQ(get(wrong).status, 400) << wrong;
}

TEST(RecordingNode, SpeaksOnlyDeclaredTerms) {
  record::RecordingReport report;
  report.name = "walk";
  report.reason = "disk full";
  report.stopped = report.started;
  report.files = {{"walk-0001.mcap", {}, 5}};
  EXPECT_THAT(resource::undeclared_terms(recording_node(report, "")), ::testing::IsEmpty());
  report.files.push_back({"walk-0002.mcap", {}, 6});
  const auto text = resource::write(recording_node(report, ""), resource::Format::Json);
  EXPECT_THAT(text, Not(HasSubstr("download"))) << "there is no one file to download";
  EXPECT_THAT(text, HasSubstr("\"bytes\": 11"));
}

}  // namespace
}  // namespace chorus::service
