// Pictures are upright whatever the file says about rotation: phones film sideways and say so.
#include <gtest/gtest.h>

#include <fstream>

#include <opencv2/imgcodecs.hpp>

#include "services/sensor/device/camera/video.h"
#include "tests/support/temporary_folder.h"

namespace chorus::camera {
namespace {

/// Blue minus red at a share of the height, in the middle of the width.
int blueness(const Picture& picture, double down) {
  const auto row = static_cast<int>(down * picture.size.height);
  const auto pixel = picture.pixels->at<cv::Vec3b>(row, picture.size.width / 2);
  return pixel[0] - pixel[2];
}

struct Clip {
  const char* file;
  bool blue_up;
};

class Rotation : public ::testing::TestWithParam<Clip> {};

TEST_P(Rotation, TheBluePartIsWhereEveryPlayerShowsIt) {
  CameraSettings settings;
  settings.source = std::string("tests/data/turned_videos/") + GetParam().file;
  const auto video = open_video(settings);
  ASSERT_TRUE(video) << to_string(video.error());
  const auto moment = (*video)->next();
  ASSERT_TRUE(moment && moment->has_value());
  const auto picture = (*video)->picture();
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->size, (Size{320, 240}));
  EXPECT_GT(blueness(*picture, GetParam().blue_up ? 0.2 : 0.8), 100);
  EXPECT_LT(blueness(*picture, GetParam().blue_up ? 0.8 : 0.2), -100);
}

// The last is the first, with metadata that turn it upside down.
INSTANTIATE_TEST_SUITE_P(Clips, Rotation,
                         ::testing::Values(Clip{"up.mp4", true}, Clip{"portrait_90.mp4", true},
                                           Clip{"portrait_270.mp4", true},
                                           Clip{"up_180.mp4", false}));

/// A JPEG whose metadata (EXIF) tell that it has to be turned clockwise by 90 degrees.
std::string turned_photo() {
  cv::Mat lying(240, 320, CV_8UC3, cv::Scalar(0, 0, 255));
  lying(cv::Rect(0, 0, 107, 240)).setTo(cv::Scalar(255, 0, 0));  // the left third comes to the top
  std::vector<uchar> jpeg;
  cv::imencode(".jpg", lying, jpeg);
  const std::string tiff("Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0",
                         32);
  std::string text(jpeg.begin(), jpeg.end());
  const std::string segment =
      std::string("\xFF\xE1", 2) + '\0' + static_cast<char>(tiff.size() + 2) + tiff;
  return text.substr(0, 2) + segment + text.substr(2);
}

TEST(Photo, IsTurnedAsItsMetadataSay) {
  const chorus::testing::TemporaryFolder folder;
  const auto picture = read_picture(folder.write("photo.jpg", turned_photo()).string());
  ASSERT_TRUE(picture) << to_string(picture.error());
  EXPECT_EQ(picture->size, (Size{240, 320}));
  EXPECT_GT(blueness(*picture, 0.1), 100);
  EXPECT_LT(blueness(*picture, 0.8), -100);
}

}  // namespace
}  // namespace chorus::camera
