// What the fusion server tells of registration as a whole: its sessions, a result that waits for
// somebody's word, and whether the result in use is stored.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/strong_id.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/status/session_status.h"

namespace chorus {

/// What a proposed registration would change for one sensor.
struct PlaceChange {
  SensorId sensor;
  /// 95 % radii of the sensor's place on the floor, relative to the master [m], in the registration
  /// in use and in the proposed one; none: it has no place there, or the radius is not known.
  std::optional<double> radius_now;
  std::optional<double> radius_then;
  /// How far the sensor would move [m] and turn [rad]; none: it has no place in one of the two.
  std::optional<double> shift;
  std::optional<double> turn;

  bool operator==(const PlaceChange&) const = default;
};

/// The result of a session that waits until somebody accepts or declines it.
struct Proposal {
  std::uint64_t session = 0;
  Registration registration;  ///< In the world of the one in use.
  std::vector<PlaceChange> changes;
};

/// Where the registration is kept across restarts.
struct StorageStatus {
  std::string folder;   ///< Empty: the registration is not kept.
  std::string trouble;  ///< Why the last attempt to store something failed; empty if none did.
  /// What was wrong with the file at the start, and what became of it; empty once a registration
  /// has been stored, or if nothing was.
  std::string damage;
  bool writing = false;  ///< True until the registration put into use last has been written.

  bool operator==(const StorageStatus&) const = default;
};

/// The progress of registration; the registration in use is separate.
struct RegistrationProgress {
  std::vector<SessionStatus> sessions;  ///< The last few, newest first.
  std::uint64_t next_session = 1;       ///< Id of the next one.
  std::vector<std::string> awaits;      ///< What is missing at present, as sentences for people.
  std::optional<Registration> earlier;  ///< The one in use before; an undo returns to it.
  std::optional<Proposal> proposal;     ///< Waits to be accepted or declined.
  std::vector<std::string> alarms;      ///< The alarms of all sensors, for people.
  StorageStatus storage;
  /// True while the registration in use is one that the running session has put there; it is stored
  /// at the session's end.
  bool own_provisional = false;
  std::vector<SensorId> unpolled;  ///< Sensors with a place that are not configured.
  std::uint64_t commands = 0;      ///< How many commands of clients were carried out.
};

/// Whether the registration in use is the one that the next start would find.
[[nodiscard]] inline bool stored(const RegistrationProgress& progress) {
  const StorageStatus& storage = progress.storage;
  return !storage.folder.empty() && storage.trouble.empty() && !storage.writing &&
         !progress.own_provisional;
}

}  // namespace chorus
