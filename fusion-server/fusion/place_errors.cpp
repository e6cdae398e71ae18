#include "fusion-server/fusion/place_errors.h"

#include <algorithm>
#include <cmath>

#include "fusion-server/fusion/joint_view.h"

namespace chorus::fusion {
namespace {

// r of (21): correlation between the places of two sensors along the floor.  Where each errs by as
// much as the master, and independently, half of what each errs by relative to the master is the
// master's.  Heights are relative to the common floor, and independent.
constexpr double kPlacesAlike = 0.5;

/// v x u = crossed(v) u.
Eigen::Matrix3d crossed(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// The views whose places are not exact, with the index of the sensor in FusedBody::shares.
struct OpenView {
  const SensorView* view;
  std::size_t sensor;
};

std::vector<OpenView> open_views(const Person& person, const std::vector<SensorId>& sensors) {
  std::vector<OpenView> open;
  for (const SensorView& view : person.views) {
    if (view.place_covariance.isZero(0.0)) continue;
    const auto at = std::ranges::find(sensors, view.sensor) - sensors.begin();
    const auto index = static_cast<std::size_t>(at);
    if (index < std::min(sensors.size(), kMaxSensors)) open.push_back({&view, index});
  }
  return open;
}

double floor_variance(const Eigen::Matrix3d& covariance) {
  return 0.5 * std::max(0.0, covariance(0, 0) + covariance(2, 2));
}

/// Eq. (21).
Eigen::Matrix3d open_place(const std::vector<OpenView>& views, const Shares& shares,
                           const Eigen::Vector3d& x) {
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero();     // sum of s^2 C
  Eigen::Matrix3d common = Eigen::Matrix3d::Zero();  // sum of s C
  double sigmas = 0.0;
  for (const OpenView& each : views) {
    const double share = shares.of(each.sensor);
    if (!(share > 0)) continue;
    const Eigen::Matrix3d covariance = place_covariance(*each.view, x);
    own += share * share * covariance;
    common += share * covariance;
    sigmas += share * std::sqrt(floor_variance(covariance));
  }
  const double variance = floor_variance(common);
  if (!(variance > 0)) return own;
  const double along = std::sqrt(1.0 - kPlacesAlike);
  const Eigen::DiagonalMatrix<double, 3> independent(along, 1.0, along);
  const Eigen::DiagonalMatrix<double, 3> floor(1.0, 0.0, 1.0);
  return independent * own * independent +
         kPlacesAlike * sigmas * sigmas / variance * (floor * common * floor);
}

}  // namespace

Eigen::Matrix3d place_covariance(const SensorView& view, const Eigen::Vector3d& x) {
  const Eigen::Matrix3d turn = crossed(x - view.eye);
  const Eigen::Matrix3d both = turn * view.place_covariance.topRightCorner<3, 3>();
  return view.place_covariance.bottomRightCorner<3, 3>() - both - both.transpose() +
         turn * view.place_covariance.topLeftCorner<3, 3>() * turn.transpose();
}

void PlaceErrors::add(FusedBody& body, const Person& person, const std::vector<SensorId>& sensors) {
  const std::vector<OpenView> views = open_views(person, sensors);
  if (!any_ && views.empty()) return;
  any_ = true;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Joint& joint = body.skeleton.joints[j];
    if (!joint.seen()) continue;
    if (body.shares[j].known()) last_[j] = open_place(views, body.shares[j], joint.position);
    body.variance[j] += mean_variance(last_[j]);
    if (!joint.covariance.known()) continue;
    joint.covariance = Covariance(Eigen::Matrix3d(joint.covariance.matrix() + last_[j]));
  }
}

}  // namespace chorus::fusion
