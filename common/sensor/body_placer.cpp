#include "common/sensor/body_placer.h"

#include <algorithm>

namespace chorus {
namespace {

constexpr std::uint64_t kRemembered = 1800;  // Frames without the person: a minute at 30 Hz.
constexpr std::size_t kMostPeople = 256;

}  // namespace

void BodyPlacer::place(std::span<BodyFrame> bodies, std::span<const Skeleton<SensorSpace>> shapes,
                       const PlacingErrors& errors) {
  ++frame_;
  for (std::size_t i = 0; i < std::min(bodies.size(), shapes.size()); ++i) {
    if (std::ranges::none_of(shapes[i].joints, &Joint::seen)) continue;
    Person& person = people_[bodies[i].id];
    person.last = frame_;
    person.bones.learn(shapes[i]);
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
