// What the fusion server tells of one registration session: its progress, then its outcome.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/base/strong_id.h"
#include "common/time/timestamp.h"
#include "fusion-server/flow/registration.h"

namespace chorus {

enum class SessionState {
  Collecting,  ///< Waiting for somebody to walk long enough.
  Solving,     ///< The walk is over; its final solve is running.
  Done,        ///< Verdict and reasons are final.
  Cancelled,
};

/// What two sensors saw together during a session.
struct PairCoverage {
  SensorId first;
  SensorId second;
  std::size_t sightings = 0;  ///< Instants at which both saw the only person.
  double spread = 0.0;        ///< RMS distance of the person's places at these instants from their
                              ///< mean [m].
  /// 95 % radius of the place of one sensor relative to the other, as it is to be expected [m].
  double expected = 0.0;

  bool operator==(const PairCoverage&) const = default;
};

/// A square of half a metre of the floor on which somebody walked.
struct CoveredCell {
  double x = 0.0;           ///< x of its middle, world [m].
  double z = 0.0;           ///< [m]
  std::size_t sensors = 0;  ///< Number of sensors that saw somebody there.

  bool operator==(const CoveredCell&) const = default;
};

/// How accurately a session has placed one sensor so far.
struct SensorAccuracy {
  SensorId sensor;
  /// 95 % radius of the sensor's place on the floor, relative to the master [m]; none: the last
  /// solve did not place the sensor.
  std::optional<double> radius;

  bool operator==(const SensorAccuracy&) const = default;
};

/// When the result of a session comes into use.
enum class Adoption {
  AtOnce,  ///< Places that are unconfirmed (flow/registration.h) wait all the same.
  /// After somebody has accepted it, if another registration is in use; else at once.
  WhenAccepted,
};

/// One registration session: its progress, then its outcome.
struct SessionStatus {
  std::uint64_t id = 0;  ///< Increases with each session; never reused.
  SessionState state = SessionState::Done;
  bool automatic = false;  ///< True if the server started it without a client's request.
  Adoption adoption = Adoption::AtOnce;
  Timestamp started;
  double elapsed = 0.0;             ///< Length of the walk collected so far [s].
  double target = 0.0;              ///< Length of the walk that is wanted [s].
  Verdict verdict = Verdict::None;  ///< The verdict of the last solve.
  bool adopted = false;  ///< True if its result is, or was, in use and was not withdrawn.
  /// What was wrong with the last solve, and what became of its result.
  std::vector<std::string> reasons;
  /// The session ends by itself once all sensors are placed with this radius or less [m]; 0: never.
  double target_radius = 0.0;
  bool reached = false;                  ///< True once the session ends because of `target_radius`.
  std::vector<SensorAccuracy> accuracy;  ///< One entry for each sensor of the last solve.
  std::vector<PairCoverage> pairs;       ///< What each pair of sensors has seen together.
  std::vector<CoveredCell> cells;        ///< Where people walked; empty until sensors have places.

  bool operator==(const SessionStatus&) const = default;
};

[[nodiscard]] constexpr bool running(const SessionStatus& session) {
  return session.state == SessionState::Collecting || session.state == SessionState::Solving;
}

}  // namespace chorus
