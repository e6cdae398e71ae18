// Named points over time, as C3D and TRC files hold them, and the joints that they make.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/motion/joint_names.h"
#include "common/motion/motion.h"

namespace chorus::motion {

struct MarkerPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< In the file's axes [m].
  float residual = -1.0f;  ///< [m]; 0: interpolated or modelled; negative: missing.

  [[nodiscard]] bool valid() const { return residual >= 0.0f; }
};

struct MarkerTracks {
  std::vector<std::string> labels;  ///< One per point; "" if the file has no name for it.
  double rate_hz = 0.0;
  std::vector<double> times = {};  ///< Of the frames [s], if the file states them.
  std::vector<std::vector<MarkerPoint>> frames;
  Eigen::Matrix3d world_from_file = Eigen::Matrix3d::Identity();  ///< Into ours (+y up).
  double metres_per_unit = 1.0;                                   ///< Of the file's coordinates.
  std::vector<std::string> notes = {};  ///< What was salvaged, left out or contradictory.
};

/// One person of a file.
struct MarkerSubject {
  std::string name;  ///< From the labels, before the colon ("P1:Head"); "" if there is none.
  Motion motion;
};

struct MarkerMotion {
  std::vector<MarkerSubject> subjects;     ///< In the order in which the file names them.
  std::vector<std::string> unused_labels;  ///< Labels of points that belong to no joint.
};

/// Finds joints by label (joint_names.h): `chosen`, our own names, joint centres, skin markers.
/// Subjects are what stands before a colon, or, where that finds more joints, before an underscore.
/// Spine, neck and hands that no label names are inferred.  Unsupported when no subject has two
/// joints; the error lists the file's labels.
[[nodiscard]] Result<MarkerMotion> motion_from_markers(const MarkerTracks& tracks,
                                                       const JointChoice& chosen = {});

}  // namespace chorus::motion
