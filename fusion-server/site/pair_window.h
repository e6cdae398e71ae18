// What the last second tells of one of our bodies and one of another cell: whether they are one
// person.
#pragma once

#include <deque>
#include <optional>

#include "fusion-server/site/common_error.h"
#include "fusion-server/site/trail.h"

namespace chorus::site {

/// Both bodies at one instant, in the site.
struct PairSample {
  Timestamp at;                                          ///< By our clock.
  Eigen::Vector2d off = Eigen::Vector2d::Zero();         ///< Ours minus theirs, (x, z) [m].
  Eigen::Vector2d place = Eigen::Vector2d::Zero();       ///< Of theirs [m].
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();    ///< Of theirs [m/s].
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< Of `off`, as both state it [m^2].
};

/// The window as one term of the common error.
struct PairEvidence {
  CommonTerm term;
  double seconds = 0.0;  ///< From the first sample of the window to the last.
  /// What is to be added to the log likelihood because the distance of the two changes more than
  /// noise does: at most 0.
  double unsteady = 0.0;
};

class PairWindow {
 public:
  void add(const PairSample& sample);
  /// None: no sample in the second before `now`.
  [[nodiscard]] std::optional<PairEvidence> evidence(const CommonError& error, Timestamp now,
                                                     const SiteConfig& config) const;
  [[nodiscard]] Timestamp newest() const;
  /// Since when both have been seen without a break.
  [[nodiscard]] Timestamp first() const { return first_; }

 private:
  std::deque<PairSample> samples_;
  Timestamp first_;
};

}  // namespace chorus::site
