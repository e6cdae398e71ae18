// Many views of each person -> one body each, by the configured method and its memory.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "fusion-server/flow.h"
#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"
#include "fusion-server/fusion/methods.h"

namespace chorus::fusion {

/// One estimator per person and method.  A value: a copy remembers the same and then goes its own
/// way.
class Memory {
 public:
  Memory() = default;
  Memory(const Memory& other);
  Memory& operator=(const Memory& other);
  Memory(Memory&&) noexcept = default;
  Memory& operator=(Memory&&) noexcept = default;
  ~Memory() = default;

  /// One body per person, in their order, each by method_for it.  When the configuration changes,
  /// everybody is forgotten.
  [[nodiscard]] std::vector<FusedBody> fuse(const std::vector<Person>& people,
                                            const Instant& instant, const FusionConfig& config);
  /// Forgets people who are no longer tracked.
  void keep_only(const std::set<PersonId>& tracked);

 private:
  FusionConfig config_;
  std::map<std::pair<PersonId, Method>, std::unique_ptr<Estimator>> estimators_;
};

/// One instant by itself, as a method without memories answers it.  The order of the views affects
/// rounding only.
[[nodiscard]] FusedBody fuse(const Person& person, const std::vector<SensorId>& sensors,
                             const FusionConfig& config);

}  // namespace chorus::fusion
