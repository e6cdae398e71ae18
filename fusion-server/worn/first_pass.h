// Collects, while a recording is read for the first time, what a second pass begins with.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "fusion-server/flow/fused_body.h"
#include "fusion-server/worn/beginning.h"
#include "fusion-server/worn/wear.h"

namespace chorus::worn {

class FirstPass {
 public:
  /// Takes what is known once `wear` has learned from the bodies of `instant`.
  void note(const Wear& wear, const std::vector<FusedBody>& bodies, Timestamp instant);
  /// Whether longer looking would show little more: every source has been worn for as long as its
  /// calibrations improve, and twice that.
  [[nodiscard]] bool enough() const;
  /// One for each source whose wearer was found; only what was known of that first wearing.
  [[nodiscard]] std::vector<Beginning> found() const;

 private:
  struct Wearing {
    Beginning beginning;
    Timestamp begun;        ///< When the wearer was found.
    double worn_for = 0.0;  ///< Since then [s].
    bool over = false;      ///< Somebody else wears it, or nobody.
  };
  void note_source(const Wear::Worn& worn, Timestamp instant);

  std::map<PersonId, FirstSight> seen_;
  std::map<SensorId, Wearing> wearings_;
  std::set<SensorId> sources_;
};

}  // namespace chorus::worn
