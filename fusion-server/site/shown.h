// Everybody of the site at one instant, as frames and outputs show them.
//
// What cells tell is of several instants: each person is moved on along their velocity, as a whole,
// to the instant t of the frame.  When another cell answers for a person, the body starts where it
// was shown last, and what that differs by fades:
//   shown_j(t) = told_j + (t - at) * v + w(u) * o_j,   w(u) = 1 - 3 u^2 + 2 u^3,
//   u = (t - begin) / SiteConfig::blend,   o_j = last_j + (begin - t_last) * v_last - told_j(begin)
// The covariance says so: C = C_told + C_cell + w^2 o o^T + (s (t - at))^2 I, where o is that of
// the pelvis, and C_cell is what the cell's place is not known to.
#pragma once

#include <array>
#include <map>
#include <span>
#include <vector>

#include "fusion-server/site/site.h"

namespace chorus::site {

/// Displacements of joints [m].
using Displacements = std::array<Eigen::Vector3d, kJointCount>;

struct ShownPerson {
  SitePerson told;      ///< By the cell that answers for them.
  Displacements moved;  ///< Added to the joints that the cell tells; finite for all joints.
  /// Added to the covariance that the cell states of a joint [m^2].
  Eigen::Matrix3d doubt = Eigen::Matrix3d::Zero();

  [[nodiscard]] Eigen::Vector3d place() const;  ///< Of the pelvis, as shown [m].
};

/// Remembers what was shown last.
class Showing {
 public:
  explicit Showing(const SiteConfig& config) : blend_(config.blend) {}

  /// In the order of `people`.  `at`: the frame's instant, by the site's clock.  A body that
  /// another cell has more than 0.5 m elsewhere, or that was not shown within 0.2 s, is shown where
  /// it is at once: nobody walked there.
  [[nodiscard]] std::vector<ShownPerson> show(std::span<const SitePerson> people, Timestamp at);

 private:
  struct Last {
    CellId cell;
    Timestamp at;
    Located joints;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Timestamp begin;  ///< Of the blend.
    Displacements off;
    bool blends = false;
  };
  void begin(Last& last, const ShownPerson& person, Timestamp at) const;
  [[nodiscard]] double left(const Last& last, Timestamp at) const;

  Duration blend_;
  std::map<SiteId, Last> last_;
};

}  // namespace chorus::site
