// C3D: labelled points over time, binary (https://www.c3d.org, "The C3D File Format: User Guide").
//
// Blocks of 512 bytes: a header, parameters in groups, then frames of four numbers per point (x, y,
// z, residual and camera mask): 16-bit integers times POINT:SCALE or, if that is negative, floats.
// Reads Intel, DEC (VAX floats) and MIPS byte orders; skips analog samples.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"
#include "common/motion/motion.h"

namespace chorus::motion {

struct C3dPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< In the file's axes [m].
  float residual = -1.0f;  ///< [m]; 0: interpolated or modelled; negative: missing.

  [[nodiscard]] bool valid() const { return residual >= 0.0f; }
};

struct C3d {
  std::vector<std::string> labels;  ///< One per point; "" if the file has no name for it.
  double rate_hz = 0.0;
  std::vector<std::vector<C3dPoint>> frames;
  /// Turns the file's axes into ours (+y up), by POINT:X_SCREEN and Y_SCREEN.  In a file without
  /// these, +z is up, as is usual in biomechanics.
  Eigen::Matrix3d world_from_file = Eigen::Matrix3d::Identity();
  std::string processor;  ///< "Intel", "DEC" or "MIPS"
};

/// A larger file is refused.
inline constexpr std::size_t kMaxC3dBytes = 128u << 20;

/// Parses a file.  Refuses headers and parameters that point outside the file or announce more
/// frames than it contains.  Coordinates that are not finite, or beyond 10 km, count as missing.
[[nodiscard]] Result<C3d> parse_c3d(std::string_view bytes, std::string_view origin);

/// One person of a C3D file.
struct C3dSubject {
  std::string name;  ///< From the labels, before the colon ("P1:Head"); "" if there is none.
  Motion motion;
};

struct C3dMotion {
  std::vector<C3dSubject> subjects;        ///< In the order in which the file names them.
  std::vector<std::string> unused_labels;  ///< Labels of points that belong to no joint.
};

/// Finds joints by label: first our own 25 names, then joint centres (LHJC, LKJC, ...), then
/// Plug-in Gait's segment origins (LFEP, LFEO, ...), and last skin markers or their means, which
/// count as inferred.  c3d_labels.cpp has the table.  Refuses a file in which no subject has two
/// joints; the error names some of the file's labels.
[[nodiscard]] Result<C3dMotion> motion_from_c3d(const C3d& c3d);

}  // namespace chorus::motion
