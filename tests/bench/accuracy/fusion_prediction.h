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

/// Predictions: mean joint error 50 and 100 ms after each instant, of the filter's prediction
/// ("ours"), of the pose as it was ("hold") and of velocities from instant to instant ("steps");
/// the error after 0.5 and 1 s in which nobody sees the person; nees of ours.  Silence: in the
/// second after a sensor has fallen silent, the largest difference between a joint's change from
/// one instant to the next and the true change (step_mm; "living": the same had the sensor gone
/// on), or the change had the sensor gone on (caused_mm).
void measure_prediction(Report& report, const PredictionCase& each);

}  // namespace chorus::bench
