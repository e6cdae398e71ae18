// chorus-drawn-hand scan FOLDER [SEED]: writes the scan that comes with the repository, or that of
// another hand, and its truth: FOLDER/scan.png and FOLDER/truth.json.
// chorus-drawn-hand glove FOLDER: a black glove that moves before a camera: FOLDER/glove.avi, the
// glove's take without its place (take.bvh), the hand (hand.json), the lens (lens.json), and where
// the hand was (truth.bvh).
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "common/hand/bvh.h"
#include "common/sensor/pixel_ray.h"
#include "tests/support/hands/glove_scene.h"
#include "tests/support/hands/shipped_scan.h"

namespace {

using namespace chorus;

constexpr double kRate = 20.0;  // [Hz]

bool write_file(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  return static_cast<bool>(out.flush());
}

bool write_scan(const std::string& folder, const char* seed) {
  auto scene = testing::shipped_scene();
  if (seed != nullptr) scene.seed = std::strtoull(seed, nullptr, 10);
  const auto drawn = testing::drawn_hand(scene);
  return write_file(folder + "/truth.json", testing::truth_json(drawn)) &&
         cv::imwrite(folder + "/scan.png", drawn.picture, {cv::IMWRITE_PNG_COMPRESSION, 9});
}

bool write_glove(const std::string& folder) {
  const hand::Skeleton skeleton = testing::usual_skeleton();
  const Eigen::Matrix3d axes = camera_from_sensor_axes().transpose();
  cv::VideoWriter video(folder + "/glove.avi", cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kRate,
                        {640, 480});
  std::vector<hand::Pose> take, truth;
  testing::GloveScene scene;
  for (const hand::Pose& pose : testing::moving_hand()) {
    const auto seen = testing::seen_glove(skeleton, scene, pose);
    cv::Mat picture;
    cv::cvtColor(seen.grey, picture, cv::COLOR_GRAY2BGR);
    video.write(picture);
    hand::Pose placed = pose;
    placed.wrist = axes * pose.wrist;
    placed.turn = Eigen::Quaterniond(axes) * pose.turn;
    truth.push_back(placed);
    placed.wrist.setZero();
    take.push_back(placed);
  }
  return video.isOpened() && write_file(folder + "/hand.json", testing::hand_file(skeleton)) &&
         write_file(folder + "/take.bvh", hand::bvh_of(skeleton, take, kRate)) &&
         write_file(folder + "/truth.bvh", hand::bvh_of(skeleton, truth, kRate)) &&
         write_file(folder + "/lens.json",
                    R"({"width":640,"height":480,"fx":600,"fy":600,"cx":319.5,"cy":239.5})");
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  const bool scan = what == "scan" && (argc == 3 || argc == 4),
             glove = what == "glove" && argc == 3;
  if (!scan && !glove) {
    std::cerr << "usage: chorus-drawn-hand scan FOLDER [SEED] | glove FOLDER\n";
    return 2;
  }
  if (scan ? write_scan(argv[2], argc == 4 ? argv[3] : nullptr) : write_glove(argv[2])) return 0;
  std::cerr << "chorus-drawn-hand: cannot write into " << argv[2] << '\n';
  return 1;
}
