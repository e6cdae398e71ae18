// Standard deviations of each joint's error, for a tracked joint of a person who faces the sensor
// at 2.5 m: coloured noise, additional error when hidden, white noise, and what remains at rest.
//
// In millimetres and sensor space, in the order of JointId.  Sources: white noise from third
// differences of real Kinect v2 logs of walking (statistics only); coloured noise from the
// variation of bone lengths in the same logs, for the neck from Otto's Table 1; hidden from the
// bones on the side turned away from the sensor, in another log; at rest from Otto's Fig. 7.
// profiles.json scales each table as a whole (coloured.scale, visibility.hidden_scale, white.scale)
// and has the intervals.
#pragma once

#include <array>

#include "common/body/skeleton.h"

namespace chorus::synthetic::kinect {

struct JointNoise {
  double coloured;  ///< Per axis [mm]
  double hidden;    ///< Additional when hidden, across the ray [mm]
  double white_x;   ///< [mm]
  double white_y;
  double white_z;
  double rest_front;  ///< Per axis, standing still [mm]
  double rest_side;
  double rest_rear;
};

// clang-format off
inline constexpr std::array<JointNoise, kJointCount> kJointNoise{{
    {17, 0, 3.5, 2.7, 5.2, 0.15, 1.7, 0.5},  // SpineBase
    {14, 0, 1.8, 1.6, 4.1, 0.15, 1.7, 0.5},  // SpineMid
    {5.1, 0, 1.2, 1.3, 3.4, 0.075, 0.15, 0.20},  // Neck
    {9, 0, 1.5, 1.5, 3.0, 0.022, 0.022, 0.022},  // Head
    {7, 18, 2.5, 2.2, 4.5, 0.4, 1.0, 0.8},  // ShoulderLeft
    {10, 18, 3.0, 3.0, 5.0, 0.8, 1.6, 1.6},  // ElbowLeft
    {9, 18, 5.0, 4.0, 6.0, 0.8, 1.6, 1.6},  // WristLeft
    {22, 20, 7.0, 7.0, 9.0, 2.0, 3.0, 3.0},  // HandLeft
    {7, 18, 2.5, 2.2, 4.5, 0.4, 1.0, 0.8},  // ShoulderRight
    {10, 18, 3.0, 3.0, 5.0, 0.8, 1.6, 1.6},  // ElbowRight
    {9, 18, 5.0, 4.0, 6.0, 0.8, 1.6, 1.6},  // WristRight
    {22, 20, 7.0, 7.0, 9.0, 2.0, 3.0, 3.0},  // HandRight
    {16, 3, 4.5, 3.6, 7.5, 0.4, 1.0, 0.8},  // HipLeft
    {26, 18, 3.0, 6.0, 4.0, 0.8, 1.6, 1.6},  // KneeLeft
    {22, 18, 2.0, 11.0, 5.5, 0.8, 1.6, 1.6},  // AnkleLeft
    {30, 20, 8.5, 21.0, 17.0, 2.0, 3.0, 3.0},  // FootLeft
    {16, 3, 4.5, 3.6, 7.5, 0.4, 1.0, 0.8},  // HipRight
    {26, 18, 3.0, 6.0, 4.0, 0.8, 1.6, 1.6},  // KneeRight
    {22, 18, 2.0, 11.0, 5.5, 0.8, 1.6, 1.6},  // AnkleRight
    {30, 20, 8.5, 21.0, 17.0, 2.0, 3.0, 3.0},  // FootRight
    {6, 0, 1.3, 1.2, 3.4, 0.075, 0.15, 0.20},  // SpineShoulder
    {26, 22, 11.0, 14.0, 13.0, 2.0, 3.0, 3.0},  // HandTipLeft
    {26, 22, 11.0, 14.0, 13.0, 2.0, 3.0, 3.0},  // ThumbLeft
    {26, 22, 11.0, 14.0, 13.0, 2.0, 3.0, 3.0},  // HandTipRight
    {26, 22, 11.0, 14.0, 13.0, 2.0, 3.0, 3.0},  // ThumbRight
}};
// clang-format on

}  // namespace chorus::synthetic::kinect
