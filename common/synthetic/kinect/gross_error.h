// Errors that are not noise: legs that merge, bodies that are not there, ids that swap.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/sensor/sensor_frame.h"
#include "common/synthetic/kinect/joint_error.h"

namespace chorus::synthetic::kinect {

/// Before the sensor the far leg disappears behind the near one: the SDK pulls it towards it.
void merge_legs(Skeleton<SensorSpace>& body, const GrossError& gross);

/// A skeleton on furniture, standing still somewhere in view; none most of the time.
[[nodiscard]] std::optional<BodyFrame> ghost(const GrossError& gross, double time,
                                             const ErrorKeys& keys);

/// Which id each person goes by in one sensor; swapped with some probability when two people touch.
class IdBook {
 public:
  IdBook(const ErrorKeys& keys, std::size_t people);
  /// `cores`: trunk positions by person, sensor space; not finite where the person is not seen.
  void look(const std::vector<Eigen::Vector3d>& cores, const GrossError& gross, double time);
  [[nodiscard]] BodyId id_of(std::size_t person) const { return ids_[person]; }

 private:
  ErrorKeys keys_;
  std::vector<BodyId> ids_;
  std::vector<std::vector<bool>> touching_;
};

}  // namespace chorus::synthetic::kinect
