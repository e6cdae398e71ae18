#include "fusion-server/fusion/fuse.h"

#include <utility>

namespace chorus::fusion {

Memory::Memory(const Memory& other) : config_(other.config_) {
  for (const auto& [key, estimator] : other.estimators_) {
    estimators_.emplace(key, estimator->clone());
  }
}

Memory& Memory::operator=(const Memory& other) {
  if (this != &other) *this = Memory(other);
  return *this;
}

std::vector<FusedBody> Memory::fuse(const std::vector<Person>& people, const Instant& instant,
                                    const FusionConfig& config) {
  if (!(config == config_)) estimators_.clear();
  config_ = config;
  std::vector<FusedBody> bodies;
  for (const Person& person : people) {
    const Method method = method_for(person, config);
    auto& estimator = estimators_[{person.id, method}];
    if (!estimator) estimator = begin(method, config);
    bodies.push_back(estimator->fuse(person, instant));
    bodies.back().sides_confidence = person.sides_confidence;
  }
  return bodies;
}

void Memory::keep_only(const std::set<PersonId>& tracked) {
  std::erase_if(estimators_,
                [&](const auto& entry) { return !tracked.contains(entry.first.first); });
}

FusedBody fuse(const Person& person, const std::vector<SensorId>& sensors,
               const FusionConfig& config) {
  return begin(method_for(person, config), config)->fuse(person, {Timestamp{}, sensors});
}

}  // namespace chorus::fusion
