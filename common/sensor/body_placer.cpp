#include "common/sensor/body_placer.h"

#include <algorithm>

namespace chorus {
namespace {

// A person who is missing in this many frames (5 s at 30 Hz) is forgotten, because a device that
// starts counting people again gives the id to somebody else.
constexpr std::uint64_t kRemembered = 150;
constexpr std::size_t kMostPeople = 256;

/// The joints of the shape that the camera sees, which are those with a ray; the model invents the
/// others.
Skeleton<SensorSpace> in_view(Skeleton<SensorSpace> shape, const Skeleton<SensorSpace>& rays) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!rays.joints[j].bears()) shape.joints[j] = {};
  }
  return shape;
}

}  // namespace

void BodyPlacer::place(std::span<BodyFrame> bodies, std::span<const Skeleton<SensorSpace>> shapes,
                       const PlacingErrors& errors) {
  ++frame_;
  for (std::size_t i = 0; i < std::min(bodies.size(), shapes.size()); ++i) {
    if (std::ranges::none_of(shapes[i].joints, &Joint::seen)) continue;
    Person& person = people_[bodies[i].id];
    person.last = frame_;
    person.bones.learn(in_view(shapes[i], bodies[i].skeleton));
    if (auto placed = place_body(bodies[i].skeleton, person.bones.applied(shapes[i]), errors))
      bodies[i].skeleton = *placed;
  }
  forget();
}

void BodyPlacer::forget() {
  std::erase_if(people_,
                [this](const auto& one) { return frame_ - one.second.last > kRemembered; });
  while (people_.size() > kMostPeople)
    people_.erase(
        std::ranges::min_element(people_, {}, [](const auto& one) { return one.second.last; }));
}

}  // namespace chorus
