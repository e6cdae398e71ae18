// Keeps the streams of a recording in step while separate processes play them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/record/cell_outline.h"

namespace chorus::ctl {

/// When the set begins and how long one round of it lasts.
struct Round {
  Timestamp origin;
  Duration period{0};

  bool operator==(const Round&) const = default;
};

struct RoundPlan {
  /// None for a single recording of one sensor, for files of one import (their notes state the
  /// set), and for recordings whose times cannot be related.
  std::optional<Round> round;
  std::string note;  ///< Why the recordings are not in step, for people to read.
};

[[nodiscard]] RoundPlan plan_round(const std::vector<record::SensorStay>& stays);

}  // namespace chorus::ctl
