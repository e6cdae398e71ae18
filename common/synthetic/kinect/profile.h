// The parameters of the body-tracking sensor model, read from profiles.json; a hash freezes them.
//
// In metres, radians and seconds.  A profile has either the nominal values, or values each drawn
// from its interval.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/base/units.h"

namespace chorus::synthetic::kinect {

struct ViewLimits {
  double half_width = 0, half_height = 0, margin = 0;  ///< [rad]
  double least_range = 0, most_range = 0;              ///< [m]
};

struct Delivery {
  double period = 0, jitter = 0;  ///< [s]
  double drop_share = 0;
  double gaps_per_minute = 0, gap_least = 0, gap_most = 0;  ///< [s]
  double gap_block = 10;                   ///< At most one gap starts in each block [s]
  double slow_share = 0, slow_time = 0;    ///< Share of time at half the rate; shortest episode [s]
  double latency = 0, latency_jitter = 0;  ///< [s]
};

struct Visibility {
  double rays = 0, girth = 0;
  double fan = 0;   ///< Offset of the outer rays about a joint [m]
  double skin = 0;  ///< A hit this close before the joint is its own surface [m]
  double inferred_visible = 0, inferred_occluded = 0;  ///< Probabilities.
  double state_hold = 0;                               ///< [s]
  double notice = 0;  ///< Time until the SDK notices that a joint is hidden, or seen again [s]
  double hidden_scale = 0;  ///< Factor on the table's error of hidden joints.
  double hidden_depth = 0;  ///< Ratio of that error along the ray to across it.
  double hidden_tau = 0;    ///< [s]
};

struct YawBehaviour {
  double reliable = 0;  ///< [rad]
  double shoulder_slope = 0, hip_slope = 0;
  double flip_to_rear = 0, flip_to_front = 0;  ///< Out and back; half a turn or more: never [rad]
  double flip_own = 0, flip_back_own = 0;      ///< One sensor's deviation: of both, of back [rad]
  double flip_time = 0;                        ///< [s]
};

struct JointBias {
  double core = 0, head_forward = 0, hip_radial = 0, vertical = 0;  ///< [m]
  double limb_factor = 0, common_share = 0;
  double neck_factor = 0;                ///< Factor for the neck on `core` and `vertical`.
  double follow_share = 0;               ///< Share that a joint takes from its leader().
  double harmonic = 0;                   ///< Root mean square of one coefficient.
  double head_from = 0, head_width = 0;  ///< Facing angle from which it grows, and over which [rad]
  double hip_from = 0, hip_width = 0;    ///< [rad]
};

struct ColouredError {
  double core_tau = 0, limb_tau = 0, foot_tau = 0;  ///< While moving [s]
  double moving_speed = 0;  ///< Joint speed from which the error changes at its full rate [m/s]
  double rest_share = 0;    ///< Share of that rate at rest.
  double shared_cell = 0;   ///< [m]
  double scale = 0, depth_factor = 0, turn_growth = 0, distance_growth = 0;
  double inferred_factor = 0, inferred_least = 0, inferred_pull = 0;
  double core_correlation = 0, sensor_correlation = 0, neck_correlation = 0;
  double follow_share = 0;  ///< Share of the variance that comes from the joint's leader.
  double view_twice = 0;    ///< Share of the shared part that depends on twice the view angle.
  double best_distance = 0, good_depth = 0;  ///< [m]
  double student_nu = 0;                     ///< 0: Gaussian.
  double tail_time = 0, most_tail = 0;  ///< How long a bad period lasts [s]; limit of its factor.
};

/// The errors of a sensor's SDK that fits a body of fixed proportions.
struct BodyFit {
  double bones = 0;        ///< 1: all bones have one common scale; 0: joints err independently.
  double scale = 0;        ///< Standard deviation of the scale.
  double scale_tau = 0;    ///< While moving [s]
  double scale_white = 0;  ///< Standard deviation from frame to frame.
  double proportion = 0;   ///< Standard deviation of each bone's constant ratio.
};

struct GrossError {
  double teleports = 0;      ///< Per joint and second.
  double teleport_size = 0;  ///< [m]
  double teleport_time = 0;  ///< [s]
  double ghosts_per_minute = 0, ghost_time = 0;
  double ghost_aside = 0, ghost_near = 0, ghost_far = 0, ghost_below = 0;  ///< Its place [m]
  double ghost_limb = 0, ghost_joint = 0;                                  ///< Its size [m]
  double id_swap = 0;      ///< Probability per contact.
  double contact = 0;      ///< People nearer than this touch [m]
  double leg_merge = 0;    ///< Share of the distance by which legs are pulled together.
  double merge_angle = 0;  ///< Legs that appear closer than this merge [rad]
};

struct ClockError {
  double offset = 0;       ///< Standard deviation over hosts [s]
  double drift = 0;        ///< Standard deviation [s/s]
  double step = 0;         ///< Size, in either direction [s]
  double step_chance = 0;  ///< Probability that a host's clock steps, once.
  double step_within = 0;  ///< The step happens within this time of the first frame [s]
};

/// Standard deviations of the error of the floor plane: constant for a sensor, and per frame.
struct FloorError {
  double tilt = 0, tilt_now = 0;      ///< [rad]
  double offset = 0, offset_now = 0;  ///< [m]
};

struct Profile {
  std::string name;
  ViewLimits view;
  Delivery delivery;
  Visibility visibility;
  YawBehaviour yaw;
  JointBias bias;
  ColouredError coloured;
  double white_scale = 1.0;
  double white_inferred = 0.0;  ///< Additional white noise of inferred joints [m]
  BodyFit fit;
  GrossError gross;
  ClockError clock;
  FloorError floor;
};

/// The nominal values of "A", "B" or "D".
[[nodiscard]] Profile nominal_profile(std::string_view name);

/// Every parameter drawn uniformly from its interval; the same seed gives the same draw.
[[nodiscard]] Profile draw_profile(std::string_view name, std::uint64_t seed);

/// A parameter by its name in profiles.json, in the units of this header.
struct Parameter {
  std::string_view name;
  double value;
};
[[nodiscard]] std::vector<Parameter> parameters_of(Profile profile);

/// First 12 hex digits of the SHA-256 of profiles.json and the code of this folder, without
/// comments and white space (../code_hash.cmake): printed with every result.
[[nodiscard]] std::string frozen_hash();

}  // namespace chorus::synthetic::kinect
