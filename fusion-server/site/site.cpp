#include "fusion-server/site/site.h"

#include <algorithm>

#include <fmt/format.h>

#include "fusion-server/site/everybody.h"
#include "fusion-server/site/matching.h"
#include "fusion-server/site/names.h"
#include "fusion-server/site/ownership.h"

namespace chorus::site {
namespace {

constexpr std::size_t kMaxCells = 64;
// What contradicts us for this long is no slow answer, but a cell that errs or lies.
constexpr double kPatience = 3.0;  // [s]
constexpr Duration kMistrust = std::chrono::seconds(60);
constexpr double kStep = 0.2;  // [s] that one decision counts at most
// Matches change no faster than the samples that they are made of.
constexpr Duration kMatchPeriod = std::chrono::milliseconds(90);

/// Cells repeat where they stand once a second; what was learned of a place holds for the same one.
bool same_place(const CellPlace& one, const CellPlace& other) {
  return one.site_from_cell.matrix() == other.site_from_cell.matrix() &&
         one.covariance == other.covariance && one.clock_added == other.clock_added &&
         one.clock_sigma == other.clock_sigma;
}

}  // namespace

struct Site::State {
  SiteConfig config;
  HeardCell ours;
  std::map<CellId, HeardCell> others;
  Names names;
  Ownership ownership;
  std::vector<SiteEvent> events;
  std::map<SiteId, CellId> answered;  ///< Who answered for our people at the last decision.
  Timestamp decided;
  Timestamp matched;

  State(const CellId& own, std::uint64_t boot, const SiteConfig& with)
      : config(with), names(own, boot, with), ownership(own, with) {
    ours.id = own;
    ours.boot = boot;
  }

  Hearing hearing(Timestamp now) { return {&ours, &others, &ownership, now}; }
  void tell(SiteEventKind kind, const CellId& cell, Timestamp now) {
    events.push_back({kind, now, {}, {}, cell});
  }
  HeardCell& cell(const CellId& id) {
    HeardCell& named = others[id];
    named.id = id;
    return named;
  }
  void place(HeardCell& cell);
  /// Their samples are in a world that may have moved.
  static void forget_trails(HeardCell& cell) {
    for (auto& [id, body] : cell.bodies) body.trail = {};
  }
  void watch_cells(Timestamp now);
  void mistrust(HeardCell& cell, double elapsed, Timestamp now);
  void match(Timestamp now);
  std::vector<OwnSight> own_sights(Timestamp now);
  void follow_owners(const std::vector<OwnSight>& sights, Timestamp now);
  std::vector<Named> named(const std::vector<OwnSight>& sights) const;
};

/// Enters what the places of our cell and of `cell` say of its stamps and of the common error.
void Site::State::place(HeardCell& cell) {
  if (!ours.place || !cell.place) return;
  const Duration by = cell.place->clock_added - ours.place->clock_added;
  if (cell.to_ours != by) {  // trails are by our clock
    cell.to_ours = by;
    cell.at = {};
    forget_trails(cell);
  }
  cell.error = stated_error(*ours.place, *cell.place, config);
  cell.learned = 0.0;
  cell.windows.clear();
  cell.likely.clear();
}

void Site::State::mistrust(HeardCell& cell, double elapsed, Timestamp now) {
  cell.contradicted = std::max(0.0, cell.contradicted + (cell.contradicting ? elapsed : -elapsed));
  cell.contradicting = false;
  if (cell.contradicted < kPatience) return;
  cell.contradicted = 0.0;
  cell.mistrusted_until = now + kMistrust;
  cell.likely.clear();
  cell.windows.clear();
  tell(SiteEventKind::CellMistrusted, cell.id, now);
}

void Site::State::watch_cells(Timestamp now) {
  const double elapsed = std::clamp(seconds(now - decided), 0.0, kStep);
  for (auto& [id, cell] : others) {
    mistrust(cell, elapsed, now);
    const bool lost = cell.sequence > 0 && now - cell.heard > config.lease;
    if (lost != cell.lost) tell(lost ? SiteEventKind::CellLost : SiteEventKind::CellFound, id, now);
    cell.lost = lost;
    if (lost) cell.likely.clear();
  }
}

void Site::State::match(Timestamp now) {
  if (now - matched < kMatchPeriod && now >= matched) return;
  matched = now;
  for (auto& [id, cell] : others) {
    if (!cell.live(now, config.lease)) continue;
    const NamesInUse in_use = names.in_use(ours, cell);
    sample_pairs(ours, cell);
    match_cells(ours, cell, in_use, {config, now});
    learn_from_matches(ours, cell, in_use, {config, now});
  }
}

std::vector<OwnSight> Site::State::own_sights(Timestamp now) {
  std::vector<OwnSight> sights;
  for (const auto& [body, heard] : ours.bodies) {
    const auto name = names.all().find(body);
    if (name == names.all().end() || !name->second.id) continue;
    OwnSight sight{*name->second.id,
                   stated_variance(heard.last.covariance, config),
                   heard.seen(),
                   name->second.certainty >= config.doubt,
                   {}};
    for (const auto& [id, cell] : others) {
      if (!cell.live(now, config.lease)) continue;
      for (const auto& [other, theirs] : cell.bodies) {
        if (theirs.last.site_id && names.present(*theirs.last.site_id) == sight.id)
          sight.others.push_back(
              {id, stated_variance(theirs.last.covariance, config), theirs.seen()});
      }
    }
    sights.push_back(std::move(sight));
  }
  return sights;
}

void Site::State::follow_owners(const std::vector<OwnSight>& sights, Timestamp now) {
  std::map<SiteId, CellId> answering;
  for (const OwnSight& sight : sights) {
    const CellId cell = ownership.answers(sight);
    answering[sight.id] = cell;
    const auto before = answered.find(sight.id);
    if (before == answered.end() || before->second == cell) continue;
    const bool to_us = cell == ours.id;
    if (to_us || before->second == ours.id)
      events.push_back({to_us ? SiteEventKind::TakenOver : SiteEventKind::HandedOver,
                        now,
                        sight.id,
                        {},
                        to_us ? before->second : cell});
  }
  answered = std::move(answering);
}

std::vector<Named> Site::State::named(const std::vector<OwnSight>& sights) const {
  std::vector<Named> all;
  for (const auto& [body, heard] : ours.bodies) {
    Named named{body, {}, 0.0, false, {}, ours.id};
    const auto name = names.all().find(body);
    if (name != names.all().end() && name->second.id) {
      named.id = name->second.id;
      named.certainty = name->second.certainty;
      named.doubtful = named.certainty < config.doubt;
      named.since = name->second.since;
      const auto sight = std::ranges::find(sights, *named.id, &OwnSight::id);
      if (sight != sights.end()) named.owner = ownership.answers(*sight);
    }
    all.push_back(std::move(named));
  }
  return all;
}

Site::Site(const CellId& own, std::uint64_t boot, const SiteConfig& config)
    : state_(std::make_unique<State>(own, boot, config)) {}
Site::~Site() = default;
Site::Site(Site&&) noexcept = default;
Site& Site::operator=(Site&&) noexcept = default;

Result<void> Site::take(const CellPeople& heard, Timestamp now) {
  State& s = *state_;
  if (heard.cell == s.ours.id) {
    if (heard.boot == s.ours.boot) return hear(s.ours, heard, now, s.config);
    ++s.ours.twice;
    if (s.ours.twice == 1) s.tell(SiteEventKind::CellTwice, heard.cell, now);
    return fail(ErrorCode::InvalidArgument, "cell " + heard.cell.str(),
                "another cell has our name: rename one of them");
  }
  if (!s.others.contains(heard.cell) && s.others.size() >= kMaxCells)
    return fail(ErrorCode::TooLarge, "cell " + heard.cell.str(),
                fmt::format("a site has at most {} cells", kMaxCells));
  HeardCell& cell = s.cell(heard.cell);
  const std::size_t twice = cell.twice;
  const Result<void> done = hear(cell, heard, now, s.config);
  if (twice == 0 && cell.twice > 0) s.tell(SiteEventKind::CellTwice, heard.cell, now);
  return done;
}

Result<void> Site::take(const CellPlace& place, Timestamp) {
  State& s = *state_;
  if (!place.site_from_cell.matrix().allFinite() || !place.covariance.allFinite())
    return fail(ErrorCode::InvalidArgument, "cell " + place.cell.str(),
                "its place is not a number");
  if (place.cell == s.ours.id) {
    if (s.ours.place && same_place(*s.ours.place, place)) return {};
    s.ours.place = place;
    s.forget_trails(s.ours);
    for (auto& [id, cell] : s.others) s.place(cell);
    return {};
  }
  if (!s.others.contains(place.cell) && s.others.size() >= kMaxCells)
    return fail(ErrorCode::TooLarge, "cell " + place.cell.str(),
                fmt::format("a site has at most {} cells", kMaxCells));
  HeardCell& cell = s.cell(place.cell);
  if (cell.place && same_place(*cell.place, place)) return {};
  cell.place = place;
  s.forget_trails(cell);
  s.place(cell);
  return {};
}

void Site::take(const Claim& claim, Timestamp now) {
  State& s = *state_;
  s.ownership.take(claim, now);
  if (claim.state == ClaimState::Joined && claim.same_as)
    take(SameAs{*claim.same_as, claim.id}, claim.cell, now);
}

void Site::take(const ClaimResult& result, Timestamp now) { state_->ownership.take(result, now); }

void Site::take(const SameAs& joined, const CellId& teller, Timestamp now) {
  State& s = *state_;
  const auto cell = s.others.find(teller);
  if (cell != s.others.end() && cell->second.mistrusted(now)) return;
  s.names.join(s.hearing(now), joined);
}

Decision Site::decide(Timestamp now) {
  State& s = *state_;
  s.watch_cells(now);
  s.match(now);
  s.names.decide(s.hearing(now));
  NameNews news = s.names.take_news();
  for (const SameAs& each : news.same_as) s.ownership.join(each.kept, each.joined);
  const std::vector<OwnSight> sights = s.own_sights(now);
  Decision decision;
  decision.claims = s.ownership.wanted(sights, now);
  s.follow_owners(sights, now);
  decision.people = s.named(sights);
  decision.same_as = std::move(news.same_as);
  decision.events = std::move(news.events);
  decision.events.insert(decision.events.end(), s.events.begin(), s.events.end());
  s.events.clear();
  s.decided = now;
  return decision;
}

std::vector<SitePerson> Site::everybody(Timestamp now) const {
  return everybody_of(state_->hearing(now), state_->names, state_->config);
}

std::vector<CellState> Site::cells(Timestamp now) const {
  const State& s = *state_;
  std::vector<CellState> all;
  const auto add = [&](const HeardCell& cell) {
    all.push_back({cell.id, cell.place.has_value(), cell.live(now, s.config.lease),
                   cell.mistrusted(now), cell.heard, cell.bodies.size(), cell.refused + cell.twice,
                   cell.error.mean.head<2>(), cell.learned});
  };
  add(s.ours);
  for (const auto& [id, cell] : s.others) add(cell);
  return all;
}

}  // namespace chorus::site
