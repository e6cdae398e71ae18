#include "common/importers/pose_frames.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "common/importers/picture_numbers.h"
#include "common/importers/pose_people.h"
#include "common/sensor/pixel_ray.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::importers {
namespace {

using chorus::testing::IsOk;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The error as text with its code; "" when there is none.
std::string refusal(const Result<record::FrameRecording>& read) {
  return read ? "" : std::string(name_of(read.error().code)) + " " + to_string(read.error());
}

const PoseCamera kCamera{{640, 480, 500.0, 500.0, 320.0, 240.0, {}}, 25.0};

/// A person whose landmarks lie below each other: landmark i at (u, 100 + 5 i).
json flat_person(std::size_t landmarks, double u, double confidence = 0.9) {
  json numbers = json::array();
  for (std::size_t i = 0; i < landmarks; ++i) {
    numbers.push_back(u);
    numbers.push_back(100.0 + 5.0 * static_cast<double>(i));
    numbers.push_back(confidence);
  }
  return {{"person_id", {-1}}, {"pose_keypoints_2d", numbers}};
}

json instance(std::size_t landmarks, double u) {
  json points = json::array();
  for (std::size_t i = 0; i < landmarks; ++i)
    points.push_back({u, 100.0 + 5.0 * static_cast<double>(i)});
  return {{"keypoints", points}, {"keypoint_scores", json(std::vector<double>(landmarks, 1.04))}};
}

std::string frame_text(const std::vector<json>& people) {
  return json{{"version", 1.3}, {"people", people}}.dump();
}

class PoseFrames : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    (void)folder_.write(name, text);
  }
  [[nodiscard]] Result<record::FrameRecording> read() const {
    ImportOptions options;
    options.sensor = SensorId::parse("cam1").value();
    return read_pose_frames(folder_.path(), kCamera, options);
  }
  chorus::testing::TemporaryFolder folder_;
};

TEST_F(PoseFrames, OpenPoseNumbersPicturesInTheirNames) {
  write("cam1_000000000000_keypoints.json", frame_text({flat_person(25, 300)}));
  write("cam1_000000000002_keypoints.json", frame_text({}));
  const auto read_ = read();
  ASSERT_THAT(read_, IsOk());
  ASSERT_EQ(read_->frames.size(), 2u);
  EXPECT_EQ(read_->frames[1].captured - read_->frames[0].captured, std::chrono::milliseconds(80));
  EXPECT_EQ(read_->frames[0].captured, kDefaultStart);
  EXPECT_TRUE(read_->frames[1].bodies.empty());
  EXPECT_EQ(read_->notes.at("layout"), "body_25");
  EXPECT_EQ(read_->intrinsics, kCamera.intrinsics);
}

TEST_F(PoseFrames, AJointIsTheRayThroughItsLandmark) {
  write("0.json", frame_text({flat_person(25, 300)}));
  const auto read_ = read();
  ASSERT_THAT(read_, IsOk());
  const Joint& wrist = read_->frames[0].bodies.at(0).skeleton[JointId::WristRight];
  ASSERT_TRUE(wrist.bears());
  // Landmark 4 of BODY_25; the sensor's x points to the left of the picture and y up.
  const Eigen::Vector3d in_picture = *ray_of({300.0, 120.0}, kCamera.intrinsics);
  EXPECT_NEAR(
      (wrist.position - Eigen::Vector3d(-in_picture.x(), -in_picture.y(), in_picture.z())).norm(),
      0.0, 1e-9);
  EXPECT_TRUE(wrist.covariance.known());
  EXPECT_EQ(wrist.state, JointState::Tracked);
}

TEST_F(PoseFrames, TheLayoutFollowsFromTheNumberOfLandmarks) {
  const std::vector<std::pair<std::size_t, std::string>> known{{17, "coco_17"},  {18, "coco_18"},
                                                               {25, "body_25"},  {26, "halpe_26"},
                                                               {133, "coco_17"}, {136, "halpe_26"}};
  for (const auto& [count, name] : known) {
    json person = flat_person(count, 300);
    for (std::size_t i = 1; i < 3 * count; i += 3) person["pose_keypoints_2d"][i] = 200.0;
    write("0.json", frame_text({person}));
    EXPECT_EQ(read()->notes.at("layout"), name);
  }
  write("0.json", frame_text({flat_person(21, 300)}));
  EXPECT_THAT(refusal(read()),
              ::testing::AllOf(::testing::StartsWith("not-found"), HasSubstr("has 21 landmarks")));
}

TEST_F(PoseFrames, MmposeIsReadByPictureAndByVideo) {
  write("7.json", json::array({instance(17, 200), instance(17, 400)}).dump());
  const auto pictures = read();
  ASSERT_THAT(pictures, IsOk());
  EXPECT_EQ(pictures->frames.at(0).bodies.size(), 2u);
  EXPECT_EQ(pictures->frames[0].captured, kDefaultStart + std::chrono::milliseconds(280));

  const json list = json::array({{{"frame_id", 1}, {"instances", json::array({instance(26, 200)})}},
                                 {{"frame_id", 2}, {"instances", json::array()}}});
  for (const json& document :
       {list, json{{"meta_info", json::object()}, {"instance_info", list}}}) {
    const auto file = folder_.write("video.json", document.dump());
    const auto video = read_pose_frames(file, kCamera);
    ASSERT_THAT(video, IsOk());
    EXPECT_EQ(video->frames.size(), 2u);
    EXPECT_EQ(video->sensor.str(), "video");
    EXPECT_EQ(video->notes.at("layout"), "halpe_26");
  }
}

TEST_F(PoseFrames, ADamagedOrEmptyFileCostsItsPictureOnly) {
  write("0.json", frame_text({flat_person(17, 300)}));
  write("1.json", "");
  write("2.json", frame_text({flat_person(17, 300)}).substr(0, 40));
  write("3.json", frame_text({flat_person(17, 300)}));
  write("notes.txt", "not ours");
  const auto read_ = read();
  ASSERT_THAT(read_, IsOk());
  EXPECT_EQ(read_->frames.size(), 2u);
  EXPECT_THAT(read_->notes.at("damage.1"), HasSubstr("2 files have no frame; the first: "));
  EXPECT_THAT(read_->notes.at("damage.1"), HasSubstr("1.json"));
}

TEST_F(PoseFrames, WhoHasNoLandmarksIsSkippedAndWhoCannotBeReadIsLeftOut) {
  json broken = flat_person(25, 100);
  broken["pose_keypoints_2d"].erase(0);
  write("0.json", frame_text({json::object(), flat_person(25, 300), broken}));
  const auto read_ = read();
  ASSERT_THAT(read_, IsOk());
  EXPECT_EQ(read_->frames.at(0).bodies.size(), 1u);
  EXPECT_THAT(read_->notes.at("absent"), HasSubstr("1 people"));
  EXPECT_THAT(read_->notes.at("damage.2"), HasSubstr("people[2]"));
}

TEST_F(PoseFrames, ThePixelZeroIsALandmarkThatWasNotSeen) {
  json person = flat_person(25, 300);
  const auto head = read_pose_frames(folder_.write("a.json", frame_text({person})), kCamera);
  for (int i = 0; i < 2; ++i) person["pose_keypoints_2d"][4 * 3 + i] = 0;  // the right wrist
  const auto lost = read_pose_frames(folder_.write("b.json", frame_text({person})), kCamera);
  ASSERT_THAT(head, IsOk());
  ASSERT_THAT(lost, IsOk());
  const auto wrist = [](const auto& read) {
    return read->frames[0].bodies.at(0).skeleton[JointId::WristRight].given();
  };
  EXPECT_TRUE(wrist(head));
  EXPECT_FALSE(wrist(lost));
  EXPECT_THAT(lost->notes.at("unseen"), HasSubstr("1 landmarks"));
}

json coco_person(const json& image, double u) {
  return {{"image_id", image},
          {"category_id", 1},
          {"keypoints", flat_person(17, u)["pose_keypoints_2d"]},
          {"score", 2.5}};
}

TEST_F(PoseFrames, ResultsOfAlphaPoseAndCocoNameTheirPictures) {
  const json named = {coco_person("2.jpg", 300), coco_person("10.jpg", 310),
                      coco_person("2.jpg", 50)};
  const json numbered = {
      {"images", {{{"id", 77}, {"file_name", "2.jpg"}}, {{"id", 78}, {"file_name", "10.jpg"}}}},
      {"annotations", {coco_person(77, 300), coco_person(78, 310), coco_person(77, 50)}}};
  const json by_picture = {
      {"2.jpg", {{"people", {flat_person(17, 300), flat_person(17, 50)}}}},
      {"10.jpg", {{"bodies", {{{"joints", flat_person(17, 310)["pose_keypoints_2d"]}}}}}}};
  for (const json& document : {named, numbered, by_picture}) {
    const auto read_ = read_pose_frames(folder_.write("r.json", document.dump()), kCamera);
    ASSERT_THAT(read_, IsOk()) << document.dump(2);
    ASSERT_EQ(read_->frames.size(), 2u);
    EXPECT_EQ(read_->frames[0].bodies.size(), 2u);
    EXPECT_EQ(read_->frames[1].captured - read_->frames[0].captured,
              std::chrono::milliseconds(320));
    EXPECT_EQ(read_->notes.at("layout"), "coco_17");
  }
}

TEST_F(PoseFrames, NanIsALandmarkThatWasNotSeen) {
  const auto without_left_wrist = [](std::string text) {  // landmark 9, at 100 + 5 * 9
    return text.replace(text.find("145.0"), 5, "NaN");
  };
  const json pairs = json::array({instance(17, 300)});
  for (const std::string& text : {frame_text({flat_person(17, 300)}), pairs.dump()}) {
    write("0.json", without_left_wrist(text));
    const auto read_ = read();
    ASSERT_THAT(read_, IsOk());
    const Skeleton<SensorSpace>& seen = read_->frames.at(0).bodies.at(0).skeleton;
    EXPECT_FALSE(seen[JointId::WristLeft].given());
    EXPECT_TRUE(seen[JointId::WristRight].given());
  }
  write("0.json", R"({"people": [], "note": "a \"NaN\" stays", "scale": -Infinity})");
  EXPECT_THAT(read(), IsOk());
  write("0.json", R"({"people": [NaNa]})");
  EXPECT_THAT(refusal(read()), HasSubstr("no file that can be used"));
}

TEST_F(PoseFrames, TwoPicturesOfOneNumberAreRefused) {
  write("1.json", frame_text({flat_person(17, 300)}));
  write("01.json", frame_text({flat_person(17, 200)}));
  EXPECT_THAT(refusal(read()),
              ::testing::AllOf(::testing::StartsWith("conflict"), HasSubstr("1.json"),
                               HasSubstr("is picture 1, and another one is that too")));
  const json twice = json::array({{{"frame_id", 4}, {"instances", json::array()}},
                                  {{"frame_id", 4}, {"instances", json::array()}}});
  EXPECT_THAT(refusal(read_pose_frames(folder_.write("video.json", twice.dump()), kCamera)),
              HasSubstr("[1]: is picture 4, and another"));
}

TEST_F(PoseFrames, NumbersBeyondAllTimeAreRefused) {
  write("250000000.json", frame_text({flat_person(17, 300)}));
  EXPECT_THAT(read(), IsOk()) << "1e7 s";
  for (const std::uint64_t number : {std::uint64_t{250000001}, ~std::uint64_t{0}}) {
    const json late = json::array({{{"frame_id", number}, {"instances", json::array()}}});
    EXPECT_THAT(refusal(read_pose_frames(folder_.write("video.json", late.dump()), kCamera)),
                HasSubstr("more than 1e+07 s from the first"));
  }
}

TEST_F(PoseFrames, AnAbsurdIdOfATrackerIsNone) {
  json person = instance(17, 200);
  person["track_id"] = ~std::uint64_t{0};
  write("0.json", json::array({person}).dump());
  const auto absurd = read();
  ASSERT_THAT(absurd, IsOk());
  EXPECT_EQ(absurd->frames.at(0).bodies.at(0).id, BodyId{1});
  person["track_id"] = 41;
  write("0.json", json::array({person}).dump());
  EXPECT_EQ(read()->frames.at(0).bodies.at(0).id, BodyId{42});
}

TEST_F(PoseFrames, AFolderWithNothingUsefulSaysWhy) {
  EXPECT_THAT(refusal(read()),
              ::testing::AllOf(::testing::StartsWith("not-found"), HasSubstr("no .json files")));
  write("0.json", "{");
  EXPECT_THAT(refusal(read()), ::testing::AllOf(::testing::StartsWith("not-found"),
                                                HasSubstr("no file that can be used")));
}

TEST_F(PoseFrames, LandmarksOfAnotherSizeAreRefused) {
  write("0.json", frame_text({flat_person(17, 900)}));
  EXPECT_THAT(refusal(read()), ::testing::AllOf(::testing::StartsWith("invalid-argument"),
                                                HasSubstr("outside of pictures of 640 x 480")));
  json scaled = flat_person(17, 0.5);
  for (std::size_t i = 1; i < 51; i += 3) scaled["pose_keypoints_2d"][i] = 0.4;
  write("0.json", frame_text({scaled}));
  EXPECT_THAT(refusal(read()), ::testing::AllOf(::testing::StartsWith("invalid-argument"),
                                                HasSubstr("--keypoint_scale 0")));
}

PosePerson person_at(double u, std::optional<std::uint64_t> id = {}) {
  PosePerson person{{}, id};
  for (int i = 0; i < 17; ++i) person.points.push_back({{u, 100.0 + 10.0 * i}, 0.9});
  return person;
}

TEST(PeopleNumbers, FollowPeopleWhoseOrderChanges) {
  PeopleNumbers numbers;
  EXPECT_THAT(numbers.number({person_at(100), person_at(400)}), ElementsAre(1, 2));
  EXPECT_THAT(numbers.number({person_at(395), person_at(110)}), ElementsAre(2, 1));
  EXPECT_THAT(numbers.number({person_at(120)}), ElementsAre(1));
  EXPECT_THAT(numbers.number({person_at(390), person_at(130)}), ElementsAre(2, 1));
  EXPECT_THAT(numbers.number({person_at(600), person_at(135)}), ElementsAre(3, 1)) << "a newcomer";
}

TEST(PeopleNumbers, OfTheFileCountWhereAllHaveTheirOwn) {
  PeopleNumbers numbers;
  EXPECT_THAT(numbers.number({person_at(100, 7), person_at(400, 9)}), ElementsAre(7, 9));
  EXPECT_THAT(numbers.number({person_at(100, 7), person_at(400, 7)}), ElementsAre(10, 11))
      << "7 and 9 are the tracker's";
}

TEST(PeopleNumbers, ForgetWhoWasThereWhileNobodyIs) {
  PeopleNumbers numbers;
  EXPECT_THAT(numbers.number({person_at(100)}), ElementsAre(1));
  for (int i = 0; i < 20; ++i) EXPECT_THAT(numbers.number({}), ::testing::IsEmpty());
  EXPECT_THAT(numbers.number({person_at(100)}), ElementsAre(1)) << "back soon";
  for (int i = 0; i < 40; ++i) EXPECT_THAT(numbers.number({}), ::testing::IsEmpty());
  EXPECT_THAT(numbers.number({person_at(100)}), ElementsAre(2));
}

TEST(PictureNumbers, AreTheDigitsThatTellTheNamesApart) {
  EXPECT_THAT(picture_numbers({"cam1_000_keypoints", "cam1_012_keypoints"}).numbers,
              ElementsAre(0, 12));
  EXPECT_THAT(picture_numbers({"cam_000012_pose2d", "cam_000013_pose2d"}).numbers,
              ElementsAre(12, 13));
  EXPECT_THAT(picture_numbers({"7_of_2", "8_of_1", "9_of_2"}).numbers, ElementsAre(7, 8, 9));
  EXPECT_THAT(picture_numbers({"1700000000_8", "1700000001_9"}).numbers, ElementsAre(8, 9));
  EXPECT_THAT(picture_numbers({"9", "10"}).numbers, ElementsAre(9, 10));
}

TEST(PictureNumbers, OfATimeOfDayAreThePlacesInItsOrder) {
  const auto times = picture_numbers({"12-30-00-960", "12-30-00-990", "12-30-01-023"});
  EXPECT_TRUE(times.by_order);
  EXPECT_THAT(times.numbers, ElementsAre(0, 1, 2));
  EXPECT_FALSE(picture_numbers({"cam_10", "cam_9"}).by_order)
      << "numbers without zeros before them";
}

TEST(PictureNumbers, OfOneNameAreItsLongestRun) {
  EXPECT_THAT(picture_numbers({"cam_000012_pose2d"}).numbers, ElementsAre(12));
  EXPECT_THAT(picture_numbers({"a1b2"}).numbers, ElementsAre(2));
  EXPECT_THAT(picture_numbers({"0", "also_5_x"}).numbers, ElementsAre(0, 5))
      << "names unlike each other";
}

TEST(PictureNumbers, AreThePlaceInTheListWithoutDigits) {
  EXPECT_THAT(picture_numbers({"a", "b"}).numbers, ElementsAre(0, 1));
  EXPECT_THAT(picture_numbers({"20261123101530123456", "20261123101530123457"}).numbers,
              ElementsAre(0, 1));
  EXPECT_THAT(picture_numbers({"", "5"}).numbers, ElementsAre(0, 5));
  EXPECT_THAT(picture_numbers({}).numbers, ::testing::IsEmpty());
}

}  // namespace
}  // namespace chorus::importers
