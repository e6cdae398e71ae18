// Standard deviations per joint at 2.5 m, facing, tracked: coloured (one figure), white (x, y, z),
// and what is left at rest.
//
// Millimetres, sensor space.  White: real Kinect v2 logs, third-difference, walking (statistics
// only).  Coloured: bone-length variation of the same logs; the neck by Otto's Table 1.  At rest:
// Otto's Fig. 7.  Order of JointId; profiles.json scales both tables as a whole.
#pragma once

#include <array>

#include "common/body/skeleton.h"

namespace chorus::synthetic::kinect {

struct JointNoise {
  double coloured;  ///< Per axis [mm]
  double white_x;   ///< [mm]
  double white_y;
  double white_z;
  double rest_front;  ///< Per axis, standing still [mm]
  double rest_side;
  double rest_rear;
};

// clang-format off
inline constexpr std::array<JointNoise, kJointCount> kJointNoise{{
    {14, 3.5, 2.7, 5.2, 0.15, 1.7, 0.5},  // SpineBase
    {14, 1.8, 1.6, 4.1, 0.15, 1.7, 0.5},  // SpineMid
    {4.8, 1.2, 1.3, 3.4, 0.075, 0.15, 0.20},  // Neck
    { 9, 1.5, 1.5, 3.0, 0.022, 0.022, 0.022},  // Head
    { 7, 2.5, 2.2, 4.5, 0.4, 1.0, 0.8},  // ShoulderLeft
    {20, 3.0, 3.0, 5.0, 0.8, 1.6, 1.6},  // ElbowLeft
    {26, 5.0, 4.0, 6.0, 0.8, 1.6, 1.6},  // WristLeft
    {30, 7.0, 7.0, 9.0, 2.0, 3.0, 3.0},  // HandLeft
    { 7, 2.5, 2.2, 4.5, 0.4, 1.0, 0.8},  // ShoulderRight
    {20, 3.0, 3.0, 5.0, 0.8, 1.6, 1.6},  // ElbowRight
    {26, 5.0, 4.0, 6.0, 0.8, 1.6, 1.6},  // WristRight
    {30, 7.0, 7.0, 9.0, 2.0, 3.0, 3.0},  // HandRight
    {16, 4.5, 3.6, 7.5, 0.4, 1.0, 0.8},  // HipLeft
    {22, 3.0, 6.0, 4.0, 0.8, 1.6, 1.6},  // KneeLeft
    {20, 4.0, 11.0, 7.0, 0.8, 1.6, 1.6},  // AnkleLeft
    {30, 8.5, 21.0, 17.0, 2.0, 3.0, 3.0},  // FootLeft
    {16, 4.5, 3.6, 7.5, 0.4, 1.0, 0.8},  // HipRight
    {22, 3.0, 6.0, 4.0, 0.8, 1.6, 1.6},  // KneeRight
    {20, 4.0, 11.0, 7.0, 0.8, 1.6, 1.6},  // AnkleRight
    {30, 8.5, 21.0, 17.0, 2.0, 3.0, 3.0},  // FootRight
    { 6, 1.3, 1.2, 3.4, 0.075, 0.15, 0.20},  // SpineShoulder
    {34, 11.0, 14.0, 13.0, 2.0, 3.0, 3.0},  // HandTipLeft
    {34, 11.0, 14.0, 13.0, 2.0, 3.0, 3.0},  // ThumbLeft
    {34, 11.0, 14.0, 13.0, 2.0, 3.0, 3.0},  // HandTipRight
    {34, 11.0, 14.0, 13.0, 2.0, 3.0, 3.0},  // ThumbRight
}};
// clang-format on

}  // namespace chorus::synthetic::kinect
