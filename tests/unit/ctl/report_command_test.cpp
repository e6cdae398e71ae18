// chorus report and chorus compare on files, and on what is no file of theirs.
#include <fstream>

#include <nlohmann/json.hpp>

#include "common/record/cell_writer.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using chorus::testing::bytes_of;
using ::testing::HasSubstr;
using ::testing::Not;

/// The walk of three sensors, fused once.
const Cell& judged_cell() {
  static const Cell cell(3.0);
  static const Outcome fused =
      run_chorus({"fuse", cell.recordings(), "--out", cell.file("fused.mcap")});
  static const Outcome lines =
      run_chorus({"fuse", cell.recordings(), "--out", cell.file("lines.ndjson")});
  EXPECT_EQ(fused.code, kExitOk) << fused.error;
  EXPECT_EQ(lines.code, kExitOk) << lines.error;
  return cell;
}

std::string written(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

TEST(ReportCommand, JudgesFusedFramesBesideTheSensors) {
  const Cell& cell = judged_cell();
  const std::string json = cell.file("report.json");
  const Outcome done =
      run_chorus({"report", cell.file("fused.mcap"), cell.recordings(), "--out", json});
  ASSERT_NE(done.out, "") << done.error;
  EXPECT_THAT(done.out, HasSubstr("usable"));
  const auto report = nlohmann::json::parse(bytes_of(json));
  EXPECT_EQ(report.at("sections").back().at("key"), "sensors");
  const auto rows = report.at("sections").back().at("tables")[0].at("rows");
  ASSERT_EQ(rows.size(), 3U);
  for (const auto& row : rows) EXPECT_NE(row.at(6), "-") << "compared with the fused bodies";
}

TEST(ReportCommand, SaysWhatOneSensorAndNoSensorCannotShow) {
  const Cell& cell = judged_cell();
  const Outcome one =
      run_chorus({"report", cell.file("fused.mcap"), cell.recordings() + "/s1.mcap"});
  EXPECT_THAT(one.error, HasSubstr("one sensor, which nobody contradicts"));
  const Outcome none = run_chorus({"report", cell.file("fused.mcap")});
  EXPECT_THAT(none.error, HasSubstr("sensors' own frames are not in it"));
}

TEST(ReportCommand, SaysThatNoRegistrationWasRecorded) {
  const Cell& cell = judged_cell();
  const std::string file = cell.file("unplaced.mcap");
  {
    auto writer = record::CellWriter::create(file, {}).value();
    const auto frames = walk_seen_by(0, 1.0).frames;
    for (const SensorFrame& frame : frames) {
      auto raw = std::make_shared<resource::FrameResource>(resource::to_resource(frame));
      ASSERT_TRUE(writer.write(record::RawFrame{frame.sensor, raw, frame.received, {}, {}}));
      resource::FrameResource fused = *raw;
      fused.space = resource::SpaceKind::World;
      fused.source = "fusion";
      ASSERT_TRUE(
          writer.write(record::FusedFrame{frame.captured, frame.captured, [&] { return fused; }}));
    }
    ASSERT_TRUE(writer.close());
  }
  EXPECT_THAT(run_chorus({"report", file}).error, HasSubstr("no registration was recorded"));
}

TEST(ReportCommand, ReadsATornRecordingAndSaysWhatWasLost) {
  const Cell& cell = judged_cell();
  const std::string whole = bytes_of(cell.file("fused.mcap"));
  const std::string torn = written(cell.file("torn.mcap"), whole.substr(0, whole.size() * 3 / 4));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"report", torn},
        std::vector<std::string>{"compare", cell.file("fused.mcap"), torn, "--same-clock"}}) {
    const Outcome done = run_chorus(words);
    EXPECT_THAT(done.error, HasSubstr("note: torn.mcap: the end is missing")) << words.front();
    EXPECT_NE(done.out, "") << done.error;
  }
}

TEST(ReportCommand, RefusesWhatIsNoRecordingInASentence) {
  const Cell& cell = judged_cell();
  const std::string zeros = written(cell.file("zeros.mcap"), std::string(5000, '\0'));
  const std::string empty = written(cell.file("empty.mcap"), "");
  const std::string lost = cell.file(std::string(300, 'y') + ".mcap");
  const std::string fused = cell.file("fused.mcap");
  const auto refused = [&](std::vector<std::string> words, const std::string& why) {
    const Outcome done = run_chorus(words);
    EXPECT_EQ(done.code, kExitFailed) << words.front();
    EXPECT_THAT(done.error, HasSubstr(why)) << words.front();
    EXPECT_THAT(done.error, Not(HasSubstr("parse error")));
    EXPECT_THAT(done.error, Not(HasSubstr("filesystem error")));
  };
  for (const std::string& file : {zeros, empty}) {
    refused({"report", file}, "not an MCAP file");
    refused({"compare", fused, file}, "neither a recording (.mcap) nor lines");
    refused({"export", file, "--format", "csv", "--out", "-"}, "neither a recording (.mcap) nor");
  }
  for (const std::string& file : {lost, cell.file("a/b c.mcap")}) {
    refused({"report", file}, "there is no such file");
    refused({"compare", file, fused}, "there is no such file");
    refused({"export", file, "--format", "csv", "--out", "-"}, "there is no such file");
  }
  refused({"report", cell.recordings()}, "holds no fused frames");
}

TEST(ReportCommand, LooksAtTheNameOfTheReportBeforeItReads) {
  const Cell& cell = judged_cell();
  const auto refused = [&](const std::string& out, const std::string& why) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"report", "nothing-there.mcap", "--out", out},
          std::vector<std::string>{"compare", "nothing", "there", "--out", out}}) {
      const Outcome done = run_chorus(words);
      EXPECT_EQ(done.code, kExitFailed);
      EXPECT_THAT(done.error, HasSubstr(why));
    }
  };
  refused(cell.file("report.pdf"), ".html, .json or .csv");
  refused(cell.file("no/folder/report.html"), "its folder is not there");
  refused(cell.file(std::string(300, 'x') + ".html"), "too long a name");
}

TEST(CompareCommand, SaysThatTwoRecordingsShareNoTime) {
  const Cell& cell = judged_cell();
  std::string later = bytes_of(cell.file("lines.ndjson"));
  // Two hours later, in both forms of a time.
  const std::vector<std::pair<std::string, std::string>> times{{"T07:3", "T09:3"},
                                                               {"179524620", "179525340"}};
  for (const auto& [from, to] : times)
    for (std::size_t at = later.find(from); at != std::string::npos; at = later.find(from, at + 1))
      later.replace(at, from.size(), to);
  const std::string file = written(cell.file("later.ndjson"), later);
  const Outcome done = run_chorus({"compare", cell.file("fused.mcap"), file});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("share no time: B begins 71"));
  const Outcome lag = run_chorus({"compare", cell.file("fused.mcap"), file, "--any-lag"});
  EXPECT_THAT(lag.error, HasSubstr("less than 5 s in common"));
  EXPECT_THAT(lag.error, Not(HasSubstr("--clock ")));
}

}  // namespace
}  // namespace chorus::ctl
