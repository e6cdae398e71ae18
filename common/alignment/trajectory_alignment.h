// Aligns what we saw of a person with what another tracker saw of a marker on that person.
//
// The motion itself tells everything: by how much the clocks differ, how the two worlds stand to
// each other, and, if wanted, where the marker sits beside our joint.  docs/guide/align.md.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus::alignment {

/// One of the two trajectories at one time.
struct TracePoint {
  double time = 0.0;                                ///< [s]
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< [m]
  /// Axes that the marker's offset is given in: of the marker (reference), or of the body (ours).
  std::optional<Eigen::Quaterniond> axes = {};
};
/// In the order of time.
using Trace = std::vector<TracePoint>;

struct AlignmentConfig {
  bool full = false;           ///< Six degrees of freedom; else yaw and translation.
  bool marker_offset = false;  ///< Also find where the marker sits beside the joint.
  /// Largest difference of the two clocks [s]; none: anything at which the traces overlap.
  std::optional<double> clock_range = 2.0;
  double max_gap = 0.1;  ///< Longest hole of the reference that is interpolated [s].
};

struct Alignment {
  Eigen::Isometry3d ours_from_reference = Eigen::Isometry3d::Identity();
  double clock_offset = 0.0;  ///< Added to the reference's stamps to get ours [s].
  /// Place of our joint relative to the marker [m]: in the marker's axes if the reference has
  /// poses, else in the body's (left, up, front; up is then not found and stays 0).
  std::optional<Eigen::Vector3d> marker_offset = {};
  bool marker_height = false;              ///< How high the marker is was found, too.
  std::vector<Eigen::Vector3d> residuals;  ///< Ours minus the reference's, in our world [m].
  std::vector<double> times;               ///< Of the residuals, by our clock [s].
  double yaw_sigma = 0.0;                  ///< [rad]
  double place_sigma = 0.0;                ///< Per axis, in the middle of the walk [m].
  double clock_sigma = 0.0;                ///< [s]
};

/// Errors: NotFound, they have too little time in common (5 s, 60 samples); InvalidArgument, the
/// person walked too little, or in a way that does not tell the clocks or the front; Conflict, they
/// do not show one motion, or several clock offsets fit alike.
[[nodiscard]] Result<Alignment> align_traces(const Trace& ours, const Trace& reference,
                                             const AlignmentConfig& config = {});

}  // namespace chorus::alignment
