// The registration in use and those that may replace it: the one from before, the provisional one
// of the running session, and a proposal that waits for a decision.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "common/base/result.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/core/world.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/status/registration_progress.h"

namespace chorus::core {

class PlacesInUse {
 public:
  explicit PlacesInUse(Registration registration) : now_(std::move(registration)) {}

  [[nodiscard]] const Registration& now() const noexcept { return now_; }
  /// Without what the running session has put into use for the time being.
  [[nodiscard]] const Registration& settled() const { return before_ ? *before_ : now_; }
  /// Whether the one in use is a provisional one of the running session.
  [[nodiscard]] bool provisional() const noexcept { return before_.has_value(); }
  /// What undo() goes back to; never a provisional one.
  [[nodiscard]] const std::optional<Registration>& earlier() const noexcept { return earlier_; }
  void set_earlier(Registration registration) { earlier_ = std::move(registration); }
  [[nodiscard]] const std::optional<Proposal>& proposal() const noexcept { return proposal_; }

  /// What a solve makes of `base`; after forget(), it is moved into the world that users of the
  /// output still rely on.  Errors: as adopted().
  [[nodiscard]] Result<Registration> successor(const Registration& base,
                                               const Registration& candidate, SolveKind kind,
                                               bool hold) const;
  /// Puts it into use.  undo() goes back to the settled one, or, if a sensor was displaced since,
  /// to the one from before that.
  void adopt(Registration next);
  void adopt_provisionally(Registration next);
  /// Withdraws the provisional registration; false if there is none.
  bool take_back();
  /// The session has ended: what is in use is no longer provisional.
  void settle() { before_.reset(); }
  /// Notes why sensors have no place after this solve; `contradicted`: it contradicts the places.
  void note(const Registration& candidate, bool contradicted);

  void propose(Proposal proposal) { proposal_ = std::move(proposal); }
  /// Forgets the proposal; returns the session that made it, none if there was no proposal.
  std::optional<std::uint64_t> drop_proposal();
  /// Puts the proposal into use and returns the session that made it.  NotFound when there is none,
  /// or when none of its sensors is configured any more.
  [[nodiscard]] Result<std::uint64_t> accept(const std::set<SensorId>& configured);

  /// Exchanges the registration in use with the one from before.  NotFound when there is none, or
  /// when none of its sensors is configured any more.
  [[nodiscard]] Result<void> undo(const std::set<SensorId>& configured);
  /// Removes the place of a sensor that was moved.
  void displace(const SensorId& sensor, const std::string& reason);
  /// Moves the one in use and the proposal.  Errors: as with_origin().
  [[nodiscard]] Result<void> move_origin(const Origin& origin);
  /// Gives all places up; the next registration is moved into the same world.
  void forget();
  /// Forgets places of sensors that are no longer configured: they must not constrain a solve.
  void keep(const std::set<SensorId>& configured);

 private:
  void replace(Registration next);
  void keep_earlier(const Registration& used);

  Registration now_;
  std::optional<Registration> before_;  ///< Set while a provisional one is in use.
  std::optional<Registration> earlier_;
  std::optional<Proposal> proposal_;
  bool lacks_displaced_ = false;  ///< `earlier_` is from before a sensor was displaced.
  Anchors forgotten_;             ///< Of the last registration that was forgotten.
};

}  // namespace chorus::core
