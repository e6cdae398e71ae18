// What a file is, and what to do with it, whatever reader failed on it.
#include "common/record/sniff.h"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.h"

namespace chorus::record {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Beginning {
  std::string_view bytes;
  const char* format;
  const char* what;
};

TEST(Sniff, KnowsFilesByTheirBeginning) {
  using namespace std::string_view_literals;
  const Beginning beginnings[] = {
      {"\0\0\0\x18"
       "ftypmp42"sv,
       "video", "MP4"},
      {"\0\0\0\x18"
       "ftypheic"sv,
       "", "HEIC"},
      {"PK\x03\x04 xl/workbook"sv, "", "ZIP"},
      {"Kaydara FBX Binary"sv, "", "FBX"},
      {"HIERARCHY\nROOT"sv, "bvh", "BVH"},
      {"\xEF\xBB\xBFhierarchy\n"sv, "bvh", "BVH"},
      {"PathFileType\t4"sv, "trc", "TRC"},
      {"# made by hand\n[Header]\nFileType htr\nEulerRotationOrder ZYX\n"sv, "htr", "HTR"},
      {"<?xml version=\"1.0\"?>\n<mvnx version=\"4\">"sv, "mvnx", "MVNX"},
      {"version https://git-lfs.github.com/spec/v1"sv, "", "Git LFS"},
      {"<!DOCTYPE html>"sv, "", "web page"},
      {"Format Version,1.23,Take Name"sv, "", "Motive"},
      {"[{\"image_id\": \"0.jpg\", \"keypoints\": []}]"sv, "openpose", "AlphaPose"},
      {"{\"version\": 1.3, \"people\": []}"sv, "openpose", "OpenPose"},
      {"time_s,joint,x_m,y_m,z_m\n"sv, "csv", "columns"},
      {""sv, "", "empty"},
  };
  for (const auto& [bytes, format, what] : beginnings) {
    const Sniffed found = sniff_bytes(bytes);
    EXPECT_EQ(found.format, format) << what;
    EXPECT_THAT(found.what, HasSubstr(what));
  }
  EXPECT_THAT(sniff_bytes("nothing that is known").what, IsEmpty());
}

std::filesystem::path shipped(const char* name) {
  return std::filesystem::path("tests/data/other_files") / name;
}

TEST(Sniff, SaysWhyARecordingOfOthersIsNoneOfOurs) {
  const Sniffed lz4 = sniff(shipped("own_lz4.mcap"));
  EXPECT_THAT(lz4.what, HasSubstr("lz4"));
  EXPECT_THAT(lz4.remedy, HasSubstr("mcap compress --compression zstd"));
  const Sniffed ros = sniff(shipped("ros2.mcap"));
  EXPECT_THAT(ros.what, HasSubstr("/body_poses (geometry_msgs/msg/PoseArray), nothing of Chorus"));
}

TEST(Sniff, AddsToAnErrorWhatTheUnexpectedInputIs) {
  const Error error{ErrorCode::Malformed, "x.bvh", "expected HIERARCHY."};
  const std::filesystem::path c3d = shipped("lower.c3d");
  const std::filesystem::path bvh = shipped("ipi.bvh");
  EXPECT_EQ(with_sniffed(error, {{bvh, c3d}}, "bvh").message,
            "expected HIERARCHY; lower.c3d is a C3D file: chorus import c3d reads it");
  EXPECT_EQ(with_sniffed(error, {{bvh}}, "bvh").message, error.message) << "it is as expected";
}

TEST(Sniff, KnowsFoldersByTheirFiles) {
  const chorus::testing::TemporaryFolder folder;
  EXPECT_THAT(sniff(folder.path()).what, HasSubstr("empty folder"));
  (void)folder.write("a_0.json", "{}");
  EXPECT_EQ(sniff(folder.path()).format, "openpose");
  EXPECT_THAT(sniff(folder / "absent").what, IsEmpty());
}

}  // namespace
}  // namespace chorus::record
