#include "common/characteristics/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/duration.h"

namespace chorus::characteristics {
namespace {

constexpr double kPause = 10.0;  // a gap of more steps than this is a pause, not lost frames

class Widening {
 public:
  void add(double value) {
    least_ = std::min(least_, value);
    most_ = std::max(most_, value);
  }
  [[nodiscard]] Extent extent() const { return least_ <= most_ ? Extent{least_, most_} : Extent{}; }

 private:
  double least_ = std::numeric_limits<double>::infinity();
  double most_ = -std::numeric_limits<double>::infinity();
};

FieldOfView view_of(const OnePerson& person) {
  std::array<Widening, 2> aside;
  std::array<Widening, 2> upwards;
  Widening distance;
  const Eigen::Quaterniond sensor_from_upright = person.upright_from_sensor.conjugate();
  for (const Sight& sight : person.sights) {
    for (const Joint& joint : sight.body.joints) {
      if (!joint.seen()) continue;
      const Eigen::Vector3d at = sensor_from_upright * joint.position;
      const std::size_t guessed = joint.state == JointState::Inferred ? 1 : 0;
      aside.at(guessed).add(std::atan2(at.x(), at.z()));
      upwards.at(guessed).add(std::atan2(at.y(), at.z()));
    }
    if (const auto trunk = trunk_of(sight.body)) distance.add(trunk->norm());
  }
  return {aside[0].extent(), upwards[0].extent(), aside[1].extent(), upwards[1].extent(),
          distance.extent()};
}

Delivery delivery_of(const OnePerson& person) {
  Delivery delivery;
  delivery.step = person.step;
  double squares = 0.0;
  double usual = 0.0;
  double lost = 0.0;
  for (std::size_t i = 1; i < person.frames.size(); ++i) {
    const double step = seconds(person.frames[i] - person.frames[i - 1]);
    delivery.longest_gap = std::max(delivery.longest_gap, step);
    if (step <= kUsualStep * person.step) {
      squares += (step - person.step) * (step - person.step);
      ++usual;
    } else if (step <= kPause * person.step) {
      lost += std::round(step / person.step) - 1.0;
    }
  }
  const double came = static_cast<double>(person.frames.size());
  delivery.step_sigma = usual > 0 ? std::sqrt(squares / usual) : 0.0;
  delivery.lost_share = lost / (lost + came);
  delivery.empty_share = 1.0 - static_cast<double>(person.sights.size()) / came;
  return delivery;
}

}  // namespace

Coverage coverage_of(const OnePerson& person) {
  Coverage coverage{view_of(person), delivery_of(person), {}};
  const double each = 1.0 / static_cast<double>(person.sights.size());
  for (const Sight& sight : person.sights) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Joint& joint = sight.body.joints[j];
      if (!joint.seen()) {
        coverage.joints[j].missing += each;
      } else if (joint.state == JointState::Inferred) {
        coverage.joints[j].inferred += each;
      }
    }
  }
  return coverage;
}

}  // namespace chorus::characteristics
