#include "fusion-server/site/ownership.h"

#include <algorithm>

namespace chorus::site {
namespace {

// A holder that does not see a person for this long has lost them.
constexpr Duration kLost = std::chrono::milliseconds(300);
constexpr Duration kAskAgain = std::chrono::seconds(1);
// Smaller by a tenth at least: else two cells of equal error would exchange a person for ever.
constexpr double kBetter = 0.9 * 0.9;
// How long the record of somebody nobody tells of is kept here; the store has it still.
constexpr Duration kRecordKept = std::chrono::minutes(10);
// As many as 64 cells can tell of at once.  What is heard beyond that of people who are none of
// ours is left to the store, which says it when we ask for one of them.
constexpr std::size_t kMostRecords = 64 * 64;

const StatedBy* stated_by(const OwnSight& person, const CellId& cell) {
  const auto found = std::ranges::find(person.others, cell, &StatedBy::cell);
  return found == person.others.end() ? nullptr : &*found;
}

/// Since when `condition` has held; none: it does not.
void follow(std::optional<Timestamp>& since, bool condition, Timestamp now) {
  if (!condition)
    since.reset();
  else if (!since)
    since = now;
}

}  // namespace

void Ownership::take(const Claim& claim, Timestamp now) {
  if (known_.size() >= kMostRecords && !known_.contains(claim.id)) return;
  Known& known = known_[claim.id];
  known.touched = now;
  if (known.claim && known.claim->revision >= claim.revision) return;
  if (!known.claim || known.claim->cell != claim.cell) {
    known.better.reset();
    known.absent.reset();
  }
  known.claim = claim;
  known.asked.reset();
  if (claim.state == ClaimState::Joined) to_join_.erase(claim.id);
}

void Ownership::take(const ClaimResult& result, Timestamp now) {
  const auto known = known_.find(result.now.id);
  if (known != known_.end()) {
    known->second.asked.reset();
    if (result.now.revision == 0) known->second.claim.reset();
  }
  if (result.now.revision != 0) take(result.now, now);
}

void Ownership::join(const SiteId& kept, const SiteId& joined) { to_join_[joined] = kept; }

std::optional<CellId> Ownership::holder(const SiteId& id) const {
  const auto known = known_.find(id);
  if (known == known_.end() || !known->second.claim) return std::nullopt;
  const Claim& claim = *known->second.claim;
  if (claim.state != ClaimState::Held) return std::nullopt;
  return claim.cell;
}

CellId Ownership::answers(const OwnSight& person) const {
  const auto claimed = holder(person.id);
  if (!claimed || *claimed == own_) return own_;
  const StatedBy* theirs = stated_by(person, *claimed);
  return theirs != nullptr ? *claimed : own_;
}

bool Ownership::wants(Known& known, const OwnSight& person, Timestamp now) const {
  const bool held = known.claim && known.claim->state == ClaimState::Held;
  if (held && known.claim->cell == own_) return false;
  if (!person.seen || !person.sure) return false;
  if (!held) {
    // Who has told of them for longer claims them; if nobody does, we do.
    follow(known.absent, true, now);
    return person.others.empty() || now - *known.absent >= config_.evidence;
  }
  const StatedBy* theirs = stated_by(person, known.claim->cell);
  const bool theirs_seen = theirs != nullptr && theirs->seen;
  follow(known.absent, !theirs_seen, now);
  follow(known.better, theirs_seen && person.variance < kBetter * theirs->variance, now);
  return (known.absent && now - *known.absent >= kLost) ||
         (known.better && now - *known.better >= config_.evidence);
}

void Ownership::ask(std::vector<ClaimRequest>& requests, Known& known, const Claim& value,
                    Timestamp now) {
  if (known.asked && now - *known.asked < kAskAgain) return;
  known.asked = now;
  requests.push_back({value, known.claim ? known.claim->revision : 0});
}

void Ownership::release_unseen(std::vector<ClaimRequest>& requests, Timestamp now) {
  for (auto& [id, known] : known_) {
    if (!known.claim || known.claim->cell != own_ || known.claim->state != ClaimState::Held)
      continue;
    if (now - known.told >= config_.lease)
      ask(requests, known, {id, own_, 0, ClaimState::Released, {}}, now);
  }
}

void Ownership::ask_for_joined(std::vector<ClaimRequest>& requests, Timestamp now) {
  for (const auto& [joined, kept] : to_join_) {
    Known& known = known_[joined];
    known.touched = now;
    ask(requests, known, {joined, own_, 0, ClaimState::Joined, kept}, now);
  }
}

std::vector<ClaimRequest> Ownership::wanted(std::span<const OwnSight> people, Timestamp now) {
  std::vector<ClaimRequest> requests;
  for (const OwnSight& person : people) {
    Known& known = known_[person.id];
    known.touched = now;
    if (person.seen) known.told = now;
    if (known.claim && known.claim->state == ClaimState::Joined) continue;
    if (wants(known, person, now))
      ask(requests, known, {person.id, own_, 0, ClaimState::Held, {}}, now);
  }
  release_unseen(requests, now);
  ask_for_joined(requests, now);
  std::erase_if(known_, [&](const auto& each) { return now - each.second.touched > kRecordKept; });
  return requests;
}

}  // namespace chorus::site
