// Recordings with inertial sensors and optical truth of one take, made by others.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/evaluation/orientation_pair.h"
#include "common/evaluation/time_shift.h"
#include "common/inertial/limb.h"

namespace chorus::bench {

struct RealSensor {
  inertial::Limb limb = inertial::Limb::Pelvis;
  evaluation::OrientationTrack optical;                    ///< world_from_limb, +y up
  evaluation::OrientationTrack inertial;                   ///< inertial_from_sensor, +y up
  std::vector<evaluation::Timed<Eigen::Vector3d>> places;  ///< Of the limb's joint [m]
  evaluation::Signal acceleration;  ///< |specific force - gravity| of the sensor [m/s^2]
};

struct RealTake {
  std::string name;
  std::vector<RealSensor> sensors;
};

/// Both takes that are here: "xsens7" (Sy et al. 2020, a walk of 9.5 s, synchronised by a trigger)
/// and "xsens13" (TotalCapture S5 acting3, the first 25 s; $CHORUS_XSENS13 names the folder).
[[nodiscard]] Result<std::vector<RealTake>> real_takes();

/// Optical and inertial orientations of one sensor at the optical times.
[[nodiscard]] evaluation::OrientationPairs pairs_of(const RealSensor& sensor, double shift = 0.0);

/// The orientations of a file of TotalCapture (gt_skel_gbl_ori.txt, 60 Hz), world_from_segment, by
/// frame and segment.
[[nodiscard]] Result<std::vector<std::vector<Eigen::Quaterniond>>> orientation_rows(
    const std::filesystem::path& file);
/// The segment of such a file that is this limb.
[[nodiscard]] std::size_t segment_of(inertial::Limb limb);
/// world_from_limb where a sensor sits, by the segments of one frame of such a file: forearms turn
/// with the hand, which is the next segment.  Vicon's arms have their bones along x.
[[nodiscard]] Eigen::Quaterniond under_sensor(inertial::Limb limb,
                                              const std::vector<Eigen::Quaterniond>& segments);

}  // namespace chorus::bench
