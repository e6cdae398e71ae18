// The ids of our own people: given, recognised, taken back, joined.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fusion-server/site/last_seen.h"
#include "fusion-server/site/matching.h"
#include "fusion-server/site/ownership.h"
#include "fusion-server/site/site.h"

namespace chorus::site {

/// What we know of one of our bodies' names.
struct OwnName {
  std::optional<SiteId> id;
  double certainty = 0.0;
  Timestamp since;  ///< When the body got `id`, by our clock.
  /// Since when we know of `id`: for a name that came by sight, when its giver was first heard to
  /// use it.  Who has borne an id for longer keeps it.
  Timestamp held;
  Timestamp last;         ///< When the body was last told.
  bool by_sight = false;  ///< The name came from a cell that saw the person at the same time.
  /// Whom nobody saw when the body was named: for second thoughts, as lengths get known.
  LastSights candidates;
  std::set<SiteId> refused;            ///< Ids that turned out to be somebody else's.
  std::optional<Timestamp> disputed;   ///< Since when another cell has told `id` elsewhere.
  std::map<SiteId, Timestamp> rivals;  ///< Since when a match has borne another id.
  bool reconsidered = false;           ///< A second thought has changed the id.
};

/// Another cell's body that bears a name, where it is now.
struct Telling {
  HeardCell* cell = nullptr;
  const HeardBody* body = nullptr;
  PersonId id;
  Sample where;  ///< In the site.
};

/// Everything that naming looks at.
struct Hearing {
  HeardCell* ours = nullptr;
  std::map<CellId, HeardCell>* others = nullptr;
  const Ownership* ownership = nullptr;
  Timestamp now;
};

/// What others are to be told.
struct NameNews {
  std::vector<SameAs> same_as;
  std::vector<SiteEvent> events;
};

class Names {
 public:
  Names(const CellId& own, std::uint64_t boot, const SiteConfig& config)
      : own_(own), config_(config), source_(own, boot) {}

  /// One decision; what is certain comes first.
  void decide(const Hearing& hearing);
  /// Somebody else says that the two ids are of one person.
  void join(const Hearing& hearing, const SameAs& joined);
  [[nodiscard]] SiteId present(const SiteId& id) const;
  [[nodiscard]] NamesInUse in_use(const HeardCell& ours, const HeardCell& theirs) const;
  [[nodiscard]] const std::map<PersonId, OwnName>& all() const { return names_; }
  /// Everything since the last call.
  [[nodiscard]] NameNews take_news() { return std::exchange(news_, {}); }

 private:
  void keep_up(const Hearing& hearing);
  void remember_sights(const Hearing& hearing);
  void settle_disputes(const Hearing& hearing);
  void dispute(const Hearing& hearing, PersonId body, OwnName& name);
  [[nodiscard]] bool yields(const Hearing& hearing, const OwnName& name,
                            const Telling& telling) const;
  void join_rivals(const Hearing& hearing);
  void meet_rival(const Hearing& hearing, PersonId body, OwnName& name);
  void name_newcomers(const Hearing& hearing);
  [[nodiscard]] bool name_by_sight(const Hearing& hearing, PersonId body, OwnName& name);
  void name_returning(const Hearing& hearing, const std::vector<PersonId>& bodies);
  void reconsider(const Hearing& hearing);
  void follow_thought(const Hearing& hearing, PersonId body, const std::optional<SiteId>& best,
                      double sure);
  void give(const Hearing& hearing, OwnName& name, const SiteId& id, double certainty);
  [[nodiscard]] SiteId new_id(const Hearing& hearing);
  void alias(const SiteId& kept, const SiteId& joined);
  void tell(const Hearing& hearing, SiteEvent event);

  [[nodiscard]] std::vector<Telling> tellings(const Hearing& hearing, const SiteId& id) const;
  [[nodiscard]] std::optional<Telling> best_match(const Hearing& hearing, PersonId body) const;
  /// Whether a cell that has told `id` for longer than `teller` sees them somewhere else.
  [[nodiscard]] bool elsewhere(const Hearing& hearing, PersonId body, const SiteId& id,
                               const Telling& teller) const;
  [[nodiscard]] bool borne_by_another(const Hearing& hearing, const SiteId& id,
                                      PersonId body) const;
  [[nodiscard]] LastSights missing(const Hearing& hearing) const;

  CellId own_;
  SiteConfig config_;
  SiteIdSource source_;
  std::map<PersonId, OwnName> names_;
  std::map<SiteId, SiteId> aliases_;  ///< Joined to kept.
  LastSights sights_;
  NameNews news_;
};

/// Where one of our bodies was last seen, in the site; none: our cell has no place, or the body was
/// never seen.
[[nodiscard]] std::optional<Sample> where_is(const HeardCell& cell, PersonId body);
/// One of our bodies as it came.
[[nodiscard]] Newcomer newcomer_of(const HeardCell& ours, PersonId body);
/// How well lengths repeat from cell to cell: of the neighbour of whom most was learned.
[[nodiscard]] associate::Repeatability repeatability_in(const Hearing& hearing);
/// Two sights that are farther apart than people and places explain.
[[nodiscard]] bool far_apart(const HeardCell& theirs, const Sample& a, const Sample& b);

}  // namespace chorus::site
