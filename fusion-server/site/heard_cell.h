// A cell as we hear it: its people with their trails, and whether it is to be believed.
#pragma once

#include <map>
#include <optional>
#include <utility>

#include "fusion-server/site/joint_match.h"
#include "fusion-server/site/pair_window.h"
#include "fusion-server/site/site_config.h"
#include "fusion-server/site/trail.h"

namespace chorus::site {

/// One of a cell's people, as far as we remember.
struct HeardBody {
  Person last;
  Trail trail;      ///< Only while seen, not while carried.
  Timestamp found;  ///< First heard of, by our clock.
  Timestamp named;  ///< When we first heard them under the present id, by our clock.
  Eigen::Vector3d appeared = Eigen::Vector3d::Zero();  ///< Where first heard of; cell's world [m].
  Timestamp appeared_at;                               ///< When that was, by our clock.
  /// The mean velocity of the first half second in view [m/s]; none: not in view for long enough.
  std::optional<Eigen::Vector3d> came_with = {};

  [[nodiscard]] bool seen() const { return !last.carried || *last.carried <= Duration{0}; }
};

/// One of our bodies and one of the cell's.
using BodyPair = std::pair<PersonId, PersonId>;

struct HeardCell {
  CellId id;
  std::optional<CellPlace> place;
  std::uint64_t boot = 0;
  std::uint64_t sequence = 0;
  Timestamp heard;      ///< Last message, by our clock.
  Timestamp at;         ///< Its instant, by our clock.
  Duration to_ours{0};  ///< Added to its stamps to get ours.
  std::map<PersonId, HeardBody> bodies;
  std::size_t refused = 0;
  std::size_t twice = 0;       ///< Messages of another cell of the same name.
  bool lost = false;           ///< Said nothing for the lease; told once.
  bool contradicting = false;  ///< It tells of one of our people elsewhere; set anew each time.
  double contradicted = 0.0;   ///< For how long it has done so [s].
  Timestamp mistrusted_until;
  CommonError error;     ///< Against our own cell.
  double learned = 0.0;  ///< Seconds that `error` was learned from.
  Timestamp learned_at;
  associate::Repeatability repeatability;
  std::map<BodyPair, PairWindow> windows;
  std::map<BodyPair, double> likely;  ///< Probability that they are one person, as of now.

  [[nodiscard]] bool mistrusted(Timestamp now) const { return now < mistrusted_until; }
  /// Has said something lately and is believed.
  [[nodiscard]] bool live(Timestamp now, Duration patience) const {
    return sequence > 0 && now - heard <= patience && !mistrusted(now);
  }
};

/// Takes the message in.  InvalidArgument: why it is refused; then nothing is changed.
[[nodiscard]] Result<void> hear(HeardCell& cell, const CellPeople& message, Timestamp now,
                                const SiteConfig& config);

/// In the site's space.
[[nodiscard]] Sample in_site(const Eigen::Isometry3d& site_from_cell, const Sample& sample);

}  // namespace chorus::site
