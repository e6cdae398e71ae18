// A webcam, and views of a board through it.
#pragma once

#include "tests/support/boards/board_scene.h"

namespace chorus::calibration {

inline constexpr PictureSize kSize{640, 480};

inline Intrinsics webcam() {
  return {640, 480, 520.0, 524.0, 331.0, 228.0, {0.12, -0.22, 0.001, -0.0015, 0.0}};
}

inline std::vector<View> views_of(const chorus::testing::PoseWishes& wishes, double noise = 0.1) {
  const Board board;
  std::vector<View> views;
  std::uint64_t seed = 100 * wishes.seed;
  for (const auto& pose : chorus::testing::board_poses(board, webcam(), wishes))
    views.push_back(chorus::testing::seen_corners(board, webcam(), pose, noise, ++seed));
  return views;
}

}  // namespace chorus::calibration
