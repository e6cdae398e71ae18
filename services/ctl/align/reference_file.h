// What another tracker measured: places, and perhaps poses, of named bodies over time, from a CSV.
//
// Three forms: OptiTrack Motive's; ours (`chorus export --format csv`: each joint is a body); and a
// plain table with columns time, x, y, z, and where they are known name, qx, qy, qz, qw.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/result.h"

namespace chorus::ctl {

/// Axes of the reference; places are converted to ours: right-handed, +y up, metres.
enum class ReferenceAxes {
  YUp,    ///< Right-handed, +y up: Motive, OpenVR, VRPN, ours.
  ZUp,    ///< Right-handed, +z up, (x, y, z) -> (x, z, -y): VRED, A.R.T. "normal", Vicon.
  Unity,  ///< Left-handed, +y up, (x, y, z) -> (x, y, -z).
};
inline constexpr std::pair<std::string_view, ReferenceAxes> kReferenceAxes[] = {
    {"y-up", ReferenceAxes::YUp}, {"z-up", ReferenceAxes::ZUp}, {"unity", ReferenceAxes::Unity}};

struct ReferenceOptions {
  ReferenceAxes axes = ReferenceAxes::YUp;
  /// None: as the file says; metres where it says nothing.
  std::optional<double> metres_per_unit = {};
};

struct ReferenceSample {
  double time = 0.0;  ///< [s], since 1970 if Reference::utc, else by the tracker's own clock.
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> turn = {};  ///< reference_from_body, in our axes.
};

struct Reference {
  /// By name, in the order of time; "" where the file names none.
  std::map<std::string, std::vector<ReferenceSample>> bodies;
  bool utc = false;
};

/// Reads the text of such a file; `name` is for messages.  Samples without a finite place are left
/// out.  Malformed: none of the three forms, no body, or time that does not increase.
[[nodiscard]] Result<Reference> read_reference(std::string_view text, const std::string& name,
                                               const ReferenceOptions& options);

}  // namespace chorus::ctl
