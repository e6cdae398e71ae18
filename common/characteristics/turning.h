// At which angle of the person a sensor exchanges left and right, and at which it changes back.
//
// A body tracker may assume that everybody faces it (Otto et al. 3.2).  If a person turns away, it
// exchanges the labels near 130 deg and, when they turn back, changes them back between 100 and 40.
// How far a person has turned is seen without labels: the line through the shoulders is the same
// when its ends are exchanged, so it is followed from frame to frame modulo half a turn, from a
// person who faces the sensor on.  Between 30 and 150 deg that line is not trusted (Otto Fig. 6:
// trackers lag behind).  There the angle is assumed to grow evenly with time: exact for a robot,
// good to some 10 deg for a person.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/characteristics/one_person.h"

namespace chorus::characteristics {

/// How the person stands in one sight.
struct Stance {
  /// Angle of the person's front away from the sensor, not wrapped at whole turns; 0: facing it
  /// [rad].  None where no shoulders are seen.
  std::optional<double> angle;
  bool exchanged = false;  ///< Left and right are exchanged, if there is an angle.
};

/// The time of a whole turn at constant speed, as on a turntable [s since the first frame].
struct KnownTurn {
  double from = 0.0;
  double to = 0.0;
};

/// One for each sight.  The person must face the sensor, within 90 deg, when the recording begins.
/// If turns are known, the angle follows from them alone; only the direction of each is taken from
/// what its beginning shows.  They are needed for trackers that take a side for a front and turn
/// the body back, because their shoulders never show the rear.
[[nodiscard]] std::vector<Stance> stances_of(const OnePerson& person,
                                             const std::vector<KnownTurn>& turns = {});

/// The angle of a stance without whole turns and sign: from 0 (facing the sensor) to pi.
[[nodiscard]] double away_from_sensor(double angle);

inline constexpr std::size_t kTurnSectors = 12;  ///< Of 15 deg, as in facing/exchange_habit.h.

/// What was seen while the person's front was in one sector, turning away and turning back.
struct TurnSector {
  double away_s = 0.0, back_s = 0.0;                      ///< How long [s].
  double exchanged_away_s = 0.0, exchanged_back_s = 0.0;  ///< How long with exchanged labels [s].
};

enum class FrontRear {
  Unknown,         ///< Nobody turned their back for a second.
  Tells,           ///< Labels are right from behind.
  TakesForFacing,  ///< Labels are exchanged from behind, as if everybody faced the sensor.
  Mirrored,        ///< Labels are exchanged in front: a mirrored picture.
  Unclear,         ///< The person walks, or seems to end with their back to the sensor.
  Mixed,           ///< Labels from behind are exchanged at some times only.
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
