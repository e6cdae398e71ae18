// What worn inertial sensors say of people's limbs at a common instant.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/flow/person.h"

namespace chorus {

/// By who wears the sensors.
using WornPeople = std::map<PersonId, std::vector<WornLimb>>;

/// Sets Person::worn of everybody who is seen and wears sensors.
inline void dress(std::vector<Person>& people, const WornPeople& worn) {
  for (Person& person : people) {
    const auto own = worn.find(person.id);
    if (own != worn.end() && !person.carried) person.worn = own->second;
  }
}

/// Which of the view's joints have no depth, as limb_fit() wants it: the line of sight to a body of
/// rays, else zero.
[[nodiscard]] inline Eigen::Vector3d sight_without_depth(const SensorView& view) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Joint& joint : view.skeleton.joints) {
    if (joint.bears()) sum += joint.position;
  }
  return sum.norm() > 0 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d::Zero();
}

}  // namespace chorus
