// The part of names.h that changes ids: second thoughts, disputes, and ids that turn out to be one.
#include <algorithm>

#include "fusion-server/site/names.h"

namespace chorus::site {
namespace {

// Second thoughts are had for this long: lengths are as well known then as they will be.
constexpr Duration kYoung = std::chrono::seconds(3);
constexpr double kDecided = 0.95;
// A match for this long shows that two ids are of one person.
constexpr Duration kRival = std::chrono::seconds(1);
// Two cells that named a person within this time of each other cannot tell who was first.
constexpr Duration kTie = std::chrono::seconds(1);
constexpr double kUnlikely = 0.02;
constexpr double kSeenLong = 0.45;  // [s]

}  // namespace

void Names::reconsider(const Hearing& hearing) {
  std::vector<PersonId> young;
  std::vector<Newcomer> newcomers;
  LastSights candidates;
  for (const auto& [body, heard] : hearing.ours->bodies) {
    OwnName& name = names_.at(body);
    if (hearing.now - heard.found > config_.evidence + kYoung) name.candidates.clear();
    if (!name.id || name.by_sight || name.candidates.empty()) continue;
    young.push_back(body);
    newcomers.push_back(newcomer_of(*hearing.ours, body));
    candidates.insert(name.candidates.begin(), name.candidates.end());
  }
  if (young.empty()) return;
  // Whom another cell has found again meanwhile is none of ours.
  std::erase_if(candidates, [&](const auto& each) {
    return !borne_by_another(hearing, each.first, PersonId{}) &&
           !tellings(hearing, each.first).empty();
  });
  const Gone gone = listed(candidates);
  const JointMatch match = match_returning(newcomers, gone.sights, repeatability_in(hearing));
  for (std::size_t i = 0; i < young.size(); ++i) {
    OwnName& name = names_.at(young[i]);
    const auto own = std::ranges::find(gone.ids, *name.id);
    name.certainty = own == gone.ids.end()
                         ? match.none[i]
                         : match.at(i, static_cast<std::size_t>(own - gone.ids.begin()));
    const Likeliest best =
        likeliest_of(match, i, [&](std::size_t j) { return !name.refused.contains(gone.ids[j]); });
    std::optional<SiteId> thought;
    if (best.theirs) thought = gone.ids[*best.theirs];
    if (best.probability > kDecided) follow_thought(hearing, young[i], thought, best.probability);
  }
}

void Names::follow_thought(const Hearing& hearing, PersonId body, const std::optional<SiteId>& best,
                           double sure) {
  OwnName& name = names_.at(body);
  const SiteId old = *name.id;
  if (name.reconsidered || (best && *best == old)) return;
  const bool was_returned = name.candidates.contains(old);
  if (!best && !was_returned) return;  // a new id, as before
  if (best && (borne_by_another(hearing, *best, body) || !tellings(hearing, *best).empty())) return;
  name.reconsidered = true;
  if (best && !was_returned && *best < old) {  // the new id was one too many
    alias(*best, old);
    news_.same_as.push_back({*best, old});
    give(hearing, name, *best, sure);
    tell(hearing, {SiteEventKind::Joined, {}, *best, old, {}});
    return;
  }
  give(hearing, name, best ? *best : new_id(hearing), sure);
  tell(hearing, {SiteEventKind::Renamed, {}, *name.id, old, {}});
}

void Names::settle_disputes(const Hearing& hearing) {
  for (const auto& [body, heard] : hearing.ours->bodies) {
    OwnName& name = names_.at(body);
    if (name.id && heard.seen()) dispute(hearing, body, name);
  }
}

bool Names::yields(const Hearing& hearing, const OwnName& name, const Telling& telling) const {
  const Duration later = name.held - telling.body->named;
  if (later > kTie) return true;
  if (later < -kTie) return false;
  const auto holder = hearing.ownership->holder(*name.id);
  if (holder && *holder == own_) return false;
  if (holder && *holder == telling.cell->id) return true;
  return telling.cell->id < own_;
}

void Names::dispute(const Hearing& hearing, PersonId body, OwnName& name) {
  const auto where = where_is(*hearing.ours, body);
  if (!where) return;
  bool contradicted = false;
  for (const Telling& each : tellings(hearing, *name.id)) {
    const BodyPair pair{body, each.id};
    const bool unlike = seen_together(*each.cell, pair) >= kSeenLong &&
                        each.cell->likely.contains(pair) &&
                        likely_pair(*each.cell, pair) < kUnlikely;
    if (!unlike && !far_apart(*each.cell, *where, each.where)) continue;
    contradicted = true;
    if (!name.disputed) {
      name.disputed = hearing.now;
      tell(hearing, {SiteEventKind::Disputed, {}, *name.id, {}, each.cell->id});
    }
    if (hearing.now - *name.disputed < config_.evidence) return;
    if (yields(hearing, name, each)) {
      const SiteId wrong = *name.id;
      name.refused.insert(wrong);
      name.id.reset();
      name.disputed.reset();
      tell(hearing, {SiteEventKind::Renamed, {}, {}, wrong, each.cell->id});
      return;
    }
    if (each.body->named - name.held > kTie) each.cell->contradicting = true;
  }
  if (!contradicted) name.disputed.reset();
}

void Names::join_rivals(const Hearing& hearing) {
  for (const auto& [body, heard] : hearing.ours->bodies) {
    OwnName& name = names_.at(body);
    if (name.id && heard.seen()) meet_rival(hearing, body, name);
  }
}

void Names::meet_rival(const Hearing& hearing, PersonId body, OwnName& name) {
  const auto match = best_match(hearing, body);
  if (!match || !match->body->last.site_id) return name.rivals.clear();
  const double probability = likely_pair(*match->cell, {body, match->id});
  const SiteId theirs = present(*match->body->last.site_id);
  if (theirs == *name.id) {
    name.certainty =
        std::max(name.certainty, probability * std::min(1.0, match->body->last.site_certainty));
    return name.rivals.clear();
  }
  if (probability < config_.doubt || name.refused.contains(theirs)) return name.rivals.clear();
  const auto since = name.rivals.try_emplace(theirs, hearing.now).first->second;
  if (hearing.now - since < kRival) return;
  if (borne_by_another(hearing, theirs, body) || elsewhere(hearing, body, theirs, *match)) return;
  const SiteId ours = *name.id;
  const bool ours_elsewhere = std::ranges::any_of(tellings(hearing, ours), [&](const Telling& t) {
    return t.cell != match->cell && far_apart(*t.cell, match->where, t.where);
  });
  const bool wrong = ours_elsewhere || name.certainty < config_.doubt;
  if (!wrong && ours < theirs) return;  // the other cell gives its id up
  const double sure = probability * match->body->last.site_certainty;
  if (wrong) {
    name.refused.insert(ours);
    tell(hearing, {SiteEventKind::Renamed, {}, theirs, ours, match->cell->id});
  } else {
    alias(theirs, ours);
    news_.same_as.push_back({theirs, ours});
    tell(hearing, {SiteEventKind::Joined, {}, theirs, ours, match->cell->id});
  }
  give(hearing, name, theirs, sure);
  name.by_sight = true;
  name.held = match->body->named;
}

void Names::join(const Hearing& hearing, const SameAs& joined) {
  if (!(joined.kept < joined.joined) || present(joined.joined) == present(joined.kept)) return;
  // Not if both are in view as two people.
  const auto kept = tellings(hearing, joined.kept);
  for (const auto& [body, name] : names_) {
    if (!name.id || !hearing.ours->bodies.contains(body)) continue;
    if (*name.id == joined.joined && borne_by_another(hearing, joined.kept, body)) return;
    const auto where = where_is(*hearing.ours, body);
    if (*name.id != joined.joined || !where) continue;
    for (const Telling& each : kept) {
      if (far_apart(*each.cell, *where, each.where)) return;
    }
  }
  alias(joined.kept, joined.joined);
}

}  // namespace chorus::site
