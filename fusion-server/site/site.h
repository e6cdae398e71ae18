// Who is who between the cells of a site: gives every person of our cell an id that the other cells
// use, too, and says which cell answers for them.  docs/how/halls.md.
//
// Pure: no clock, no thread, no network.  `now` is our own UTC clock, which need not agree with
// that of the other cells.  Every cell runs this for its own people and listens to the others; none
// is above another.  A cell that hears nobody names its people alone.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fusion-server/site/cell_people.h"
#include "fusion-server/site/claim.h"
#include "fusion-server/site/site_config.h"

namespace chorus::site {

/// What is decided of one of our people.
struct Named {
  PersonId body;
  std::optional<SiteId> id;        ///< None: not yet named.
  double certainty = 0.0;          ///< [0, 1]; that `id` is this person's.
  bool doubtful = false;           ///< The certainty is below SiteConfig::doubt.
  std::optional<Timestamp> since;  ///< When `body` got `id`.
  CellId owner;                    ///< The cell that answers for the person.
};

/// Two ids of one person; `joined` is not used any more.
struct SameAs {
  SiteId kept;
  SiteId joined;
};

enum class SiteEventKind {
  Named,       ///< A new id was given.
  Recognised,  ///< A person in view got the id they bear in `cell`.
  Returned,    ///< A person whom nobody had seen got their id again.
  Renamed,     ///< A wrong id was taken back; `other` is the wrong one.
  Joined,      ///< `other` turned out to be `id`.
  TakenOver,   ///< We answer for the person; until now `cell` did.
  HandedOver,  ///< `cell` answers for the person; until now we did.
  Disputed,    ///< `cell` says that the person is elsewhere.
  CellLost,    ///< `cell` has said nothing for SiteConfig::lease.
  CellFound,
  CellTwice,       ///< Two cells call themselves `cell`; the one that started later is not heard.
  CellMistrusted,  ///< What `cell` says contradicts what we see; it is not heard for a minute.
};

struct SiteEvent {
  SiteEventKind kind = SiteEventKind::Named;
  Timestamp at;
  SiteId id = {};
  SiteId other = {};
  CellId cell = {};
};

/// What follows from all that was heard until `now`.
struct Decision {
  std::vector<Named> people;         ///< In the order of our cell's last message.
  std::vector<ClaimRequest> claims;  ///< To be written to the store.
  std::vector<SameAs> same_as;       ///< To be published; each once.
  std::vector<SiteEvent> events;     ///< Since the last decision.
};

/// A person of the site, told once, whichever cells see them.  In the site's space and time.
struct SitePerson {
  SiteId id;
  double certainty = 0.0;
  CellId cell;    ///< The cell that answers for them, and whose figures these are.
  PersonId body;  ///< ... and its own id of them.
  Timestamp at;   ///< By the site's clock.
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< As the cell states it.
  /// What `place` is not known to because the cell's place in the site is not; 0.2 m and 2 degrees
  /// where none is stated (SiteConfig).
  Eigen::Matrix3d cell_covariance = Eigen::Matrix3d::Zero();
  Located joints;
  std::vector<CellId> seen_by;  ///< All cells that tell of them now.
};

/// What is known of a cell.
struct CellState {
  CellId cell;
  bool placed = false;
  bool heard = false;  ///< Within SiteConfig::lease.
  bool mistrusted = false;
  Timestamp last;  ///< When we last heard it, by our clock.
  std::size_t people = 0;
  std::size_t refused = 0;  ///< Messages that were refused.
  /// By how much the cell stands elsewhere than it says, as people seen by both show: along x and
  /// z [m], and the number of seconds that this was learned from.
  Eigen::Vector2d off = Eigen::Vector2d::Zero();
  double learned = 0.0;
};

class Site {
 public:
  /// `boot`: see CellPeople; the rim takes the time at which the process started.
  Site(const CellId& own, std::uint64_t boot, const SiteConfig& config = {});
  ~Site();
  Site(Site&&) noexcept;
  Site& operator=(Site&&) noexcept;

  /// A cell's people; those of our own cell come the same way, without ids.  InvalidArgument: the
  /// message is refused, and why; nothing of it is used.
  [[nodiscard]] Result<void> take(const CellPeople& heard, Timestamp now);
  /// Where a cell stands; a cell without a place is heard, but nobody of it is matched.  Another
  /// place than before ends what was learned of it; the same one said again does not.
  [[nodiscard]] Result<void> take(const CellPlace& place, Timestamp now);
  /// A record of the store, as it changed.
  void take(const Claim& claim, Timestamp now);
  void take(const ClaimResult& result, Timestamp now);
  /// What `teller` publishes of two ids; refused unless the older one is kept.
  void take(const SameAs& joined, const CellId& teller, Timestamp now);

  /// Call it after each message of our own cell.
  [[nodiscard]] Decision decide(Timestamp now);

  /// Everybody in the site, each once, in the order of their ids.
  [[nodiscard]] std::vector<SitePerson> everybody(Timestamp now) const;
  [[nodiscard]] std::vector<CellState> cells(Timestamp now) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace chorus::site
