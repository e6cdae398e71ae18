// A black glove before a camera, rendered from balls along its bones: not the method's capsules,
// but fingers that bulge at their joints, a thicker palm with a ball of the thumb, other widths.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "common/hand/bvh.h"
#include "common/sensor/camera_image.h"

namespace chorus::testing {

struct GloveScene {
  std::uint64_t seed = 1;
  double distance = 0.6;      ///< Of the palm from the camera [m].
  double tilt = 0.0;          ///< Most that the palm is turned away from the camera [rad].
  double size = 1.0;          ///< Of the true hand, relative to the skeleton the method is given.
  double finger_error = 0.0;  ///< Standard deviation of the glove's joint angles [rad].
  bool clutter = false;       ///< Dark things in view, smaller than the hand.
};

struct SeenGlove {
  cv::Mat grey;
  Intrinsics camera;
  hand::Pose pose;                                  ///< As the glove tells it.
  Eigen::Vector3d wrist = Eigen::Vector3d::Zero();  ///< The truth [m].
};

/// `posed`: the true pose in the camera's axes; none: drawn from the scene's seed.
[[nodiscard]] SeenGlove seen_glove(const hand::Skeleton& skeleton, const GloveScene& scene,
                                   const std::optional<hand::Pose>& posed = {});

/// A hand that moves before the camera for two seconds at 20 Hz, in the camera's axes.
[[nodiscard]] std::vector<hand::Pose> moving_hand();

/// The .json of this skeleton, as `chorus scan` writes it.
[[nodiscard]] std::string hand_file(const hand::Skeleton& skeleton);

/// A right hand of usual proportions, as a scan would give it.
[[nodiscard]] hand::Skeleton usual_skeleton();

}  // namespace chorus::testing
