// Where a person walks: a scripted, closed loop of legs, turns and pauses, as a pure function of
// time.
//
// The loop repeats for ever, so the person has a place at every UTC instant, and all processes with
// the same script agree on it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/base/duration.h"
#include "common/synthetic/reach.h"

namespace chorus::synthetic {

enum class PathKind { Random, Circle, Line, Stand, Turn, Assembly };

/// The configuration's names of the kinds, in the order of PathKind.
inline constexpr std::array<std::string_view, 6> kPathNames{"random", "circle", "line",
                                                            "stand",  "turn",   "assembly"};

struct PathScript {
  PathKind kind = PathKind::Random;
  std::uint64_t seed = 1;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< World x, z [m]
  double reach = 1.2;   ///< Radius of the area or the circle, or half the length of the line [m].
  double speed = 0.9;   ///< Cruising speed [m/s]
  double stride = 1.3;  ///< Distance per gait cycle at amplitude 1 [m].
  double period = 1.1;  ///< Duration of a gait cycle, as recorded [s].
};

struct PathPoint {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< World x, z [m]
  double heading = 0.0;    ///< Direction of walking, as yaw about +y; 0: +z [rad]
  double phase = 0.0;      ///< Phase of the gait [cycles].
  double amplitude = 0.0;  ///< Amplitude of the strides, 0: standing, 1: as recorded.
  Reach reach{};           ///< What a hand reaches for, in the person's walk frame (see reach.h).
};

class Path {
 public:
  explicit Path(const PathScript& script);

  [[nodiscard]] PathPoint at(Duration since_epoch) const;
  [[nodiscard]] Duration loop() const noexcept { return from_seconds(loop_); }

 private:
  enum class Move { Walk, Turn, Pause, Orbit, Aside, Reach };
  struct Leg {
    Move move = Move::Pause;
    double start = 0.0;     ///< Time at which the leg starts, within the loop [s].
    double duration = 0.0;  ///< [s]
    Eigen::Vector2d from = Eigen::Vector2d::Zero();
    Eigen::Vector2d to = Eigen::Vector2d::Zero();
    double heading = 0.0;  ///< Heading at the start of the leg [rad].
    double turn = 0.0;     ///< Total turn [rad].
    double speed = 0.0;    ///< Cruising speed of this leg [m/s].
    double ramp = 0.0;  ///< Time to reach that speed, and to stop; for a hand, time each way [s].
    synthetic::Reach reach{};
  };

  void walk_to(const Eigen::Vector2d& target);
  void turn_to(double heading);
  void turn_by(double turn);
  void step_aside(const Eigen::Vector2d& target);
  void reach_for(bool left, const Eigen::Vector3d& target, double hold);
  void pause(double duration);
  void add(Leg leg);
  void wander();
  void line();
  void circle();
  void turn_in_place();
  void assemble();
  [[nodiscard]] PathPoint along(const Leg& leg, double time) const;

  PathScript script_;
  double amplitude_ = 1.0;  ///< Amplitude of the strides at cruising speed.
  double cadence_ = 1.0;    ///< Gait cycles per second.
  double loop_ = 0.0;       ///< [s]
  /// Where the last leg ends, while the path is built.
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  double heading_ = 0.0;
  std::vector<Leg> legs_;
};

}  // namespace chorus::synthetic
