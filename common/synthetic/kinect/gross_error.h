// Errors that are not noise: legs that merge, bodies where nobody is, swapped ids.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/sensor/sensor_frame.h"
#include "common/synthetic/kinect/joint_error.h"

namespace chorus::synthetic::kinect {

/// Where knees, ankles or feet appear closer together than merge_angle, pulls the farther one
/// towards the nearer one and makes it inferred.
void merge_legs(Skeleton<SensorSpace>& body, const GrossError& gross);

/// A skeleton that the SDK sees in a piece of furniture: it stands still somewhere in view. Usually
/// none.
[[nodiscard]] std::optional<BodyFrame> ghost(const GrossError& gross, double time,
                                             const ErrorKeys& keys);

/// The id that one sensor uses for each person.  When two people come to touch each other, their
/// ids are swapped with some probability.
class IdBook {
 public:
  IdBook(const ErrorKeys& keys, std::size_t people);
  /// `cores`: each person's trunk in sensor space; not finite if the person is not seen.
  void look(const std::vector<Eigen::Vector3d>& cores, const GrossError& gross, double time);
  [[nodiscard]] BodyId id_of(std::size_t person) const { return ids_[person]; }

 private:
  ErrorKeys keys_;
  std::vector<BodyId> ids_;
  std::vector<std::vector<bool>> touching_;
};

}  // namespace chorus::synthetic::kinect
