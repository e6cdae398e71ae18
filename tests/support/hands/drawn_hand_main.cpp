// chorus-drawn-hand FOLDER [SEED]: writes the scan that comes with the repository, or that of
// another hand, and its truth: FOLDER/scan.png and FOLDER/truth.json.
#include <cstdlib>
#include <fstream>
#include <iostream>

#include <opencv2/imgcodecs.hpp>

#include "tests/support/hands/shipped_scan.h"

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: chorus-drawn-hand FOLDER [SEED]\n";
    return 2;
  }
  const std::string folder = argv[1];
  auto scene = chorus::testing::shipped_scene();
  if (argc == 3) scene.seed = std::strtoull(argv[2], nullptr, 10);
  const auto drawn = chorus::testing::drawn_hand(scene);
  std::ofstream truth(folder + "/truth.json");
  truth << chorus::testing::truth_json(drawn);
  const bool written =
      cv::imwrite(folder + "/scan.png", drawn.picture, {cv::IMWRITE_PNG_COMPRESSION, 9}) &&
      truth.flush();
  if (!written) std::cerr << "chorus-drawn-hand: cannot write into " << folder << '\n';
  return written ? 0 : 1;
}
