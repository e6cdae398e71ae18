// Of several people in sight, who wears the suit: the one whose limbs the sensors fit
// (evaluation/wearing.h), from the last seconds in which they were tracked together.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/strong_id.h"
#include "common/evaluation/wearing.h"
#include "common/time/timestamp.h"

namespace chorus::evaluation_service {

/// What a person's limbs and the sensors on them say at one instant; sensors by name.
struct WornInstant {
  Timestamp at;
  std::map<PersonId, std::map<inertial::Limb, evaluation::TrackedOrientation>> people;
  std::map<std::string, Eigen::Quaterniond> sensors;
};

class WearerSearch {
 public:
  /// Takes an instant ten times a second, and looks every three seconds.  The person, once one fits
  /// clearly better than the others; `limbs` says where each sensor sits.
  std::optional<PersonId> take(WornInstant instant,
                               const std::map<std::string, inertial::Limb>& limbs);
  /// Why nobody has been found yet; for people.
  [[nodiscard]] const std::string& reason() const { return reason_; }
  void forget();

 private:
  [[nodiscard]] std::optional<PersonId> search(const std::map<std::string, inertial::Limb>& limbs);

  std::vector<WornInstant> instants_;
  std::optional<Timestamp> searched_;
  std::string reason_;
};

}  // namespace chorus::evaluation_service
