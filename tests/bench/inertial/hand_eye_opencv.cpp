#include "tests/bench/inertial/hand_eye_opencv.h"

#include <algorithm>
#include <vector>

#include <opencv2/calib3d.hpp>

#include "common/geometry/rotation.h"

namespace chorus::bench {
namespace {

using evaluation::OrientationPairs;
using evaluation::ParkCalibration;

cv::Mat opencv_matrix(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d r = q.toRotationMatrix();
  cv::Mat out(3, 3, CV_64F);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) out.at<double>(i, k) = r(i, k);
  return out;
}

}  // namespace

/// OpenCV's calibrateHandEye (Park): gripper = limb in the world, target = the inertial world seen
/// from the sensor; it returns limb_from_sensor.  It takes every pair of poses, so at most 60.
std::optional<ParkCalibration> hand_eye_by_opencv(const OrientationPairs& pairs) {
  constexpr std::size_t kMostPoses = 60;
  const std::size_t step = std::max<std::size_t>(1, pairs.size() / kMostPoses);
  std::vector<cv::Mat> world_from_limb, sensor_from_inertial, zeros;
  for (std::size_t i = 0; i < pairs.size(); i += step) {
    world_from_limb.push_back(opencv_matrix(pairs[i].tracked.world_from_limb));
    sensor_from_inertial.push_back(opencv_matrix(pairs[i].inertial_from_sensor.conjugate()));
    zeros.push_back(cv::Mat::zeros(3, 1, CV_64F));
  }
  cv::Mat rotation, translation;
  try {
    cv::calibrateHandEye(world_from_limb, zeros, sensor_from_inertial, zeros, rotation, translation,
                         cv::CALIB_HAND_EYE_PARK);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  Eigen::Matrix3d r;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) r(i, k) = rotation.at<double>(i, k);
  if (!r.allFinite()) return std::nullopt;
  ParkCalibration out;
  out.limb_from_sensor = normalised_or_identity(Eigen::Quaterniond(r));
  // q^G as the mean over the window of q^T q^L conj(q^I).
  std::vector<Eigen::Quaterniond> each;
  for (const auto& pair : pairs)
    each.push_back(pair.tracked.world_from_limb * out.limb_from_sensor *
                   pair.inertial_from_sensor.conjugate());
  out.world_from_inertial = weighted_lerp(each, std::vector<double>(each.size(), 1.0));
  return out;
}

}  // namespace chorus::bench
