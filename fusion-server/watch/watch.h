// Detects that a sensor was moved, by comparing where it and the other sensors see people in
// everyday use.
//
// Pure: views of people go in, instant by instant; findings come out.  Only people who walk count:
// the error of somebody who stands still is constant and contains nothing new.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "fusion-server/flow/person.h"
#include "fusion-server/watch/shift_test.h"
#include "fusion-server/watch/watch_config.h"

namespace chorus::watch {

struct Finding {
  SensorId sensor;
  /// Set if only the sensor and this other one saw people together: one of them was moved, but it
  /// is unknown which.
  std::optional<SensorId> or_else;
  double shift = 0.0;    ///< Distance between where it and where the others see people [m].
  bool drifted = false;  ///< True if it has lasted for minutes, false if it began recently.
  Timestamp since;       ///< When it began; for a drift, the latest instant.
};

class Watch {
 public:
  /// Takes the views of one instant; instants increase.  `config` may change at any time.
  void look(const std::vector<Person>& people, Timestamp instant, const WatchConfig& config);

  /// The sensor that stands out most at present; none if no sensor does.
  [[nodiscard]] std::optional<Finding> finding() const;
  /// How far this sensor now sees people from where it would usually see them, as compared with the
  /// others [m]; none until somebody has walked for a while.
  [[nodiscard]] std::optional<double> shift_of(const SensorId& sensor) const;

  /// Forgets what is usual for each sensor.  Call this when a sensor has a new place, because what
  /// is usual for the others was learned relative to that sensor, too.
  void forget();

 private:
  struct Watched {
    std::vector<Residual> open;  ///< Residuals of the block that is being filled.
    Timestamp began;
    /// Recent blocks, not yet learned from, so that a shift is compared with the time before it.
    std::deque<Block> recent;
    StandingError usual;
    ShiftTest test;
    Shift shift;
    double drift = 0.0;  ///< Error of the place alone [m]; 0: not significant.
  };
  struct Walker {
    Eigen::Vector3d smoothed = Eigen::Vector3d::Zero();
    Timestamp seen;
  };

  [[nodiscard]] bool walks(const Person& person, Timestamp instant);
  void add(Residual residual, Timestamp instant);
  void close(Watched& sensor);
  void judge(Watched& sensor) const;
  [[nodiscard]] bool is_moved(const Watched& sensor) const;
  [[nodiscard]] double size_of(const Watched& sensor) const;

  WatchConfig config_;
  Timestamp last_;
  std::map<PersonId, Walker> walkers_;
  std::map<SensorId, Watched> sensors_;
};

}  // namespace chorus::watch
