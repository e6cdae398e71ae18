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
  /// Half angles of the view; joints up to `margin` outside it are inferred [rad].
  double half_width = 0, half_height = 0, margin = 0;
  double least_range = 0, most_range = 0;  ///< Distances from the sensor [m].
};

struct Delivery {
  /// Time between frames, and the largest deviation of an exposure from that rhythm [s].
  double period = 0, jitter = 0;
  double drop_share = 0;  ///< Share of frames that are lost.
  /// How often the SDK loses a person; limits of how long that lasts [s].
  double gaps_per_minute = 0, gap_least = 0, gap_most = 0;
  double gap_block = 10;  ///< At most one gap starts in each block [s]
  /// Share of time in which the sensor runs at half its rate; shortest duration of that [s].
  double slow_share = 0, slow_time = 0;
  /// Mean, and standard deviation from frame to frame [s].
  double latency = 0, latency_jitter = 0;
};

struct Visibility {
  /// Number of rays to each joint; factor on the radii of bodies.
  double rays = 0, girth = 0;
  double fan = 0;  ///< Offset of the outer rays about a joint [m]
  /// A surface that a ray hits this close before the joint is the joint's own [m].
  double skin = 0;
  /// Probabilities that a visible and that an occluded joint is called inferred.
  double inferred_visible = 0, inferred_occluded = 0;
  double state_hold = 0;  ///< A joint keeps its state for about this time [s].
  /// Time constant with which the SDK notices that a joint is hidden, or seen again [s].
  double notice = 0;
  double hidden_scale = 0;  ///< Factor on the table's error of hidden joints.
  double hidden_depth = 0;  ///< Ratio of that error along the ray to across it.
  double hidden_tau = 0;    ///< Correlation time [s].
};

struct YawBehaviour {
  double reliable = 0;  ///< Largest yaw that is shown right [rad].
  double shoulder_slope = 0, hip_slope = 0;
  /// Facing angle above which left and right are swapped, and below which they are swapped back;
  /// half a turn or more: never [rad].
  double flip_to_rear = 0, flip_to_front = 0;
  /// Largest deviation of one sensor from the two angles together, and a further one from
  /// flip_to_front alone [rad].
  double flip_own = 0, flip_back_own = 0;
  double flip_time = 0;  ///< Duration of the transition [s].
};

struct JointBias {
  double core = 0, head_forward = 0, hip_radial = 0, vertical = 0;  ///< [m]
  double limb_factor = 0, common_share = 0;
  double neck_factor = 0;   ///< Factor for the neck on `core` and `vertical`.
  double follow_share = 0;  ///< Share that a joint takes from its leader().
  double harmonic = 0;      ///< Root mean square of one coefficient of the harmonics.
  /// The bias of the head grows from this angle on, over this range of angles [rad].
  double head_from = 0, head_width = 0;
  /// Likewise that of SpineMid and SpineBase [rad].
  double hip_from = 0, hip_width = 0;
};

struct ColouredError {
  /// Correlation times while moving [s].
  double core_tau = 0, limb_tau = 0, foot_tau = 0;
  /// Speed of a joint above which its error changes at the full rate [m/s].
  double moving_speed = 0;
  double rest_share = 0;  ///< Share of that rate at rest.
  /// Size of the cells on the floor between which the shared error is interpolated [m].
  double shared_cell = 0;
  double scale = 0, depth_factor = 0, turn_growth = 0, distance_growth = 0;
  double inferred_factor = 0, inferred_least = 0, inferred_pull = 0;
  double core_correlation = 0, sensor_correlation = 0, neck_correlation = 0;
  double follow_share = 0;  ///< Share of the variance that comes from the joint's leader.
  /// Share of the shared error that varies with twice the view angle.
  double view_twice = 0;
  /// Distance at which the errors are least, and how far from it they are no larger [m].
  double best_distance = 0, good_depth = 0;
  /// Degrees of freedom of Student's t; 2 or less: Gaussian.
  double student_nu = 0;
  /// How long a period of large errors lasts [s]; the largest factor on the error in it.
  double tail_time = 0, most_tail = 0;
};

/// The errors of a sensor's SDK that fits a body of fixed proportions.
struct BodyFit {
  double bones = 0;        ///< 1: all bones have one common scale; 0: joints err independently.
  double scale = 0;        ///< Standard deviation of the scale.
  double scale_tau = 0;    ///< Correlation time while moving [s].
  double scale_white = 0;  ///< Standard deviation from frame to frame.
  double proportion = 0;   ///< Standard deviation of each bone's constant ratio.
};

struct GrossError {
  double teleports = 0;      ///< Rate per joint [1/s].
  double teleport_size = 0;  ///< Standard deviation per axis [m].
  double teleport_time = 0;  ///< Duration [s].
  double ghosts_per_minute = 0, ghost_time = 0;
  /// Limits of a ghost's place in sensor space [m].
  double ghost_aside = 0, ghost_near = 0, ghost_far = 0, ghost_below = 0;
  /// Size of a ghost [m].
  double ghost_limb = 0, ghost_joint = 0;
  double id_swap = 0;  ///< Probability per contact that two people's ids are swapped.
  double contact = 0;  ///< People who are nearer to each other than this touch [m].
  /// Share of the distance by which the far leg is pulled towards the near one.
  double leg_merge = 0;
  double merge_angle = 0;  ///< Legs that appear closer than this merge [rad]
};

struct ClockError {
  double offset = 0;       ///< Standard deviation over hosts [s]
  double drift = 0;        ///< Standard deviation [s/s]
  double step = 0;         ///< Size, in either direction [s]
  double step_chance = 0;  ///< Probability that a host's clock steps once.
  double step_within = 0;  ///< Limit of the time between the first frame and the step [s].
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
/// comments and white space (../code_hash.cmake); printed with results.
[[nodiscard]] std::string frozen_hash();

}  // namespace chorus::synthetic::kinect
