// /registration: the extrinsics, what is wrong with them, and the session that improves them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/resource/node.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/status/registration_progress.h"
#include "fusion-server/status/session_status.h"

namespace chorus::wire {

[[nodiscard]] resource::Node registration_node(const Registration& registration,
                                               const RegistrationProgress& progress);

/// /registration/sessions/{id}: progress and outcome.  `awaits` is shown while the session is
/// running.
[[nodiscard]] resource::Node session_node(const SessionStatus& session,
                                          const std::vector<std::string>& awaits);

/// The state's name on the wire: "collecting", "solving", "done", "cancelled".
[[nodiscard]] std::string_view name_of(SessionState state) noexcept;

/// The path of a session: "/registration/sessions/7".
[[nodiscard]] std::string session_path(std::uint64_t id);

[[nodiscard]] std::vector<std::string> names_of(const std::vector<SensorId>& sensors);

/// The verdict's name on the wire: "Good", "Provisional", "Refused", "None".
[[nodiscard]] std::string_view name_of(Verdict verdict) noexcept;
[[nodiscard]] std::optional<Verdict> verdict_named(std::string_view name) noexcept;

/// "at-once" or "when-accepted", as in the configuration.
[[nodiscard]] std::string_view name_of(Adoption adoption) noexcept;
[[nodiscard]] std::optional<Adoption> adoption_named(std::string_view name) noexcept;

}  // namespace chorus::wire
