// The device `camera` with a video file made here and the stand-in runner, which finds red areas.
#include "services/sensor/device/camera/camera.h"

#include <condition_variable>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/videoio.hpp>

#include "tests/support/builders.h"
#include "tests/support/served.h"
#include "tests/support/temporary_folder.h"

namespace chorus::camera {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kRate = 25.0;
constexpr int kPictures = 25;
constexpr double kFocal = 300.0;

/// Centre of the red square in picture i [px from the left edge]; it moves to the right by 8 px per
/// picture.
double red_at(int i) { return 60.0 + 8.0 * i; }

/// Writes a Motion JPEG video: a red square moves to the right, and a blue one stands still.
void make_video(const std::string& path) {
  cv::VideoWriter writer(path, cv::CAP_OPENCV_MJPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                         kRate, {kWidth, kHeight});
  ASSERT_TRUE(writer.isOpened());
  for (int i = 0; i < kPictures; ++i) {
    cv::Mat picture(kHeight, kWidth, CV_8UC3, cv::Scalar(60, 60, 60));
    picture(cv::Rect(20, 20, 40, 40)) = cv::Scalar(255, 0, 0);
    picture(cv::Rect(static_cast<int>(red_at(i)) - 20, 100, 40, 40)) = cv::Scalar(0, 0, 255);
    writer.write(picture);
  }
}

/// The device in a thread of its own, and what it delivers.
class Rig {
 public:
  Rig() { make_video(video_); }
  ~Rig() { stop(); }
  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  nlohmann::json section(std::vector<std::string> runner_options = {}) const {
    std::vector<std::string> runner{"python3", "-B", "tests/support/stand_in_runner.py"};
    runner.insert(runner.end(), runner_options.begin(), runner_options.end());
    return {{"source", video_},
            {"runner", runner},
            {"model", ""},
            {"intrinsics",
             {{"width", kWidth},
              {"height", kHeight},
              {"fx", kFocal},
              {"fy", kFocal},
              {"cx", 159.5},
              {"cy", 119.5}}}};
  }
  Result<std::unique_ptr<FrameSource>> make(const nlohmann::json& section) {
    auto reader = ConfigReader::parse(section.dump(), "test");
    const sensor_service::HostTime time{std::make_shared<SystemClock>()};
    return make_camera(*reader, {chorus::testing::sensor_id("s1"), time, router_});
  }
  void start(const nlohmann::json& section) {
    auto made = make(section);
    ASSERT_TRUE(made) << to_string(made.error());
    device_ = std::move(*made);
    running_ = std::jthread([this](const std::stop_token& stop) {
      const auto ended = device_->run(stop, [this](Capture capture) { take(std::move(capture)); });
      EXPECT_TRUE(ended);
      const std::lock_guard lock(mutex_);
      over_ = true;
      changed_.notify_all();
    });
  }
  void stop() { running_ = {}; }
  /// Waits until `least` captures have come, the device has ended or `patience` is over; returns
  /// all captures so far.
  std::vector<Capture> captures(std::size_t least, Duration patience = 20s) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, patience, [&] { return captures_.size() >= least || over_; });
    return captures_;
  }
  bool over(Duration patience = 20s) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, patience, [&] { return over_; });
  }
  FrameSource& device() { return *device_; }
  nlohmann::json status() {
    return nlohmann::json::parse(chorus::testing::get(router_, "/camera").body);
  }
  const std::string& video() const { return video_; }
  template <class Condition>
  bool eventually(const Condition& condition) {
    const auto until = std::chrono::steady_clock::now() + 20s;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > until) return false;
      std::this_thread::sleep_for(20ms);
    }
    return true;
  }

 private:
  void take(Capture capture) {
    const std::lock_guard lock(mutex_);
    captures_.push_back(std::move(capture));
    changed_.notify_all();
  }

  chorus::testing::TemporaryFolder folder_;
  std::string video_ = (folder_ / "walk.avi").string();
  http::Router router_;
  std::unique_ptr<FrameSource> device_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Capture> captures_;
  bool over_ = false;
  std::jthread running_;
};

const Joint& head_of(const Capture& capture) {
  return capture.frame.bodies.at(0).skeleton.joints[index_of(JointId::Head)];
}

/// The number of the video's picture whose red square is where the head's ray points.
double picture_seen(const Capture& capture) {
  const Eigen::Vector3d ray = head_of(capture).position;
  const double u = 160.0 - kFocal * ray.x() / ray.z();  // the sensor's x points left
  return (u - red_at(0)) / (red_at(1) - red_at(0));
}

TEST(Camera, WhatIsRedInTheVideoIsARayAtTheTimeOfItsPicture) {
  Rig rig;
  auto section = rig.section();
  section["loop"] = false;
  const Timestamp began = SystemClock().now();
  rig.start(section);
  ASSERT_TRUE(rig.over()) << "a file that does not loop comes to its end";
  const auto captures = rig.captures(1);
  ASSERT_GT(captures.size(), 5u);
  const double offset =
      seconds(captures[0].frame.captured - began) - picture_seen(captures[0]) / kRate;
  for (const Capture& capture : captures) {
    ASSERT_EQ(capture.frame.bodies.size(), 1u);
    EXPECT_TRUE(head_of(capture).bears());
    EXPECT_NEAR(head_of(capture).position.y(), 0.0, 0.02);
    EXPECT_TRUE(head_of(capture).covariance.known());
    const double at = seconds(capture.frame.captured - began) - offset;
    EXPECT_NEAR(at * kRate, picture_seen(capture), 0.6);
    EXPECT_GE(capture.frame.received, capture.frame.captured);
  }
  for (std::size_t i = 1; i < captures.size(); ++i) {
    EXPECT_GT(captures[i].frame.captured, captures[i - 1].frame.captured);
    EXPECT_GT(captures[i].frame.sequence, captures[i - 1].frame.sequence);
  }
}

TEST(Camera, AGuessedFieldOfViewMakesRaysLessSureAwayFromTheMiddle) {
  Rig rig;
  auto section = rig.section();
  section.erase("intrinsics");
  section["loop"] = false;
  rig.start(section);
  ASSERT_TRUE(rig.over());
  const auto captures = rig.captures(1);
  const auto middle_first = [](const Capture& a, const Capture& b) {
    return head_of(a).position.z() > head_of(b).position.z();
  };
  const auto [middle, edge] = std::minmax_element(captures.begin(), captures.end(), middle_first);
  ASSERT_GT(std::abs(head_of(*edge).position.x()), 0.2);
  EXPECT_GT(head_of(*edge).covariance.matrix().trace(),
            1.2 * head_of(*middle).covariance.matrix().trace());
}

TEST(Camera, AFileStartsAgainAndItsTimesGoOn) {
  Rig rig;
  rig.start(rig.section());
  const auto wrapped = [&] {
    const auto captures = rig.captures(0);
    for (std::size_t i = 1; i < captures.size(); ++i)
      if (picture_seen(captures[i]) < picture_seen(captures[i - 1])) return true;
    return false;
  };
  EXPECT_TRUE(rig.eventually(wrapped));
  const auto captures = rig.captures(1);
  for (std::size_t i = 1; i < captures.size(); ++i)
    EXPECT_GT(captures[i].frame.captured, captures[i - 1].frame.captured);
  EXPECT_EQ(rig.device().trouble(), "");
  const auto status = rig.status();
  EXPECT_EQ(status["state"], "live");
  EXPECT_EQ(status["runner"]["name"], "stand-in");
  EXPECT_EQ(status["runner"]["size"]["width"], 64);
  EXPECT_EQ(status["pictures"]["size"]["width"], kWidth);
}

TEST(Camera, PicturesAreServedWhole) {
  Rig rig;
  rig.start(rig.section());
  const auto captures = rig.captures(1);
  ASSERT_FALSE(captures.empty());
  const auto image = captures[0].color();
  ASSERT_TRUE(image);
  EXPECT_EQ(image->media_type, "image/jpeg");
  EXPECT_TRUE(image->bytes.starts_with("\xff\xd8"));
  EXPECT_EQ(image->intrinsics.width, kWidth);
  EXPECT_EQ(image->captured, captures[0].frame.captured);
}

TEST(Camera, NoMorePicturesAreLookedAtThanAsked) {
  Rig rig;
  auto section = rig.section();
  section["max_rate_hz"] = 5;
  rig.start(section);
  const auto captures = rig.captures(5);
  ASSERT_GE(captures.size(), 5u);
  EXPECT_GE(captures[4].frame.captured - captures[0].frame.captured, 640ms);
}

TEST(Camera, ARunnerThatDiesIsStartedAgainAndItsReasonTold) {
  Rig rig;
  rig.start(rig.section({"--die-after", "2"}));
  const auto told = [&] {
    return rig.device().trouble().find("has had enough") != std::string::npos;
  };
  EXPECT_TRUE(rig.eventually(told)) << rig.device().trouble();
  EXPECT_EQ(rig.status()["state"], "no runner");
  EXPECT_GE(rig.captures(4).size(), 4u);
  EXPECT_GE(rig.status()["runner"]["started"], 2);
}

TEST(Camera, ALensForAnotherShapeIsNotBlamedOnTheRunner) {
  Rig rig;
  auto section = rig.section();
  section["intrinsics"] = {{"width", kWidth}, {"height", 2 * kHeight},
                           {"fx", 100.0},     {"fy", 100.0},
                           {"cx", 1.0},       {"cy", 1.0}};
  rig.start(section);
  EXPECT_TRUE(rig.eventually([&] { return rig.status()["state"] == "wrong lens"; }))
      << rig.status();
  EXPECT_GE(rig.status()["runner"]["started"], 1);
  EXPECT_NE(rig.status()["reason"].get<std::string>().find("is for pictures of"),
            std::string::npos);
}

TEST(Camera, WhatWouldNotWorkIsFoundWithoutRunning) {
  const auto concern = [](const char* key, const nlohmann::json& value) -> std::string {
    Rig rig;
    auto section = rig.section();
    if (key != nullptr) section[key] = value;
    const auto device = rig.make(section);
    const auto concerns = device ? (*device)->concerns() : std::vector<std::string>{"not made"};
    EXPECT_LE(concerns.size(), 1u);
    return concerns.empty() ? "" : concerns[0];
  };
  EXPECT_EQ(concern(nullptr, {}), "");
  EXPECT_NE(concern("runner", {"nosuchprogram"}).find("nosuchprogram"), std::string::npos);
  EXPECT_NE(concern("runner", {"python3", "-c", "import sys; sys.exit(3)"}), "");
  EXPECT_NE(concern("source", "docs/guide/cameras.md").find("is it a video?"), std::string::npos);
  EXPECT_NE(concern("source", "/dev/no-such-camera").find("is it plugged in?"), std::string::npos);
  nlohmann::json tall = Rig().section()["intrinsics"];
  tall["height"] = 2 * kHeight;
  EXPECT_NE(concern("intrinsics", tall).find("is for pictures of"), std::string::npos);
}

TEST(Camera, ARunnerThatAnswersAnotherImageIsNotBelieved) {
  Rig rig;
  rig.start(rig.section({"--lie"}));
  const auto told = [&] {
    return rig.device().trouble().find("sequence: must be") != std::string::npos;
  };
  EXPECT_TRUE(rig.eventually(told));
  EXPECT_TRUE(rig.captures(1, 0s).empty());
}

TEST(Camera, ASourceThatComesLaterIsTold) {
  Rig rig;
  auto section = rig.section();
  section["source"] = "/dev/no-such-camera";
  rig.start(section);
  const auto told = [&] {
    return rig.device().trouble().find("is it plugged in?") != std::string::npos;
  };
  EXPECT_TRUE(rig.eventually(told));
  EXPECT_EQ(rig.status()["state"], "no pictures");
}

TEST(Camera, StoppingIsQuickWhileARunnerIsSilent) {
  Rig rig;
  rig.start(rig.section({"--silent"}));
  std::this_thread::sleep_for(300ms);
  const auto began = std::chrono::steady_clock::now();
  rig.stop();
  EXPECT_LT(std::chrono::steady_clock::now() - began, 5s);
}

TEST(Camera, WhatCannotWorkIsSaidAtTheStart) {
  Rig rig;
  const auto refusal = [&](const char* key, const nlohmann::json& value) {
    auto section = rig.section();
    section[key] = value;
    const auto made = rig.make(section);
    return made ? "" : to_string(made.error());
  };
  EXPECT_THAT(refusal("source", "no-such.mp4"), HasSubstr("there is no such file"));
  EXPECT_EQ(refusal("source", "rtsp://127.0.0.1:1/none"), "");
}

TEST(Camera, AnotherShapeThanTheLensIsForIsTold) {
  Rig rig;
  auto section = rig.section();
  section["intrinsics"]["width"] = 640;
  rig.start(section);
  const auto told = [&] {
    return rig.device().trouble().find("640 x 240, and the source gives 320 x 240") !=
           std::string::npos;
  };
  EXPECT_TRUE(rig.eventually(told)) << rig.device().trouble();
}

}  // namespace
}  // namespace chorus::camera
