// chorus export and chorus import on files: what is written, refused and printed.
#include <nlohmann/json.hpp>

#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using chorus::testing::bytes_of;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::json;

/// The walk, fused once for all tests in this file.
const Cell& fused_cell() {
  static const Cell cell(3.0);
  static const Outcome fused =
      run_chorus({"fuse", cell.recordings(), "--out", cell.file("fused.ndjson")});
  EXPECT_EQ(fused.code, kExitOk) << fused.error;
  return cell;
}

TEST(ExportCommand, WritesEveryFormatItNames) {
  const Cell& cell = fused_cell();
  const std::vector<std::pair<std::string, std::string>> formats{{"bvh", "HIERARCHY"},
                                                                 {"c3d", "\x02P"},
                                                                 {"trc", "PathFileType"},
                                                                 {"csv", ""},
                                                                 {"gltf", "glTF"}};
  for (const auto& [format, beginning] : formats) {
    const std::string out = cell.file("walk." + format);
    const Outcome done =
        run_chorus({"export", cell.file("fused.ndjson"), "--format", format, "--out", out});
    ASSERT_EQ(done.code, kExitOk) << format << ": " << done.error;
    EXPECT_THAT(done.error, HasSubstr("1 person,"));
    EXPECT_THAT(done.error, HasSubstr("wrote " + out));
    EXPECT_THAT(bytes_of(out), StartsWith(beginning)) << format;
    EXPECT_GT(bytes_of(out).size(), 10'000u) << format;
  }
}

TEST(ExportCommand, WritesToStandardOutputAndNothingElseThere) {
  const Cell& cell = fused_cell();
  const Outcome done =
      run_chorus({"export", cell.file("fused.ndjson"), "--format", "csv", "--out", "-", "--json"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_GT(lines_of(done.out).size(), 25u * 80u);  // one row per joint
  const Json summary = Json::parse(done.error);
  EXPECT_EQ(summary.at("persons").size(), 1u);
  EXPECT_NEAR(summary.at("rateHz").get<double>(), 30.0, 0.5);
  EXPECT_EQ(summary.at("files"), Json({"-"}));
}

TEST(ExportCommand, TheRateIsTheOneThatIsAskedFor) {
  const Cell& cell = fused_cell();
  const auto frames_at = [&](const char* rate) {
    const Outcome done = run_chorus({"export", cell.file("fused.ndjson"), "--format", "trc",
                                     "--out", "-", "--rate", rate, "--json"});
    return Json::parse(done.error).at("frames").get<double>();
  };
  EXPECT_NEAR(frames_at("60"), 2.0 * frames_at("30"), 3.0);
  EXPECT_NEAR(frames_at("10"), frames_at("30") / 3.0, 3.0);
}

TEST(ExportCommand, UnitsOfBvhAreCentimetresUnlessMetresAreAskedFor) {
  const Cell& cell = fused_cell();
  const auto bvh = [&](const char* unit) {
    return run_chorus({"export", cell.file("fused.ndjson"), "--format", "bvh", "--out", "-",
                       "--unit", unit})
        .out;
  };
  const auto first_offset = [](const std::string& text) {
    const auto second = text.find("OFFSET", text.find("OFFSET") + 1);
    return std::stod(text.substr(text.find(' ', second + 8) + 1));
  };
  EXPECT_NEAR(first_offset(bvh("cm")), 100.0 * first_offset(bvh("m")), 0.2);
}

TEST(ExportCommand, LinesHoldTheFramesAsTheyAre) {
  const Cell& cell = fused_cell();
  const std::string recorded = cell.file("lines.mcap");
  ASSERT_EQ(run_chorus({"fuse", cell.recordings(), "--out", recorded}).code, kExitOk);
  const Outcome done = run_chorus({"export", recorded, "--format", "ndjson", "--out", "-"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_EQ(done.out, bytes_of(cell.file("fused.ndjson"))) << "covariances, ages, shares and all";
  EXPECT_THAT(done.error, HasSubstr(" with somebody in them"));
  const Outcome nobody =
      run_chorus({"export", recorded, "--format", "ndjson", "--out", "-", "--person", "77"});
  EXPECT_EQ(nobody.code, kExitFailed);
  const Outcome gridded =
      run_chorus({"export", recorded, "--format", "ndjson", "--out", "-", "--rate", "10"});
  EXPECT_EQ(gridded.code, kExitFailed);
  EXPECT_THAT(gridded.error, HasSubstr("--rate"));
}

TEST(ExportCommand, RefusesWhatItCannotDo) {
  const Cell& cell = fused_cell();
  const std::string source = cell.file("fused.ndjson");
  EXPECT_EQ(run_chorus({"export", source, "--format", "fbx", "--out", "-"}).code, kExitUsage);
  EXPECT_EQ(run_chorus({"export", source, "--format", "csv", "--out", "-", "--rate", "0"}).code,
            kExitUsage);
  EXPECT_EQ(run_chorus({"export", source, "--format", "csv"}).code, kExitUsage);
  const Outcome nobody =
      run_chorus({"export", source, "--format", "csv", "--out", "-", "--person", "99"});
  EXPECT_EQ(nobody.code, kExitFailed);
  EXPECT_THAT(nobody.error, HasSubstr("99"));
  EXPECT_EQ(run_chorus({"export", cell.file("none"), "--format", "csv", "--out", "-"}).code,
            kExitFailed);
  const std::string before = bytes_of(source);
  EXPECT_EQ(run_chorus({"export", source, "--format", "csv", "--out", source}).code, kExitFailed);
  EXPECT_EQ(bytes_of(source), before);
}

TEST(ExportCommand, TellsThatBinaryGltfWantsAnotherName) {
  const Cell& cell = fused_cell();
  const Outcome done = run_chorus(
      {"export", cell.file("fused.ndjson"), "--format", "gltf", "--out", cell.file("scene.gltf")});
  EXPECT_THAT(done.error, HasSubstr(".glb"));
}

constexpr const char* kLabanotation = "tests/data/kinect2_labanotation/Ges04_comehere.csv";

TEST(ImportCommand, WritesARecordingThatCanBeFused) {
  const chorus::testing::TemporaryFolder folder;
  const std::string out = (folder / "rec").string();
  const Outcome done =
      run_chorus({"import", "labanotation", kLabanotation, "--out", out, "--sensor", "k2",
                  "--floor", "0,0.99,0.12,1.1", "--start", "2026-11-21T07:30:00Z", "--json"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  const Json summary = Json::parse(done.out);
  ASSERT_EQ(summary.at("recordings").size(), 1u);
  EXPECT_EQ(summary.at("recordings")[0].at("sensor"), "k2");
  EXPECT_THAT(summary.at("recordings")[0].at("first").get<std::string>(),
              StartsWith("2026-11-21T07:30:00"));
  const auto back = record::read_frame_recording(folder / "rec/k2.mcap");
  ASSERT_THAT(back, chorus::testing::IsOk());
  EXPECT_EQ(back->frames.size(), summary.at("recordings")[0].at("frames"));
  ASSERT_TRUE(back->floor);
  EXPECT_NEAR(back->floor->offset, 1.1 / std::hypot(0.99, 0.12), 1e-5);
  EXPECT_EQ(run_chorus({"fuse", out, "--out", "-"}).code, kExitOk);
}

TEST(ImportCommand, SaysWhatLiesInTheFolderAlready) {
  const chorus::testing::TemporaryFolder folder;
  const std::string out = folder.path().string();
  ASSERT_EQ(
      run_chorus({"import", "labanotation", kLabanotation, "--out", out, "--sensor", "a"}).code,
      kExitOk);
  const Outcome second =
      run_chorus({"import", "labanotation", kLabanotation, "--out", out, "--sensor", "b"});
  EXPECT_EQ(second.code, kExitOk);
  EXPECT_THAT(second.error, HasSubstr("a.mcap was there before"));
  EXPECT_THAT(second.out, HasSubstr("wrote " + (folder / "b.mcap").string()));
}

TEST(ImportCommand, TakesNoSensorItsPlace) {
  const chorus::testing::TemporaryFolder folder;
  const std::string out = folder.path().string();
  const std::string csv = "time_s,joint,x_m,y_m,z_m\n0,Head,0,1.6,2\n0.03,Head,0,1.6,2\n";
  const auto left = folder.write("left.csv", csv).string();
  const auto right = folder.write("right.csv", csv).string();
  ASSERT_EQ(run_chorus({"import", "csv", left, "--out", out}).code, kExitOk);
  ASSERT_EQ(run_chorus({"import", "csv", left, "--out", out}).code, kExitOk) << "may be repeated";
  const std::string places = bytes_of(folder / "registration.json");
  const Outcome other = run_chorus({"import", "csv", right, "--out", out});
  EXPECT_EQ(other.code, kExitFailed);
  EXPECT_THAT(other.error, HasSubstr("where left stand"));
  EXPECT_EQ(bytes_of(folder / "registration.json"), places);
  EXPECT_FALSE(fs::exists(folder / "right.mcap"));
}

TEST(ImportCommand, RefusesOptionsWithoutAnEffect) {
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--joints", kLabanotation}, {"--rate", "50"}, {"--rays"}}) {
    std::vector<std::string> words{"import", "labanotation", kLabanotation, "--out", "/tmp/x"};
    words.insert(words.end(), option.begin(), option.end());
    const Outcome done = run_chorus(words);
    EXPECT_EQ(done.code, kExitFailed) << option[0];
    EXPECT_THAT(done.error, HasSubstr(option[0] + ":"));
    EXPECT_THAT(done.error, HasSubstr("leave it out"));
  }
}

TEST(ImportCommand, SaysWhatAFileIsThatItCannotRead) {
  const chorus::testing::TemporaryFolder folder;
  const auto file = folder.write("walk.csv", "HIERARCHY\nROOT Hips\n").string();
  const Outcome done = run_chorus({"import", "csv", file, "--out", (folder / "rec").string()});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("walk.csv is a BVH file: chorus import bvh reads it"));
}

TEST(ImportCommand, WritesATemplateWhereNamesAreUnknownAndTakesIt) {
  const chorus::testing::TemporaryFolder folder;
  const auto file = folder
                        .write("odd.trc",
                               "PathFileType\t4\t(X/Y/Z)\todd.trc\nDataRate\tUnits\n50\tm\n"
                               "Frame#\tTime\tfoo\t\t\tbar\n1\t0\t0\t1.7\t0\t0\t1\t0\n")
                        .string();
  const std::string out = (folder / "rec").string();
  const Outcome refused = run_chorus({"import", "trc", file, "--out", out});
  EXPECT_EQ(refused.code, kExitFailed);
  EXPECT_THAT(refused.error, HasSubstr("foo, bar"));
  EXPECT_THAT(refused.error, HasSubstr(out + "/odd.joints.txt"));
  EXPECT_THAT(bytes_of(fs::path(out) / "odd.joints.txt"), HasSubstr("#   foo\n"));
  const auto joints = folder.write("mine.txt", "Head = foo\nSpineBase = bar\n").string();
  const Outcome done = run_chorus({"import", "trc", file, "--out", out, "--joints", joints});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.error, HasSubstr("only 2 of our 25 joints"));
}

TEST(ImportCommand, SaysWhatTheFileSaysNothingOf) {
  const chorus::testing::TemporaryFolder folder;
  std::string row;
  for (int i = 0; i < 25; ++i) row += "0 1.5 2 0 0 0 1 ";
  const auto file = folder.write("kinect.txt", row + "\n" + row + "\n").string();
  const Outcome done = run_chorus({"import", "keraal", file, "--out", (folder / "rec").string()});
  EXPECT_THAT(done.out, HasSubstr("tracking states: none in the file")) << done.error;
}

TEST(ImportCommand, RefusesTextsThatMeanNothing) {
  const std::vector<std::string> start{"import", "labanotation", kLabanotation, "--out", "/tmp/x"};
  for (const auto& [option, value] :
       std::vector<std::pair<std::string, std::string>>{{"--floor", "0,1,0"},
                                                        {"--start", "noon"},
                                                        {"--sensor", "a b"},
                                                        {"--unit", "span"},
                                                        {"--up", "w"},
                                                        {"--clocks", "two"}}) {
    std::vector<std::string> words = start;
    words.insert(words.end(), {option, value});
    const Outcome done = run_chorus(words);
    EXPECT_EQ(done.code, kExitUsage) << option;
    EXPECT_THAT(done.error, HasSubstr(option));
  }
}

}  // namespace
}  // namespace chorus::ctl
