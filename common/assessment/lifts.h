// Lifts of a task, measured from the bodies at their two ends (NIOSH lifting equation).
#pragma once

#include <optional>
#include <vector>

#include "common/ergonomics/live.h"
#include "common/ergonomics/niosh.h"
#include "common/ergonomics/task.h"

namespace chorus::assessment {

struct MeasuredLift {
  ergonomics::TaskLift asked;
  ergonomics::Lift origin;
  ergonomics::Lift destination;
  ergonomics::LiftLimit origin_limit;
  ergonomics::LiftLimit destination_limit;
  double index = 0.0;  ///< The worse end's.
};

/// None if the person's hands and ankles are not seen near an end.  Hands are taken to be 8 cm
/// beyond the wrists, along the forearms.
[[nodiscard]] std::optional<MeasuredLift> measured_lift(
    const std::vector<ergonomics::BodyAt>& bodies, const ergonomics::TaskLift& lift,
    Timestamp start);

}  // namespace chorus::assessment
