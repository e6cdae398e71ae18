// The lengths and axes of a file, and the check of both by the people in it.
#pragma once

#include <map>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "common/importers/import_options.h"
#include "common/record/frame_recording.h"

namespace chorus::importers {

/// How a file's coordinates became ours; doubts name units and axes of the file.
struct FileSpace {
  double metres_per_unit = 1.0;
  Eigen::Matrix3d ours_from_file = Eigen::Matrix3d::Identity();
};
using FileSpaces = std::map<SensorId, FileSpace>;

/// Multiplies the places of points and turns everything; rays are only turned.
void convert(record::FrameRecording& recording, double factor, const Eigen::Matrix3d& turn);

/// Makes points that are exactly at 0, 0, 0 not tracked, because many programs write that for what
/// they lost (is_nowhere); says how many in the note "unseen".
void drop_nowhere(record::FrameRecording& recording);

/// The median height of the people [m]; none if no frame shows two neighbouring joints as points.
[[nodiscard]] std::optional<double> median_stature(const record::FrameRecording& recording);

/// Refuses people that nobody and no puppet could be (below 0.3 or above 8 m), and names the unit
/// that would fit.
[[nodiscard]] Result<void> check_stature(const record::FrameRecording& recording,
                                         const FileSpace& space);

/// A sentence about people who are unusually small or tall; empty if they are not.
[[nodiscard]] std::string stature_doubt(const record::FrameRecording& recording,
                                        const FileSpace& space);

}  // namespace chorus::importers
