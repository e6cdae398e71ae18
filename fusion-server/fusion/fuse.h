// Fuses the views of each person into one body, by the configured method and its memory.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/person.h"
#include "fusion-server/fusion/estimator.h"
#include "fusion-server/fusion/fusion_config.h"
#include "fusion-server/fusion/inertial_limbs.h"
#include "fusion-server/fusion/methods.h"
#include "fusion-server/fusion/place_errors.h"
#include "fusion-server/fusion/source_fade.h"

namespace chorus::fusion {

/// One estimator per person and method.  A value type: a copy starts with the same memory and from
/// then on is independent.
class Memory {
 public:
  Memory() = default;
  Memory(const Memory& other);
  Memory& operator=(const Memory& other);
  Memory(Memory&&) noexcept = default;
  Memory& operator=(Memory&&) noexcept = default;
  ~Memory() = default;

  /// One body per person, in the order of `people`, each fused by the method that method_for()
  /// returns; somebody who was fused from several sources just now keeps the configured method.  A
  /// person whom no sensor sees is carried: predicted if the method can do that, otherwise moved in
  /// their last pose.  When the configuration changes, all memory is cleared.
  [[nodiscard]] std::vector<FusedBody> fuse(const std::vector<Person>& people,
                                            const Instant& instant, const FusionConfig& config);
  void forget(PersonId person);
  /// Forgets people who are no longer tracked.
  void keep_only(const std::set<PersonId>& tracked);

 private:
  /// A person's fused body at the last instant at which a sensor saw the person.
  struct Last {
    FusedBody body;
    Timestamp at;
    Method method = {};
  };
  /// A person as last published, by this method.
  struct Published {
    PlacedBody places;
    Timestamp at;
    Method method = {};
    SourceFade fade = {};
  };
  [[nodiscard]] FusedBody fuse(const Person& person, const Instant& instant);
  [[nodiscard]] FusedBody fuse_by(Method method, const Person& person, const Instant& instant);
  void hand_over(FusedBody& body, Method method, Timestamp instant);

  FusionConfig config_;
  std::map<PersonId, Published> published_;
  std::map<PersonId, Last> last_;
  std::map<PersonId, Timestamp> several_;  ///< When method_for() last returned the configured
                                           ///< method.
  std::map<PersonId, PlaceErrors> place_errors_;
  std::map<PersonId, InertialLimbs> limbs_;  ///< Only of people whom inertial sensors may steer.
  std::map<std::pair<PersonId, Method>, std::unique_ptr<Estimator>> estimators_;
};

/// Fuses one instant by itself, as a method does while its memory is empty.  The order of the views
/// affects rounding only.
[[nodiscard]] FusedBody fuse(const Person& person, const std::vector<SensorId>& sensors,
                             const FusionConfig& config);

}  // namespace chorus::fusion
