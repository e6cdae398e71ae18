// Camera images as encoded bytes, with the intrinsics needed to measure in them.
#pragma once

#include <array>
#include <string>

#include "common/time/timestamp.h"

namespace chorus {

enum class LensModel {
  Brown,    ///< Pinhole with Brown's distortion.
  Fisheye,  ///< Kannala and Brandt (2006): radius f (a + k1 a^3 + k2 a^5 + k3 a^7 + k4 a^9) at the
            ///< angle a from the axis, as OpenCV's cv::fisheye.
};

/// In OpenCV's order; pixels.
struct Intrinsics {
  int width = 512;
  int height = 424;
  double fx = 366.3;  ///< Kinect v2 depth camera, measured on recordings.
  double fy = 366.3;
  double cx = 259.8;
  double cy = 205.6;
  std::array<double, 5> distortion{};  ///< k1 k2 p1 p2 k3; of a fisheye k1 k2 k3 k4 0.
  LensModel model = LensModel::Brown;

  bool operator==(const Intrinsics&) const = default;
};

struct CameraImage {
  Timestamp captured;
  Intrinsics intrinsics;
  /// "image/jpeg" (colour) or "image/png" (depth: 16 bit, millimetres, 0: not measured).
  std::string media_type;
  std::string bytes;
};

}  // namespace chorus
