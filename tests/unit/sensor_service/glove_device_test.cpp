// A glove in a camera's pictures, and what a sensor says of it.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <nlohmann/json.hpp>

#include "common/sensor/pixel_ray.h"
#include "services/sensor/device/glove/hand_frames.h"
#include "tests/support/hands/glove_scene.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::glove {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::seen_glove;
using chorus::testing::usual_skeleton;

const Eigen::Matrix3d kWorldFromCamera = camera_from_sensor_axes().transpose();

class AGloveBeforeACamera : public ::testing::Test {
 protected:
  AGloveBeforeACamera() {
    settings.hand = write("hand.json", chorus::testing::hand_file(usual_skeleton()));
    std::vector<hand::Pose> take;
    for (hand::Pose pose : chorus::testing::moving_hand()) {
      pose.turn = Eigen::Quaterniond(kWorldFromCamera) * pose.turn;
      pose.wrist.setZero();
      take.push_back(pose);
    }
    settings.take = write("take.bvh", hand::bvh_of(usual_skeleton(), take, 20.0));
    settings.camera.intrinsics = Intrinsics{640, 480, 600.0, 600.0, 319.5, 239.5, {}};
  }

  std::string write(const std::string& name, const std::string& text) {
    const std::string file = (folder.path() / name).string();
    std::ofstream(file) << text;
    return file;
  }

  static camera::Picture picture_of(std::size_t frame) {
    const auto seen = seen_glove(usual_skeleton(), {}, chorus::testing::moving_hand().at(frame));
    cv::Mat colour;
    cv::cvtColor(seen.grey, colour, cv::COLOR_GRAY2BGR);
    return {std::make_shared<const cv::Mat>(colour), {colour.cols, colour.rows}};
  }

  chorus::testing::TemporaryFolder folder;
  GloveSettings settings;
};

TEST_F(AGloveBeforeACamera, IsPlacedByItsTakeAndTheDarkestRegion) {
  auto eye = GloveEye::open(settings);
  ASSERT_TRUE(eye) << to_string(eye.error());
  const auto placed = eye->look(picture_of(10), 10.0 / 20.0);
  ASSERT_TRUE(placed) << to_string(placed.error());
  const Eigen::Vector3d truth = chorus::testing::moving_hand()[10].wrist;
  EXPECT_LT((placed->place.wrist - truth).norm(), 0.015);
  const SeenJoints joints = joints_in_sensor(eye->skeleton(), *placed);
  EXPECT_LT((joints.joints[0] - kWorldFromCamera * truth).norm(), 0.015);
  const BodyFrame body = body_of(joints, Timestamp{});
  EXPECT_TRUE(body.skeleton[JointId::WristRight].seen());
  EXPECT_TRUE(body.skeleton[JointId::ThumbRight].covariance.known());
  EXPECT_FALSE(body.skeleton[JointId::WristLeft].seen());
  EXPECT_FALSE(body.skeleton[JointId::Head].seen());
}

TEST_F(AGloveBeforeACamera, IsToldWithAll21Joints) {
  auto eye = GloveEye::open(settings);
  ASSERT_TRUE(eye);
  const auto placed = eye->look(picture_of(0), 0.0);
  ASSERT_TRUE(placed);
  const SeenJoints joints = joints_in_sensor(eye->skeleton(), *placed);
  const SensorId sensor = SensorId::parse("g1").value();
  const auto told = nlohmann::json::parse(hands_json(sensor, Timestamp{}, &joints));
  ASSERT_EQ(told["hands"].size(), 1U);
  EXPECT_EQ(told["hands"][0]["side"], "right");
  EXPECT_EQ(told["hands"][0]["layout"], "hand_21");
  ASSERT_EQ(told["hands"][0]["joints"].size(), hand::kHandJoints);
  EXPECT_NEAR(told["hands"][0]["joints"][0][2].get<double>(), 0.65, 0.02);
  EXPECT_EQ(nlohmann::json::parse(hands_json(sensor, Timestamp{}, nullptr))["hands"].size(), 0U);
}

TEST_F(AGloveBeforeACamera, WithoutATakeAHandOrAPlaceSaysWhatIsMissing) {
  GloveSettings wrong = settings;
  wrong.hand.clear();
  auto opened = GloveEye::open(wrong);
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().context, "hand");
  wrong = settings;
  wrong.take.clear();
  EXPECT_THAT(GloveEye::open(wrong), FailsWith(ErrorCode::InvalidArgument));
  wrong = settings;
  wrong.places = write("places.json", R"({"sensors": {}})");
  EXPECT_THAT(GloveEye::open(wrong), FailsWith(ErrorCode::NotFound));
}

TEST_F(AGloveBeforeACamera, ThatIsNotThereIsNotFound) {
  auto eye = GloveEye::open(settings);
  ASSERT_TRUE(eye);
  const auto bright = std::make_shared<const cv::Mat>(480, 640, CV_8UC3, cv::Scalar(200, 200, 200));
  EXPECT_THAT(eye->look({bright, {640, 480}}, 0.0), FailsWith(ErrorCode::NotFound));
}

}  // namespace
}  // namespace chorus::glove
