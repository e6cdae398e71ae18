// Internal to common/resource: code that the frame writers share.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/resource/frame_resource.h"

namespace chorus::resource {

/// Decimals on the wire (proto/README.md).  Of positions [m]: 0.1 mm; of variances [m^2]: (0.1
/// mm)^2.
inline constexpr int kPositionDecimals = 4;
inline constexpr int kQuaternionDecimals = 5;
inline constexpr int kVarianceDecimals = 8;
inline constexpr int kConfidenceDecimals = 4;
inline constexpr int kRayDecimals = 6;
inline constexpr int kTimeDecimals = 3;
/// Largest `carriedFor` that is written or accepted [s].
inline constexpr double kLongestCarry = 3600.0;

/// The terms of a covariance on the wire, in the order of Covariance::term().
inline constexpr std::array<std::string_view, Covariance::kTerms> kCovarianceNames{
    "cxx", "cxy", "cxz", "cyy", "cyz", "czz"};

/// A joint ready for writing: finite and plausible, or else not tracked.
struct WritableJoint {
  JointState state = JointState::NotTracked;
  bool has_orientation = false;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  std::optional<double> variance;
  bool ray = false;  ///< True if `position` is a direction.
  Covariance covariance;
};
[[nodiscard]] WritableJoint writable(const JointResource& joint);

/// Clamps to [0, 1]; NaN counts as no confidence.
[[nodiscard]] double writable_confidence(double value);

/// Clamps to [0, kLongestCarry]; NaN becomes 0.
[[nodiscard]] double writable_time(double value);

/// `text` in quotes, with the escapes that Turtle and JSON share; broken UTF-8 is replaced.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// The names of all sensors, in quotes.
[[nodiscard]] std::vector<std::string> quoted_names(const FrameResource& frame);

[[nodiscard]] std::string_view name_of(JointState state);
[[nodiscard]] std::string_view name_of(SpaceKind space);

/// Upper bounds of the bytes of one body, and of one joint without its names.
inline constexpr std::size_t kBodyBytes = 16384;
inline constexpr std::size_t kJointBytes = 1024;

[[nodiscard]] std::string write_turtle(const FrameResource& frame, const Place& place);
[[nodiscard]] std::string write_json(const FrameResource& frame, bool linked, const Place& place);
[[nodiscard]] std::string write_turtle_skeleton(const FrameResource& frame,
                                                const BodyResource& body, const Place& place);
[[nodiscard]] std::string write_json_skeleton(const FrameResource& frame, const BodyResource& body,
                                              bool linked, const Place& place);
[[nodiscard]] std::string to_ntriples(const std::string& turtle, const Place& place);

}  // namespace chorus::resource
