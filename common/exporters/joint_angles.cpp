#include "common/exporters/joint_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "common/base/units.h"
#include "common/exporters/number_text.h"
#include "common/posture/isb.h"

namespace chorus::exporters {
namespace {

using posture::IsbAngles;
using posture::kIsbJoints;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kWhole = 2.0 * std::numbers::pi;
constexpr int kDegreeDigits = 3;  // decimals of a degree
constexpr int kPlaceDigits = 5;   // decimals of a metre

/// Moves the angle by whole turns until it is nearest to the one before.
double continued(double angle, double before) {
  if (!std::isfinite(angle) || !std::isfinite(before)) return angle;
  return before + std::remainder(angle - before, kWhole);
}

/// Standard deviations of the angles, from those of the joints' positions.
IsbAngles deviations(const Pose& pose, const Located& joints) {
  IsbAngles sums{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (!joints[j]) continue;
    if (!std::isfinite(pose.variance[j])) {
      for (auto& each : sums) each.fill(kUnknown);
      return sums;
    }
    // Sigma points at sqrt(3) standard deviations.
    const double step = std::sqrt(3.0 * pose.variance[j]);
    if (!(step > 0.0)) continue;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      Located moved = joints;
      (*moved[j])[axis] += step;
      const IsbAngles after = posture::isb_angles(moved);
      (*moved[j])[axis] -= 2.0 * step;
      const IsbAngles before = posture::isb_angles(moved);
      for (std::size_t row = 0; row < kIsbJoints; ++row) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double change = std::remainder(after[row][k] - before[row][k], kWhole);
          sums[row][k] += change * change / 12.0;  // (change / (2 sqrt 3))^2
        }
      }
    }
  }
  for (auto& row : sums)
    for (double& each : row) each = std::sqrt(each);
  return sums;
}

/// "bend to the right" -> "bendToTheRight"; what stands behind a comma says the sign and is kept.
std::string column_name(std::string_view rotation) {
  std::string name;
  bool raise = false;
  for (const char c : rotation) {
    if (c == ' ' || c == ',') {
      raise = true;
      continue;
    }
    name += raise ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    raise = false;
  }
  return name;
}

void append_field(std::string& text, double radians) {
  text += ',';
  if (std::isfinite(radians)) append_fixed(text, to_deg(radians), kDegreeDigits);
}

/// Axes of the pelvis as in isb.h, X forward, Y up, Z right; none without both hips.
std::optional<Eigen::Matrix3d> pelvis_axes(const Located& joints) {
  const auto& left = joints[index_of(JointId::HipLeft)];
  const auto& right = joints[index_of(JointId::HipRight)];
  if (!left || !right || !((*right - *left).norm() > 1e-3)) return std::nullopt;
  const Eigen::Vector3d z = (*right - *left).normalized();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitY() - z.y() * z;
  if (!(up.norm() > 0.1)) return std::nullopt;
  const Eigen::Vector3d y = up.normalized();
  Eigen::Matrix3d axes;
  axes << y.cross(z), y, z;
  return axes;
}

struct Coordinate {
  std::string_view name;
  std::size_t row;  ///< In isb_rows().
  std::size_t rotation;
  double sign;
};

// clang-format off
constexpr Coordinate kCoordinates[]{
  {"lumbar_extension", 0, 0, 1.0}, {"lumbar_bending", 0, 1, 1.0}, {"lumbar_rotation", 0, 2, 1.0},
  {"hip_flexion_l", 5, 0, 1.0}, {"hip_adduction_l", 5, 1, 1.0},
  {"hip_flexion_r", 6, 0, 1.0}, {"hip_adduction_r", 6, 1, 1.0},
  {"knee_angle_l", 7, 0, -1.0}, {"knee_angle_r", 8, 0, -1.0},
  {"elbow_flex_l", 3, 0, 1.0}, {"elbow_flex_r", 4, 0, 1.0},
};
// clang-format on
constexpr std::string_view kPelvis[]{"pelvis_tilt", "pelvis_list", "pelvis_rotation",
                                     "pelvis_tx",   "pelvis_ty",   "pelvis_tz"};
constexpr std::size_t kPelvisColumns = std::size(kPelvis);
constexpr std::size_t kColumns = kPelvisColumns + std::size(kCoordinates);
using Columns = std::array<std::vector<double>, kColumns>;

/// What one pose says of each column: radians, and metres of the pelvis' place.
std::array<double, kColumns> values_of(const Pose& pose) {
  std::array<double, kColumns> out{};
  out.fill(kUnknown);
  const Located joints = points_of(pose.skeleton);
  if (const auto axes = pelvis_axes(joints)) {
    const Eigen::Matrix3d& r = *axes;  // Rz(tilt) Rx(list) Ry(rotation)
    out[0] = std::atan2(-r(0, 1), r(1, 1));
    out[1] = std::asin(std::clamp(r(2, 1), -1.0, 1.0));
    out[2] = std::atan2(-r(2, 0), r(2, 2));
  }
  if (const auto& base = joints[index_of(JointId::SpineBase)]) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      out[3 + axis] = (*base)[static_cast<Eigen::Index>(axis)];
  }
  const IsbAngles angles = posture::isb_angles(joints);
  for (std::size_t c = 0; c < std::size(kCoordinates); ++c) {
    const Coordinate& each = kCoordinates[c];
    out[kPelvisColumns + c] = each.sign * angles[each.row][each.rotation];
  }
  return out;
}

/// Fills what is not finite from its neighbours; false if nothing is.
bool fill(std::vector<double>& column) {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (!std::isfinite(column[i])) continue;
    const std::size_t from = last ? *last + 1 : 0;
    for (std::size_t k = from; k < i; ++k) {
      const double part =
          last ? static_cast<double>(k - *last) / static_cast<double>(i - *last) : 1.0;
      column[k] = last ? column[*last] + part * (column[i] - column[*last]) : column[i];
    }
    last = i;
  }
  if (!last) return false;
  std::fill(column.begin() + static_cast<std::ptrdiff_t>(*last), column.end(), column[*last]);
  return true;
}

bool is_metres(std::size_t column) { return column >= 3 && column < kPelvisColumns; }

std::string_view name_of_column(std::size_t column) {
  return column < kPelvisColumns ? kPelvis[column] : kCoordinates[column - kPelvisColumns].name;
}

std::string mot_text(const Columns& columns, std::span<const std::size_t> kept, double rate_hz) {
  const std::size_t rows = columns.front().size();
  std::string text = "Coordinates\nversion=1\nnRows=" + std::to_string(rows) +
                     "\nnColumns=" + std::to_string(kept.size() + 1) +
                     "\ninDegrees=yes\nendheader\ntime";
  for (const std::size_t c : kept) text.append("\t").append(name_of_column(c));
  text += '\n';
  for (std::size_t i = 0; i < rows; ++i) {
    append_fixed(text, static_cast<double>(i) / rate_hz, kTimeDigits);
    for (const std::size_t c : kept) {
      text += '\t';
      if (is_metres(c))
        append_fixed(text, columns[c][i], kPlaceDigits);
      else
        append_fixed(text, to_deg(columns[c][i]), kDegreeDigits);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string angles_csv_of(const Take& take) {
  std::string text = "frame,time_s,utc,person";
  for (const auto& row : posture::isb_rows()) {
    for (const std::string_view rotation : row.rotations) {
      const std::string name = std::string(row.name) + "." + column_name(rotation);
      text.append(",").append(name).append("_deg,").append(name).append("_sd_deg");
    }
  }
  text += '\n';
  for (const PersonTrack& track : take.persons) {
    IsbAngles before{};
    for (auto& row : before) row.fill(kUnknown);
    for (std::size_t i = 0; i < track.poses.size(); ++i) {
      const Located joints = points_of(track.poses[i].skeleton);
      const IsbAngles angles = posture::isb_angles(joints);
      const IsbAngles sd = deviations(track.poses[i], joints);
      text += std::to_string(i) + ",";
      append_fixed(text, static_cast<double>(i) / take.rate_hz, kTimeDigits);
      text += "," + to_iso8601(instant_of(take, i)) + "," + std::to_string(track.person.value);
      for (std::size_t row = 0; row < kIsbJoints; ++row) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double angle = continued(angles[row][k], before[row][k]);
          append_field(text, angle);
          append_field(text, std::isfinite(angle) ? sd[row][k] : kUnknown);
          if (std::isfinite(angle)) before[row][k] = angle;
        }
      }
      text += '\n';
    }
  }
  return text;
}

Result<std::string> mot_of(const PersonTrack& track, double rate_hz) {
  Columns columns;
  std::array<double, kColumns> before{};
  before.fill(kUnknown);
  for (const Pose& pose : track.poses) {
    const auto now = values_of(pose);
    for (std::size_t c = 0; c < kColumns; ++c) {
      columns[c].push_back(is_metres(c) ? now[c] : continued(now[c], before[c]));
      if (std::isfinite(columns[c].back())) before[c] = columns[c].back();
    }
  }
  std::vector<std::size_t> kept;
  for (std::size_t c = 0; c < kColumns; ++c) {
    if (fill(columns[c])) kept.push_back(c);
  }
  const bool any_angle =
      std::ranges::any_of(kept, [](std::size_t c) { return c >= kPelvisColumns; });
  if (!any_angle)
    return fail(ErrorCode::Unsupported, "fused frames",
                "show no joint angle: hips, shoulders and knees are needed");
  return mot_text(columns, kept, rate_hz);
}

}  // namespace chorus::exporters
