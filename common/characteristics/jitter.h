// How much joints tremble about a slow trend: by joint, distance and state, along and across the
// line of sight.
//
// The trend is a parabola fitted to the half second around each frame (Savitzky and Golay's
// smoothing): somebody's sway and slow turning follow it to a fraction of a millimetre.  For white
// noise the result is its standard deviation at any rate, because the share that the fit absorbs is
// added back.  Errors that last longer than half a second are part of the trend: no single sensor
// can tell them from motion (agreement.h can).
#pragma once

#include <vector>

#include "common/characteristics/turning.h"

namespace chorus::characteristics {

/// One joint in one state at one range of distances.
struct JitterCell {
  JointId joint = JointId::SpineBase;
  JointState state = JointState::Tracked;
  double distance = 0.0;   ///< From the sensor to the joint, middle of a range of 0.5 m [m].
  std::size_t frames = 0;  ///< Number of frames measured.
  double along = 0.0;      ///< Root mean square along the line of sight [m].
  double across = 0.0;     ///< The same across it, per axis [m].
};

/// Where the person's front points, as in Otto's Fig. 7: within 35 deg of the sensor, between, or
/// beyond 145 deg.
enum class Side { Front, Side, Rear };

/// Mean displacement of one joint from frame to frame, computed from second differences, so that
/// slow turning does not count.
struct StepCell {
  JointId joint = JointId::Neck;
  Side side = Side::Front;
  std::size_t frames = 0;
  double step = 0.0;  ///< [m]
};

struct Jitter {
  std::vector<JitterCell> cells;  ///< By joint, state, distance; each of at least 15 frames.
  std::vector<StepCell> steps;    ///< Of the centre joints (kCoreJoints).
};

/// Uses only frames in which the person stands, if the half second around them has no gap and no
/// change of labels or of the joint's state.
[[nodiscard]] Jitter jitter_of(const OnePerson& person, const std::vector<Stance>& stances);

/// Root mean square over several joints and all distances; zero frames if there is none.
[[nodiscard]] JitterCell jitter_over(const Jitter& jitter, const std::vector<JointId>& joints,
                                     JointState state);

}  // namespace chorus::characteristics
