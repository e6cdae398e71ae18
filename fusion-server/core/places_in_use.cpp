#include "fusion-server/core/places_in_use.h"

#include <utility>

#include "fusion-server/core/adoption.h"

namespace chorus::core {
namespace {

tl::unexpected<Error> none_configured() {
  return fail(ErrorCode::NotFound, "registration", "none of its sensors is configured any more");
}

}  // namespace

Result<Registration> PlacesInUse::successor(const Registration& base, const Registration& candidate,
                                            SolveKind kind, bool hold) const {
  auto next = adopted(base, candidate, kind, hold);
  if (!next || !base.sensors.empty()) return next;
  return in_world_of(forgotten_, std::move(*next));
}

void PlacesInUse::replace(Registration next) {
  const std::uint64_t version = now_.version + 1;
  now_ = std::move(next);
  now_.version = version;
}

void PlacesInUse::keep_earlier(const Registration& used) {
  if (!used.sensors.empty()) earlier_ = used;
}

void PlacesInUse::adopt(Registration next) {
  if (!std::exchange(lacks_displaced_, false)) keep_earlier(settled());
  replace(std::move(next));
}

void PlacesInUse::adopt_provisionally(Registration next) {
  if (!before_) before_ = now_;
  replace(std::move(next));
}

bool PlacesInUse::take_back() {
  if (!before_) return false;
  replace(std::move(*before_));
  before_.reset();
  return true;
}

void PlacesInUse::note(const Registration& candidate, bool contradicted) {
  if (contradicted) note_contradiction(now_);
  note_refusals(now_, candidate);
}

std::optional<std::uint64_t> PlacesInUse::drop_proposal() {
  if (!proposal_) return std::nullopt;
  const std::uint64_t session = proposal_->session;
  proposal_.reset();
  return session;
}

Result<std::uint64_t> PlacesInUse::accept(const std::set<SensorId>& configured) {
  if (!proposal_)
    return fail(ErrorCode::NotFound, "registration", "no registration waits to be accepted");
  Registration next = proposal_->registration;
  keep_configured(next, configured);
  if (next.sensors.empty()) return none_configured();
  for (auto& [sensor, own] : next.verdicts) own.unconfirmed = false;
  const std::uint64_t session = *drop_proposal();
  adopt(std::move(next));
  return session;
}

Result<void> PlacesInUse::undo(const std::set<SensorId>& configured) {
  if (!earlier_)
    return fail(ErrorCode::NotFound, "registration", "no registration from before is known");
  Registration back = *earlier_;
  keep_configured(back, configured);
  if (back.sensors.empty()) return none_configured();
  earlier_.reset();
  keep_earlier(now_);
  lacks_displaced_ = false;
  replace(std::move(back));
  return {};
}

void PlacesInUse::displace(const SensorId& sensor, const std::string& reason) {
  if (!std::exchange(lacks_displaced_, true)) keep_earlier(now_);
  replace(without(now_, sensor, reason));
}

Result<void> PlacesInUse::move_origin(const Origin& origin) {
  auto next = with_origin(now_, origin);
  if (!next) return pass(next);
  if (proposal_) {
    if (auto moved = with_origin(proposal_->registration, origin))
      proposal_->registration = std::move(*moved);
  }
  lacks_displaced_ = false;
  keep_earlier(now_);
  replace(std::move(*next));
  return {};
}

void PlacesInUse::forget() {
  if (!now_.sensors.empty()) forgotten_ = anchors_of(now_);
  lacks_displaced_ = false;
  keep_earlier(now_);
  const std::uint64_t version = now_.version;
  now_ = Registration{};
  now_.version = version;
}

void PlacesInUse::keep(const std::set<SensorId>& configured) {
  keep_configured(now_, configured);
  if (before_) keep_configured(*before_, configured);
}

}  // namespace chorus::core
