// What fusion states about the time after its last instant, and what happens to a body when a
// sensor falls silent.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/methods/contest.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {

struct PredictionCase {
  std::string name;
  Contest contest;
  /// One sensor falls silent in the middle of the draw; otherwise bodies are predicted.
  bool silence = false;
  std::size_t draws = 20;
};

/// "prediction-PROFILE", "silence-6-PROFILE", "silence-3-PROFILE".
[[nodiscard]] std::vector<PredictionCase> prediction_cases();

/// Predictions: the mean joint error 50 and 100 ms after each instant.  Compared are the filter's
/// prediction ("ours"), the pose as it was ("hold") and velocities from instant to instant
/// ("steps").  Also the error after 0.5 and 1 s in which nobody sees the person, and nees of ours.
///
/// Silence: looks at the second after a sensor has fallen silent, and at how a joint changes from
/// one instant to the next.  step_mm: the largest difference of this change from the true one; row
/// "living": the same if the sensor had not fallen silent.  caused_mm: the largest difference
/// between the changes with and without the silence.
void measure_prediction(Report& report, const PredictionCase& each);

}  // namespace chorus::bench
