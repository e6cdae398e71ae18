#include "fusion-server/registration/floor_prior.h"

namespace chorus::registration {

void Normal::add(const Row6& row, double residual, double weight) {
  information += weight * row.transpose() * row;
  right += weight * row.transpose() * residual;
}

void add_prior(Normal& normal, const FloorPrior& prior, const Eigen::Isometry3d& target_from_source,
               const Eigen::Vector3d& centre_in_source) {
  if (prior.tilt > 0) {
    const Eigen::Vector3d up = target_from_source.linear() * Eigen::Vector3d::UnitY();
    const double weight = 1.0 / (prior.tilt * prior.tilt);
    Row6 along_x = Row6::Zero();
    along_x << 0, up.z(), -up.y(), 0, 0, 0;
    Row6 along_z = Row6::Zero();
    along_z << up.y(), -up.x(), 0, 0, 0, 0;
    normal.add(along_x, -up.x(), weight);
    normal.add(along_z, -up.z(), weight);
  }
  if (prior.height > 0) {
    const Eigen::Vector3d below(centre_in_source.x(), 0, centre_in_source.z());
    const Eigen::Vector3d q = target_from_source * below;
    Row6 row;
    row << -q.z(), 0, q.x(), 0, 1, 0;
    normal.add(row, -q.y(), 1.0 / (prior.height * prior.height));
  }
}

}  // namespace chorus::registration
