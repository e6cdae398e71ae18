// The parameters of profile C: what a time-of-flight camera does to a depth image, and how people
// differ from the generic body that is fitted to it.
//
// In metres and seconds.  There are no errors of joints in here: they result from the fit.
#pragma once

#include <cstdint>
#include <string>

#include "common/synthetic/kinect/error_source.h"

namespace chorus::synthetic::depth {

struct TimeOfFlight {
  double noise_near = 0;    ///< sigma(z) = near + square z^2 [m]
  double noise_square = 0;  ///< [1/m]
  /// Share of the pixels at an edge whose depth lies between those of the two sides.
  double flying_share = 0;
  double hole_share = 0;  ///< Share of pixels that give no depth, except on dark cloth or hair.
  double dark_hole_share = 0;  ///< Share of pixels on dark cloth or hair that give no depth.
  double least_range = 0, most_range = 0;  ///< [m]
};

struct BuildSpread {
  double girth = 0;  ///< Radii of a person's segments differ from the average by up to this share.
  double clothing = 0;  ///< Clothing adds up to this much to a radius [m]
  /// Probability that a person's hair is dark; likewise for trunk and legs.
  double dark_chance = 0;
};

struct DepthProfile {
  TimeOfFlight camera;
  BuildSpread build;
  /// As in profile A, but without its gaps, because here the tracker loses people by itself.
  kinect::Delivery delivery;
  kinect::ClockError clock;  ///< As in profile A.
};

[[nodiscard]] DepthProfile nominal_depth_profile();

/// Every parameter drawn uniformly from its interval; the same seed gives the same draw.
[[nodiscard]] DepthProfile draw_depth_profile(std::uint64_t seed);

/// Returns the profile with one source of error multiplied.  White: noise of depth.  Gross: flying
/// pixels and holes.  Bias: girth and clothing.  Delivery and clock: as in kinect/.  The other
/// sources have no parameter here.
[[nodiscard]] DepthProfile with_source(DepthProfile profile, kinect::Source source, double factor);

/// First 12 hex digits of the SHA-256 of the code of this folder, without comments and white space
/// (../code_hash.cmake): all of that code affects the errors.
[[nodiscard]] std::string frozen_depth_hash();

}  // namespace chorus::synthetic::depth
