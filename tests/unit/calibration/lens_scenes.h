// A webcam, and views of a board through it.
#pragma once

#include "tests/support/boards/board_scene.h"

namespace chorus::calibration {

inline constexpr PictureSize kSize{640, 480};

inline Intrinsics webcam() {
  return {640, 480, 520.0, 524.0, 331.0, 228.0, {0.12, -0.22, 0.001, -0.0015, 0.0}};
}

/// A lens of 150 degrees across its diagonal.
inline Intrinsics fisheye() {
  return {640,
          480,
          305.0,
          304.0,
          322.0,
          236.0,
          {-0.012, 0.006, -0.004, 0.0008, 0.0},
          LensModel::Fisheye};
}

inline std::vector<View> views_of(const chorus::testing::PoseWishes& wishes, double noise = 0.1,
                                  const Intrinsics& lens = webcam()) {
  const Board board;
  std::vector<View> views;
  std::uint64_t seed = 100 * wishes.seed;
  for (const auto& pose : chorus::testing::board_poses(board, lens, wishes))
    views.push_back(chorus::testing::seen_corners(board, lens, pose, noise, ++seed));
  return views;
}

}  // namespace chorus::calibration
