// The sizes of the misfits of one person's views (view_misfit.h), estimated while the person is
// seen.
//
// If a sensor measures every body correctly, allowing for a misfit would waste what the sensor
// measures of size and direction.  So the configured sizes are only the start of the estimate
// (docs/papers/body.md (13)).  It is EM over all views, where the expected square of a misfit is
// its own square plus its variance:
//   sigma^2 = mean (m^2 + var m),   faded over some seconds
#pragma once

#include <span>

#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/view_misfit.h"

namespace chorus::fusion {

class MisfitSize {
 public:
  /// Takes the misfits of an instant, `passed` [s] after the previous one.
  void learn(std::span<const Misfit> misfits, double passed, const BodyModel& model);
  /// The model with the sizes found so far; parts that are switched off stay off.
  [[nodiscard]] BodyModel found(BodyModel model) const;

 private:
  /// A mean square; its start value counts as much as a second of evidence.
  struct Square {
    double weight = 0.0;  ///< [s]
    double value = 0.0;
    void learn(double sum, double count, double passed, double start);
  };
  Square scale_;
  Square turn_;
};

}  // namespace chorus::fusion
