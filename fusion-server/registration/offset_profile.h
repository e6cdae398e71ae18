// How well each offset between two sensors' clocks fits the walk that both saw.
//
// For an offset d the source's stamps are moved by d.  The middle of the body's axis is then
// compared at equal times and fitted by yaw and translation (where a floor is missing: all points
// of the axis, with six degrees of freedom).  Derived in docs/papers/registration.md, Section 10.
#pragma once

#include <optional>
#include <vector>

#include "fusion-server/registration/pair_registration.h"
#include "fusion-server/registration/student_fit.h"

namespace chorus::registration {

/// The fit at one offset.
struct OffsetFit {
  double offset = 0.0;  ///< Added to the source's stamps [s].
  StudentFit walk;
};

/// The offset between a pair's clocks, from the walk alone.
struct PairOffset {
  double offset = 0.0;  ///< Target's clock minus the source's: added to the source's stamps [s].
  /// [s]; as large as the searched range if the walk does not determine the offset.
  double sigma = 0.0;
};

/// The walk, reduced to what a profile needs.
[[nodiscard]] Walker offset_walker(const WalkTrack& walk, const RegistrationConfig& config);

/// Two walks, prepared to be fitted at many offsets.
class OffsetProfile {
 public:
  /// Both walkers come from offset_walker().  Searches offsets from -`range` to `range` [s].
  OffsetProfile(const Walker& target, const Walker& source, const RegistrationConfig& config,
                double range);

  /// None when the sensors saw too little of the person together.
  [[nodiscard]] std::optional<PairOffset> best() const;
  /// Position of the source sensor in the target's space at this offset [m]; none when too little
  /// of the walk is left.
  [[nodiscard]] std::optional<Eigen::Vector3d> place_at(double offset) const;

 private:
  [[nodiscard]] Points points_at(const Trail& source, double offset) const;
  [[nodiscard]] std::optional<OffsetFit> fit(const Trail& source, double offset) const;
  [[nodiscard]] std::vector<OffsetFit> sweep(const Trail& source, double middle, double reach,
                                             double step) const;

  double range_;
  Duration max_gap_;
  Trail target_;
  Trail source_;
  /// The frames of the source that stay within the target's time span at every offset; all of them
  /// if fewer than half do.
  Trail inner_;
  bool levelled_ = false;
  Eigen::Isometry3d level_from_target_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d level_from_source_ = Eigen::Isometry3d::Identity();
};

}  // namespace chorus::registration
