#include "common/importers/datasets/nw_ucla_json.h"

#include "common/importers/formats.h"
#include "tests/support/matchers.h"
#include "tests/unit/importers/import_files.h"

namespace chorus::importers {
namespace {

using testing::FailsWith;
using ::testing::HasSubstr;
using testing::IsOk;

std::string skeleton(double x, std::size_t joints = 20) {
  std::string text = "[";
  for (std::size_t j = 0; j < joints; ++j)
    text += (j > 0 ? ",[" : "[") + std::to_string(x) + "," + std::to_string(j) + ",3]";
  return text + "]";
}

std::string document(double x, int frames = 2) {
  std::string text = R"({"file_name":"t","label":1,"skeletons":[)";
  for (int i = 0; i < frames; ++i) text += (i > 0 ? "," : "") + skeleton(x + 0.01 * i);
  return text + "]}";
}

TEST(NwUclaJson, MapsTwentyJointsAndLeavesTheOthersNotTracked) {
  const TemporaryFolder folder;
  const auto recording = read_nw_ucla_json(folder.write("a01_s01_e00_v02.json", document(0.5)));
  ASSERT_THAT(recording, IsOk());
  EXPECT_EQ(recording->sensor.str(), "v02");
  EXPECT_THAT(recording->notes.at("time"), HasSubstr("30 Hz is assumed"));
  ASSERT_EQ(recording->frames.size(), 2u);
  const auto& body = recording->frames[0].bodies.at(0).skeleton;
  EXPECT_EQ(body[JointId::SpineBase].position.y(), 0.0);
  EXPECT_EQ(body[JointId::SpineShoulder].position.y(), 2.0);
  EXPECT_EQ(body[JointId::HandRight].position.y(), 11.0);
  EXPECT_EQ(body[JointId::FootRight].position.y(), 19.0);
  for (const JointId absent : {JointId::Neck, JointId::HandTipLeft, JointId::ThumbLeft,
                               JointId::HandTipRight, JointId::ThumbRight})
    EXPECT_EQ(body[absent].state, JointState::NotTracked);
}

TEST(NwUclaJson, RefusesBadDocumentsNamingThePlace) {
  const TemporaryFolder folder;
  struct {
    const char* name;
    std::string text;
    const char* says;
    ErrorCode code = ErrorCode::Malformed;
  } const bad[] = {
      {"cut off", document(0.5).substr(0, 100), "line 1, column 101"},
      {"no skeletons", R"({"label":1})", "no \"skeletons\""},
      {"not an object", "[]", "no \"skeletons\""},
      {"none", R"({"skeletons":[]})", "array of frames"},
      {"19 joints", R"({"skeletons":[)" + skeleton(0.1, 19) + "]}",
       "skeletons[0]: must hold the 20"},
      {"null", R"({"skeletons":[[[null,0,0],)" + skeleton(0.1, 19).substr(1) + "]}",
       "skeletons[0][0]: value 1 is not a number"},
      {"huge number", R"({"skeletons":[[[1e300,0,0],)" + skeleton(0.1, 19).substr(1) + "]}",
       "beyond"},
      {"NaN", R"({"skeletons":[[[NaN,0,0],)" + skeleton(0.1, 19).substr(1) + "]}", "line 1"},
      {"deep", std::string(200'000, '['), "nested deeper", ErrorCode::TooLarge},
  };
  for (const auto& each : bad) {
    const auto recording = read_nw_ucla_json(folder.write("bad.json", each.text));
    ASSERT_THAT(recording, FailsWith(each.code)) << each.name;
    EXPECT_THAT(to_string(recording.error()), HasSubstr(each.says)) << each.name;
  }
}

TEST(NwUclaJson, RefusesAViewThatIsACopyOfAnother) {
  const TemporaryFolder folder;
  const auto v01 = folder.write("a01_s01_e00_v01.json", document(0.1));
  const auto v02 = folder.write("a01_s01_e00_v02.json", document(0.2));
  const auto v03 = folder.write("a01_s01_e00_v03.json", document(0.2));
  const auto set = import_files(FileFormat::NwUcla, {v01, v02, v03});
  ASSERT_THAT(set, FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(to_string(set.error()), HasSubstr("v03: holds the very numbers of v02"));
  EXPECT_THAT(import_files(FileFormat::NwUcla, {v01, v03}), IsOk());
}

TEST(NwUclaJson, ReadsTheSharedRecordingsAndFindsTheirCopies) {
  const auto folder = shared_recordings() / "nw_ucla_3kinect/all_sqe";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "runs where " << folder << " is there";
  std::size_t files = 0;
  std::size_t complete = 0;
  std::size_t copies = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    const auto view = read_nw_ucla_json(entry.path());
    ASSERT_THAT(view, IsOk()) << entry.path();
    ++files;
    const auto other = folder / (stem.substr(0, stem.size() - 1) + "2.json");
    if (stem.back() != '3' || !std::filesystem::exists(other)) continue;
    ++complete;
    copies += refuse_copies({read_nw_ucla_json(other).value(), *view}) ? 0 : 1;
  }
  EXPECT_GT(files, 300u);
  EXPECT_GT(copies, 0u);
  EXPECT_LT(copies, complete / 2);
  RecordProperty("copies", static_cast<int>(copies));
}

}  // namespace
}  // namespace chorus::importers
