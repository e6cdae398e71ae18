// How much joints tremble about a slow trend: by joint, distance and state, along and across the
// line of sight.
//
// The trend is a parabola fitted to the half second around each frame (Savitzky and Golay's
// smoothing): somebody's sway and slow turning follow it to a fraction of a millimetre.  For white
// noise the result is its standard deviation, whatever the rate (the fit's own share is given
// back).  Errors that last longer than half a second are part of the trend: no single sensor can
// tell them from motion (agreement.h can).
#pragma once

#include <vector>

#include "common/characteristics/turning.h"

namespace chorus::characteristics {

/// One joint in one state at one range of distances.
struct JitterCell {
  JointId joint = JointId::SpineBase;
  JointState state = JointState::Tracked;
  double distance = 0.0;   ///< From the sensor to the joint, middle of a range of 0.5 m [m].
  std::size_t frames = 0;  ///< That were measured.
  double along = 0.0;      ///< Root mean square along the line of sight [m].
  double across = 0.0;     ///< The same across it, per axis [m].
};

/// Where the person's front is, as in Otto's Fig. 7.
enum class Side { Front, Side, Rear };

/// Mean displacement of one joint from frame to frame, computed from second differences, so that
/// slow turning does not count.
struct StepCell {
  JointId joint = JointId::Neck;
  Side side = Side::Front;  ///< Up to 35 deg away from the sensor, beyond 145 deg, and between.
  std::size_t frames = 0;
  double step = 0.0;  ///< [m]
};

struct Jitter {
  std::vector<JitterCell> cells;  ///< By joint, state, distance; of 15 frames at least.
  std::vector<StepCell> steps;    ///< Of the centre joints (kCoreJoints).
};

/// Only frames in which the person stands, with all frames of the half second at the usual rate, in
/// the same state, and with the same labels.
[[nodiscard]] Jitter jitter_of(const OnePerson& person, const std::vector<Stance>& stances);

/// Root mean square over several joints and all distances; zero frames if there is none.
[[nodiscard]] JitterCell jitter_over(const Jitter& jitter, const std::vector<JointId>& joints,
                                     JointState state);

}  // namespace chorus::characteristics
