// Tells that a worn sensor has turned on its limb, and stays so.
//
// Of a sensor that slipped, the error about the limb's axes (Baak et al., Eq. 13) has a step.  What
// is looked at is the median of each axis over the last seconds in which the limb was seen: single
// wrong instants do not move it.  It must exceed WornConfig::slip by three times what the limb's
// median usually wanders by (skin turns on forearms, and what cameras err by follows the pose), for
// longer than half the window.
#pragma once

#include <deque>
#include <optional>

#include <Eigen/Core>

namespace chorus::worn {

class SlipWatch {
 public:
  /// `usual`: what the calibration's residual was about one axis [rad]; `least`: WornConfig::slip.
  SlipWatch(double usual, double least) : usual_(usual), least_(least) {}
  SlipWatch() = default;

  /// Takes the error of an instant [rad], `time` [s]; its y counts only where `twist_seen`.
  void learn(double time, const Eigen::Vector3d& error, bool twist_seen);
  /// By how much the sensor has turned [rad], once that lasts.
  [[nodiscard]] std::optional<double> slipped() const { return slipped_; }
  /// The size of the median error now [rad]; 0 before there is one.
  [[nodiscard]] double turned() const { return turned_; }

 private:
  struct Look {
    double time;
    Eigen::Vector3d error;
    bool twist_seen;
  };
  [[nodiscard]] double median_size() const;

  double usual_ = 0.0;
  double least_ = 0.0;
  std::deque<Look> looks_;
  double wander_ = 0.0;  ///< Mean size of the median while nothing has slipped [rad].
  double weight_ = 0.0;
  double turned_ = 0.0;
  std::optional<double> beyond_since_;
  std::optional<double> slipped_;
};

}  // namespace chorus::worn
