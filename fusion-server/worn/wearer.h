// Finds out which person wears an inertial source, from movement.
//
// Each telling sensor is calibrated for a moment against each candidate's limb (evaluation's fit of
// heading and mount): of the wearer little is left over, of others half a step.  One fit an
// instant, so that no instant costs much.  Refused while the sensors are still (that fits
// everybody), while two people fit alike, and while nobody fits.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/strong_id.h"
#include "common/evaluation/orientation_pair.h"
#include "common/inertial/limb.h"

namespace chorus::worn {

/// One sensor's reading beside one person's limb.
struct Beside {
  PersonId person;
  std::string sensor;
  inertial::Limb limb;
  evaluation::OrientationPair pair;
};

class WearerSearch {
 public:
  /// Takes everybody's limbs beside the source's sensors at one instant, `time` [s]; people who are
  /// not in it any more are forgotten.
  void take(double time, const std::vector<Beside>& all);
  /// Does one fit, and returns the wearer once that is clear.
  [[nodiscard]] std::optional<PersonId> look(double time);
  /// Why nobody was found, and what would decide.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  struct Trial {
    evaluation::OrientationPairs pairs;
    std::optional<double> residual;  ///< Median of what the fit leaves over [rad].
    double fitted = -1e9;            ///< When [s].
  };
  using Key = std::pair<PersonId, std::string>;

  [[nodiscard]] std::vector<std::string> telling() const;
  void fit_stalest(double time, const std::vector<std::string>& sensors);
  [[nodiscard]] std::optional<PersonId> decided(double time,
                                                const std::vector<std::string>& sensors);

  std::map<Key, Trial> trials_;
  std::map<PersonId, double> seen_;  ///< When [s].
  std::string reason_ = "nobody is seen with it yet";
};

}  // namespace chorus::worn
