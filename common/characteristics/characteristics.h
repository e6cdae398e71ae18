// Everything that one recording of one sensor says about its errors (after Otto et al. 2016,
// Section 3, who turned a mannequin on a robot arm in front of a Kinect v2).
#pragma once

#include <optional>
#include <string>

#include "common/characteristics/coverage.h"
#include "common/characteristics/jitter.h"
#include "common/characteristics/mark_distance.h"
#include "common/characteristics/turning.h"

namespace chorus::characteristics {

struct Characteristics {
  SensorId sensor;
  double seconds = 0.0;    ///< From the first frame to the last [s].
  std::size_t sights = 0;  ///< Frames with the person.
  double standing = 0.0;   ///< Share of them in which the person stands.
  bool has_floor = false;
  Jitter jitter;
  Exchange exchange;
  Coverage coverage;
  std::optional<MarkedDepthBias> depth_bias;  ///< Measured with the mark, if there is one.
  std::string no_depth_bias;                  ///< Why there is none, and how to measure it.
};

/// What is known besides the recording.
struct Known {
  std::optional<Mark> mark = {};
  std::vector<KnownTurn> turns = {};
};

/// Refuses as one_person() does.
[[nodiscard]] Result<Characteristics> characterise(const std::vector<SensorFrame>& frames,
                                                   const Known& known = {});

/// The noise of a tracked joint, in the terms of fusion.noise.
struct Noise {
  double along = 0.0, across = 0.0;  ///< [m]
  double inferred_factor = 1.0;
  std::size_t inferred_frames = 0;  ///< From which the factor is; below 300 it says little.
};

/// Jitter of the neck and the upper end of the spine, because fusion.noise is that of joints
/// without a pose error, and how much more inferred limbs tremble than tracked ones.
[[nodiscard]] Noise noise_of(const Jitter& jitter);
/// The same, but of elbows, wrists, knees and ankles.
[[nodiscard]] Noise limb_noise_of(const Jitter& jitter);

}  // namespace chorus::characteristics
