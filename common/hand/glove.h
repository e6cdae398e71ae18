// Where a glove is whose pose its own sensors tell, seen by one calibrated camera (Madaras et
// al., 3.6).
//
// The camera's axes: x right, y down, z ahead; its picture is free of distortion (fx, fy, cx, cy
// count).  Every frame begins from the same default place, so that nothing needs to be found again
// after a loss.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/hand/bvh.h"
#include "common/hand/skeleton.h"
#include "common/sensor/camera_image.h"

namespace cv {
class Mat;
}

namespace chorus::hand {

struct GloveOptions {
  int darkest =
      70;          ///< Pixels up to this grey level are glove (3.6: "a constant threshold value").
  int median = 5;  ///< Side of the median filter [px].
  int iterations = 6;  ///< Of Eqs. (3) and (4); 5.4 used six.
  bool refine = true;  ///< Then the silhouette of the hand's capsules (3.6's second step).
  Eigen::Vector3d start{0.0, 0.0, 0.8};  ///< The default place of the wrist [m].
  double size_sigma = 0.01;              ///< Relative standard deviation of the skeleton's size.
};

/// What the glove is and how it is held.
struct PosedGlove {
  Skeleton skeleton;
  Pose pose;  ///< Its place does not matter.
};

struct GlovePlace {
  Eigen::Vector3d wrist = Eigen::Vector3d::Zero();       ///< In the camera's axes [m].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2]
  double facing = 1.0;    ///< Cosine between the palm's normal and the line of sight; 0: edge-on.
  double residual = 0.0;  ///< Median distance between the outlines [px]; NaN without refinement.
};

/// The circle inscribed in a mask, centre and radius to a fraction of a pixel; none in an empty
/// mask.
struct Circle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0.0;
};
[[nodiscard]] std::optional<Circle> inscribed(const cv::Mat& mask);

/// The glove's pixels: the darkest region, median filtered, the piece with the largest inscribed
/// circle.
[[nodiscard]] cv::Mat glove_mask(const cv::Mat& grey, const GloveOptions& options);

/// The hand's silhouette: tapered capsules along the fingers, and the palm's.  255: hand.
[[nodiscard]] cv::Mat silhouette(const Skeleton& skeleton, const Pose& pose,
                                 const Intrinsics& camera);

/// The pose: turn and local rotations as the glove tells them, in the camera's axes; its place does
/// not matter.  NotFound when nothing dark is in the picture; InvalidArgument for a pose or
/// skeleton that is not finite.
[[nodiscard]] Result<GlovePlace> place_glove(const cv::Mat& mask, const PosedGlove& glove,
                                             const Intrinsics& camera,
                                             const GloveOptions& options = {});

/// Whether pose and skeleton are some; what to answer if not; how the palm is turned to the camera.
[[nodiscard]] bool is_usable(const PosedGlove& glove);
[[nodiscard]] tl::unexpected<Error> no_pose();
[[nodiscard]] double facing_of(const PosedGlove& glove, const Eigen::Vector3d& wrist);

}  // namespace chorus::hand
