// How large the misfits of the views of one person are (view_misfit.h), found while they are seen.
//
// A sensor that has every body right should not be allowed a misfit, because that gives away what
// it knows of size and direction.  So the configured sizes are only where the estimate starts.  By
// EM, over all views, with the expectation of a misfit's square being its own square and its
// variance:
//   sigma^2 = mean (m^2 + var m),   faded over some seconds                   docs/papers/body.md
//   (13)
#pragma once

#include <span>

#include "fusion-server/fusion/body_model.h"
#include "fusion-server/fusion/view_misfit.h"

namespace chorus::fusion {

class MisfitSize {
 public:
  /// Takes the misfits of an instant, `passed` [s] after the previous one.
  void learn(std::span<const Misfit> misfits, double passed, const BodyModel& model);
  /// The model with the sizes found so far; what is switched off stays so.
  [[nodiscard]] BodyModel found(BodyModel model) const;

 private:
  /// A mean square, started from a size that counts as much as `kPrior`.
  struct Square {
    double weight = 0.0;  ///< [s]
    double value = 0.0;
    void learn(double sum, double count, double passed, double start);
  };
  Square scale_;
  Square turn_;
};

}  // namespace chorus::fusion
