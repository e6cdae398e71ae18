// What becomes of a result that somebody has to accept first.
#include <algorithm>
#include <utility>

#include "fusion-server/core/accuracy.h"
#include "fusion-server/core/registrar.h"

namespace chorus::core {

bool Registrar::asks_first(const SessionStatus& session) const {
  const Registration& used = before_ ? *before_ : registration_;
  return session.adoption == Adoption::WhenAccepted && !used.sensors.empty();
}

Outcome Registrar::propose(Registration next, const Registration& candidate, Timestamp now) {
  // A session that began by itself may have adopted something before a client took it over.
  const bool withdrawn = take_back();
  drop_proposal("replaced by another proposal");
  auto changes = place_changes(registration_, next);
  proposal_ = Proposal{sessions_.front().id, std::move(next), std::move(changes)};
  sessions_.front().adopted = false;
  back_off(candidate, now);
  end_session(SessionState::Done);
  return withdrawn ? Outcome::Withdrawn : Outcome::Nothing;
}

/// Forgets the proposal, and adds `reason` to the session that made it, if that is still listed.
void Registrar::drop_proposal(const std::string& reason) {
  if (!proposal_) return;
  const auto own = std::ranges::find(sessions_, proposal_->session, &SessionStatus::id);
  if (own != sessions_.end()) own->reasons.push_back(reason);
  proposal_.reset();
}

Result<void> Registrar::accept() {
  if (auto idle = unless_busy("registration"); !idle) return pass(idle);
  if (!proposal_)
    return fail(ErrorCode::NotFound, "registration", "no registration waits to be accepted");
  Registration next = proposal_->registration;
  keep_configured(next, config_.sensors);
  if (next.sensors.empty())
    return fail(ErrorCode::NotFound, "registration", "none of its sensors is configured any more");
  const auto own = std::ranges::find(sessions_, proposal_->session, &SessionStatus::id);
  if (own != sessions_.end()) own->adopted = true;
  proposal_.reset();
  for (const auto& [sensor, place] : next.sensors) retries_.forget(sensor);
  if (!std::exchange(lacks_displaced_, false)) keep_earlier(registration_);
  replace(std::move(next));
  return {};
}

Result<void> Registrar::decline() {
  if (!proposal_)
    return fail(ErrorCode::NotFound, "registration", "no registration waits to be accepted");
  drop_proposal("declined; the registration from before stays in use");
  return {};
}

}  // namespace chorus::core
