// What no tracker sees and is therefore asked: loads, grips, repetition.  Nothing here is guessed;
// what nobody answered stays empty and makes a score a range.
#pragma once

#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "common/base/result.h"

namespace chorus::ergonomics {

enum class Coupling { Good, Fair, Poor, Unacceptable };
enum class Wrist { Measured, Straight, Bent };

struct Asked {
  std::optional<double> load_kg = {};
  std::optional<bool> shock = {};  ///< Shock or rapid build-up of force.
  std::optional<Coupling> coupling = {};
  /// Where the wrist comes from; empty: measured, and unknown where the hand is not seen.
  std::optional<Wrist> wrist = {};
  std::optional<bool> wrist_twisted = {};     ///< Near the end of its twisting range; deviated.
  std::optional<bool> arm_supported = {};     ///< Or the person leans.
  std::optional<bool> held_over_minute = {};  ///< A body part is static for over a minute.
  std::optional<bool> repeated = {};          ///< More than four times a minute.
  std::optional<bool> unstable = {};          ///< Rapid large changes of posture, unstable base.

  bool operator==(const Asked&) const = default;
};

/// From this on a load is taken for newtons by mistake [kg].
inline constexpr double kMostLoad = 300.0;

/// Reads the fields loadKg, shock, coupling, wrist, wristTwisted, armSupported, heldOverMinute,
/// repeated, unstable; those of other names are left to the caller.  InvalidArgument names the
/// field: a load below zero or above kMostLoad, an unknown word.
[[nodiscard]] Result<Asked> read_asked(const nlohmann::json& fields, const std::string& where);
[[nodiscard]] bool is_asked_field(const std::string& name);

/// `over` where it has answers, else `under`.
[[nodiscard]] Asked merged(const Asked& under, const Asked& over);

}  // namespace chorus::ergonomics
