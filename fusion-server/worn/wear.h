// Everything that the server knows of inertial sensors which people wear: who wears which source,
// how each sensor sits on its limb, and what that says at an instant.
//
// Pure: frames and fused bodies go in, orientations of limbs come out; times are arguments.  It
// learns from what the views show alone (FusedBody::sighted), so no sensor confirms itself.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/evaluation/wearing.h"
#include "common/inertial/orientation_history.h"
#include "fusion-server/flow/fused_body.h"
#include "fusion-server/flow/worn_people.h"
#include "fusion-server/flow/worn_report.h"
#include "fusion-server/worn/beginning.h"
#include "fusion-server/worn/wearer.h"
#include "fusion-server/worn/worn_sensor.h"

namespace chorus::worn {

class Wear {
 public:
  /// Forgets sources that are not followed any more, and everything when it is switched off.
  void configure(const WornConfig& config, const std::set<SensorId>& sources);

  /// Takes what a source said; the times are by our clock.
  void take(inertial::InertialFrame frame);
  /// What calibrated sensors say of the limbs of those who are known to wear them.
  [[nodiscard]] WornPeople say(Timestamp instant) const;
  /// Learns from the bodies that were fused at `instant`; at most one fit.
  void learn(const std::vector<FusedBody>& bodies, Timestamp instant);
  /// The world has changed: headings and people are others.
  void leave_world();

  [[nodiscard]] std::vector<WornReport> reports(Timestamp now) const;

  /// Who wears a source, and the sensors that are calibrated and have never slipped.
  struct Worn {
    SensorId source;
    std::optional<PersonId> wearer;
    std::map<std::string, FirstCalibration> sensors;
  };
  [[nodiscard]] std::vector<Worn> worn() const;
  /// Begins with what a first pass has found: its wearer wears a source from the instant at which
  /// they are first seen, where and when they were.
  void begin_with(const std::vector<Beginning>& beginnings);

 private:
  struct Source {
    inertial::OrientationHistory history;
    std::optional<PersonId> wearer;
    double seen = 0.0;                          ///< When the wearer was last seen [s],
    std::optional<Eigen::Vector3d> place = {};  ///< where [m],
    std::vector<PersonId> beside = {};          ///< and who else was.
    WearerSearch search;
    std::map<std::string, WornSensor> sensors;
    std::vector<std::string> unplaced;  ///< Sensors whose limb is not known.
  };

  [[nodiscard]] double time_of(Timestamp instant) const;
  void search_wearer(Source& source, const std::vector<inertial::InertialReading>& readings,
                     const std::vector<FusedBody>& bodies, double time);
  void learn_limbs(Source& source, const std::vector<inertial::InertialReading>& readings,
                   const FusedBody& body, double time);
  [[nodiscard]] bool calibrate_one(double time);
  void begin(const std::vector<FusedBody>& bodies, Timestamp instant);
  void follow_wearer(Source& source, const std::vector<FusedBody>& bodies, double time) const;

  WornConfig config_;
  std::map<SensorId, Source> sources_;
  std::map<SensorId, Beginning> beginnings_;  ///< Those whose wearer has not been seen yet.
  std::optional<Timestamp> origin_;           ///< Of the times in seconds.
};

}  // namespace chorus::worn
