#include "fusion-server/site/names.h"

#include <algorithm>
#include <cmath>

namespace chorus::site {
namespace {

// A cell that has said nothing for this long shows nobody now.
constexpr Duration kPresent = std::chrono::milliseconds(500);
constexpr std::size_t kMaxAliases = 100'000;
constexpr int kLongestChain = 32;  // of aliases
constexpr double kProbable = 0.5;
constexpr double kEvidence = 0.40;  // [s]: half a second, less a period of the samples
// Two bodies are elsewhere from one another beyond this [m], besides what places explain.
constexpr double kApart = 1.0;
constexpr double kSigmas = 3.0;
// By how much two sights of one instant may differ in time [s].
constexpr double kMostBetween = 1.0;

bool given_by(const std::optional<SiteId>& id, const SiteId& wanted) { return id && *id == wanted; }

}  // namespace

Newcomer newcomer_of(const HeardCell& ours, PersonId body) {
  const HeardBody& heard = ours.bodies.at(body);
  Newcomer newcomer{heard.last.since + ours.to_ours, heard.appeared, heard.last.lengths};
  newcomer.velocity = heard.came_with;
  if (!ours.place) return newcomer;
  newcomer.place = ours.place->site_from_cell * heard.appeared;
  if (newcomer.velocity)
    newcomer.velocity = ours.place->site_from_cell.linear() * *newcomer.velocity;
  return newcomer;
}

std::optional<Sample> where_is(const HeardCell& cell, PersonId body) {
  const auto found = cell.bodies.find(body);
  if (!cell.place || found == cell.bodies.end()) return std::nullopt;
  if (found->second.trail.samples().empty()) return std::nullopt;
  return in_site(cell.place->site_from_cell, found->second.trail.samples().back());
}

associate::Repeatability repeatability_in(const Hearing& hearing) {
  associate::Repeatability most;
  double learned = 0.0;
  for (const auto& [id, cell] : *hearing.others) {
    if (cell.learned <= learned) continue;
    learned = cell.learned;
    most = cell.repeatability;
  }
  return most;
}

bool far_apart(const HeardCell& theirs, const Sample& a, const Sample& b) {
  const double between = std::clamp(seconds(a.at - b.at), -kMostBetween, kMostBetween);
  const Eigen::Vector3d off = a.place - (b.place + between * b.velocity);
  const double places = std::sqrt(theirs.error.covariance(0, 0) + theirs.error.covariance(1, 1));
  return std::hypot(off.x(), off.z()) > kApart + kSigmas * places + 0.5 * std::abs(between);
}

void Names::decide(const Hearing& hearing) {
  keep_up(hearing);
  remember_sights(hearing);
  settle_disputes(hearing);
  join_rivals(hearing);
  name_newcomers(hearing);
  reconsider(hearing);
}

SiteId Names::present(const SiteId& id) const {
  SiteId now = id;
  for (int i = 0; i < kLongestChain; ++i) {
    const auto next = aliases_.find(now);
    if (next == aliases_.end()) break;
    now = next->second;
  }
  return now;
}

void Names::alias(const SiteId& kept, const SiteId& joined) {
  if (!(kept < joined) || aliases_.size() >= kMaxAliases) return;
  aliases_.emplace(joined, kept);
  if (const auto sight = sights_.find(joined); sight != sights_.end()) {
    remember(sights_, kept, sight->second);
    sights_.erase(joined);
  }
}

void Names::tell(const Hearing& hearing, SiteEvent event) {
  event.at = hearing.now;
  news_.events.push_back(std::move(event));
}

NamesInUse Names::in_use(const HeardCell& ours, const HeardCell& theirs) const {
  NamesInUse names;
  for (const auto& [body, name] : names_) {
    if (name.id && ours.bodies.contains(body))
      names.ours[body] = {*name.id, name.certainty >= config_.doubt};
  }
  for (const auto& [body, heard] : theirs.bodies) {
    if (heard.last.site_id)
      names.theirs[body] = {present(*heard.last.site_id),
                            heard.last.site_certainty >= config_.doubt};
  }
  return names;
}

/// A body that is told again within a minute keeps its name.
void Names::keep_up(const Hearing& hearing) {
  for (const auto& [body, heard] : hearing.ours->bodies) names_[body].last = hearing.now;
  std::erase_if(
      names_, [&](const auto& each) { return hearing.now - each.second.last > config_.remember; });
  for (auto& [body, name] : names_) {
    if (!name.id || present(*name.id) == *name.id) continue;
    name.id = present(*name.id);
    name.since = hearing.now;
  }
}

void Names::remember_sights(const Hearing& hearing) {
  // What a visit under a doubtful name shows may be somebody else's.
  const auto sight = [&](const HeardCell& cell, PersonId body, const KnownName& name) {
    const auto where = where_is(cell, body);
    if (!where) return;
    const associate::StatedBuild& lengths = cell.bodies.at(body).last.lengths;
    remember(sights_, name.id,
             {cell.id, where->at, where->place, where->velocity, where->covariance, lengths});
    const auto known = sights_.find(name.id);
    if (known != sights_.end() && name.sure) learn(known->second, {cell.id, body, lengths});
  };
  for (const auto& [id, cell] : *hearing.others) {
    if (!cell.live(hearing.now, config_.lease)) continue;
    for (const auto& [body, heard] : cell.bodies) {
      if (heard.seen() && heard.last.site_id)
        sight(cell, body,
              {present(*heard.last.site_id), heard.last.site_certainty >= config_.doubt});
    }
  }
  for (const auto& [body, name] : names_) {
    const auto heard = hearing.ours->bodies.find(body);
    if (name.id && heard != hearing.ours->bodies.end() && heard->second.seen())
      sight(*hearing.ours, body, {*name.id, name.certainty >= config_.doubt});
  }
  forget_before(sights_, hearing.now - config_.remember);
}

std::vector<Telling> Names::tellings(const Hearing& hearing, const SiteId& id) const {
  std::vector<Telling> all;
  for (auto& [cell_id, cell] : *hearing.others) {
    if (!cell.live(hearing.now, kPresent)) continue;
    for (const auto& [body, heard] : cell.bodies) {
      if (!heard.seen() || !heard.last.site_id || present(*heard.last.site_id) != id) continue;
      if (const auto where = where_is(cell, body)) all.push_back({&cell, &heard, body, *where});
    }
  }
  return all;
}

std::optional<Telling> Names::best_match(const Hearing& hearing, PersonId body) const {
  std::optional<Telling> best;
  double most = kProbable;
  for (auto& [cell_id, cell] : *hearing.others) {
    if (!cell.live(hearing.now, kPresent)) continue;
    for (const auto& [pair, probability] : cell.likely) {
      if (pair.first != body || probability <= most || !cell.bodies.contains(pair.second)) continue;
      const auto where = where_is(cell, pair.second);
      if (!where) continue;
      most = probability;
      best = Telling{&cell, &cell.bodies.at(pair.second), pair.second, *where};
    }
  }
  return best;
}

bool Names::elsewhere(const Hearing& hearing, PersonId body, const SiteId& id,
                      const Telling& teller) const {
  const auto where = where_is(*hearing.ours, body);
  if (!where) return false;
  return std::ranges::any_of(tellings(hearing, id), [&](const Telling& each) {
    return each.cell != teller.cell && each.body->named < teller.body->named &&
           far_apart(*each.cell, *where, each.where);
  });
}

bool Names::borne_by_another(const Hearing& hearing, const SiteId& id, PersonId body) const {
  return std::ranges::any_of(names_, [&](const auto& each) {
    if (each.first == body || !given_by(each.second.id, id)) return false;
    const auto heard = hearing.ours->bodies.find(each.first);
    return heard != hearing.ours->bodies.end() && heard->second.seen();
  });
}

void Names::give(const Hearing& hearing, OwnName& name, const SiteId& id, double certainty) {
  name.id = id;
  name.certainty = certainty;
  name.since = name.held = hearing.now;
  name.disputed.reset();
  name.rivals.clear();
}

SiteId Names::new_id(const Hearing& hearing) {
  const auto& place = hearing.ours->place;
  return source_.next(hearing.now + (place ? place->clock_added : Duration{0}));
}

void Names::name_newcomers(const Hearing& hearing) {
  std::vector<PersonId> rest;
  for (const auto& [body, heard] : hearing.ours->bodies) {
    OwnName& name = names_.at(body);
    if (name.id || !heard.seen() || hearing.now - heard.found < config_.evidence) continue;
    if (!name_by_sight(hearing, body, name)) rest.push_back(body);
  }
  if (!rest.empty()) name_returning(hearing, rest);
}

/// True: named, or worth waiting for.
bool Names::name_by_sight(const Hearing& hearing, PersonId body, OwnName& name) {
  const auto match = best_match(hearing, body);
  if (!match) return false;
  const HeardBody& own = hearing.ours->bodies.at(body);
  const bool patient = hearing.now - own.found < config_.evidence + config_.wait_for_name;
  if (!match->body->last.site_id) {
    const Timestamp theirs = match->body->last.since + match->cell->to_ours;
    const Timestamp ours = own.last.since + hearing.ours->to_ours;
    return patient && (theirs < ours || (theirs == ours && match->cell->id < own_));
  }
  const SiteId id = present(*match->body->last.site_id);
  if (name.refused.contains(id) || borne_by_another(hearing, id, body) ||
      elsewhere(hearing, body, id, *match))
    return false;
  if (seen_together(*match->cell, {body, match->id}) < kEvidence) return patient;
  const double sure = match->body->last.site_certainty;
  give(hearing, name, id, likely_pair(*match->cell, {body, match->id}) * sure);
  name.by_sight = true;
  name.held = match->body->named;
  name.candidates.clear();
  tell(hearing, {SiteEventKind::Recognised, {}, id, {}, match->cell->id});
  return true;
}

LastSights Names::missing(const Hearing& hearing) const {
  LastSights all;
  for (const auto& [id, sight] : sights_) {
    if (aliases_.contains(id) || borne_by_another(hearing, id, PersonId{})) continue;
    if (tellings(hearing, id).empty()) all.emplace(id, sight);
  }
  return all;
}

void Names::name_returning(const Hearing& hearing, const std::vector<PersonId>& bodies) {
  const LastSights gone = hearing.ours->place ? missing(hearing) : LastSights{};
  std::vector<Newcomer> newcomers;
  for (const PersonId body : bodies) newcomers.push_back(newcomer_of(*hearing.ours, body));
  const Gone sights = listed(gone);
  const JointMatch match = match_returning(newcomers, sights.sights, repeatability_in(hearing));
  std::set<SiteId> taken;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    OwnName& name = names_.at(bodies[i]);
    const Likeliest best = likeliest_of(match, i, [&](std::size_t j) {
      return !taken.contains(sights.ids[j]) && !name.refused.contains(sights.ids[j]);
    });
    const SiteId id = best.theirs ? sights.ids[*best.theirs] : new_id(hearing);
    if (best.theirs) taken.insert(id);
    give(hearing, name, id, best.probability);
    name.by_sight = false;
    name.candidates = gone;
    tell(hearing, {best.theirs ? SiteEventKind::Returned : SiteEventKind::Named,
                   {},
                   id,
                   {},
                   best.theirs ? sights.sights[*best.theirs].cell : CellId{}});
  }
}

}  // namespace chorus::site
