// At which angle of the person a sensor exchanges left and right, and at which it changes back.
//
// A body tracker may take everybody for facing it (Otto et al. 3.2): of somebody who turns it
// exchanges the labels near 130 deg and, on the way back, between 100 and 40.  How far a person has
// turned is seen without labels: the line through the shoulders is the same line when its ends are
// exchanged, so that it is followed from frame to frame modulo half a turn.  It begins as the half
// turn in which the person faces the sensor.  Between 30 and 150 deg that line is not to be
// trusted (Otto Fig. 6: trackers lag behind), so there the angle is taken as growing evenly with
// time from the one side to the other: exact for a robot, good to some 10 deg for a person.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/characteristics/one_person.h"

namespace chorus::characteristics {

/// How the person stands in one sight.
struct Stance {
  /// Of the front away from the sensor, counted on over whole turns; 0: facing it [rad].  None
  /// where no shoulders are seen.
  std::optional<double> angle;
  bool exchanged = false;  ///< Left and right are exchanged, if there is an angle.
};

/// A whole turn that is known to be even, as on a turntable: seconds since the first frame.
struct KnownTurn {
  double from = 0.0;
  double to = 0.0;
};

/// One for each sight.  The person must face the sensor, within 90 deg, when the recording begins.
/// If turns are known, they alone are the angle; which way each goes is seen from its beginning.
/// They are needed for trackers that turn the body back when they take a side for a front: of such
/// a turn the shoulders never show the rear.
[[nodiscard]] std::vector<Stance> stances_of(const OnePerson& person,
                                             const std::vector<KnownTurn>& turns = {});

/// The angle of a stance without its turns and its sign: 0 (facing the sensor) to pi.
[[nodiscard]] double away_from_sensor(double angle);

inline constexpr std::size_t kTurnSectors = 12;  ///< Of 15 deg, as facing's habits.

/// What was seen while the person's front was in one sector, turning away and turning back.
struct TurnSector {
  double away_s = 0.0, back_s = 0.0;                      ///< How long [s].
  double exchanged_away_s = 0.0, exchanged_back_s = 0.0;  ///< Of that with exchanged labels [s].
};

enum class FrontRear {
  Unknown,         ///< Nobody turned their back for a second.
  Tells,           ///< Labels are right from behind.
  TakesForFacing,  ///< Labels are exchanged from behind, as if everybody faced the sensor.
  Mirrored,        ///< Labels are exchanged in front: a mirrored picture.
  Unclear,         ///< The person walks, or ends with their back to the sensor, it seems.
  Mixed,           ///< Now this, now that.
};

struct Exchange {
  FrontRear front_rear = FrontRear::Unknown;
  std::array<TurnSector, kTurnSectors> sectors{};
  std::vector<double> out;   ///< Angles at which labels were exchanged, in order of time [rad].
  std::vector<double> back;  ///< Angles at which they were changed back [rad].
  double turned = 0.0;       ///< The sum of all turning [rad].
};

[[nodiscard]] Exchange exchange_of(const OnePerson& person, const std::vector<Stance>& stances);

}  // namespace chorus::characteristics
