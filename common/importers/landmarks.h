// Pose landmarks (MediaPipe Pose, 33 of them) and how they become our 25 joints.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/duration.h"
#include "common/body/skeleton.h"
#include "common/importers/import_options.h"

namespace chorus::importers {

inline constexpr std::size_t kLandmarkCount = 33;  ///< 0 nose, 11/12 shoulders, ...; odd = left.

/// Below this MediaPipe visibility a landmark is a guess: Inferred.
inline constexpr double kTrackedVisibility = 0.6;

/// What the detector saw in one image.
struct LandmarkSight {
  std::array<Eigen::Vector2d, kLandmarkCount> pixel;
  std::array<Eigen::Vector3d, kLandmarkCount> in_body;  ///< Hip-centred, OpenCV axes [m].
  std::array<double, kLandmarkCount> visibility{};
};

struct LandmarkFrame {
  Duration at{0};                      ///< Since the recording's start.
  std::optional<LandmarkSight> sight;  ///< None: nobody found.
};

struct LandmarkView {
  std::string camera;
  std::vector<LandmarkFrame> frames;
};

/// {"camera", "fps", "frames": [{"t_s", "image": 33 x [u, v, visibility], "world": 33 x [x, y,
/// z]}]}.
[[nodiscard]] Result<LandmarkView> read_landmark_view(const std::filesystem::path& file,
                                                      const ImportLimits& limits = {});

/// A landmark in any metric space.
struct Landmark {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  JointState state = JointState::NotTracked;
};
using Landmarks = std::array<Landmark, kLandmarkCount>;

/// Each joint is a fixed weighted mean of landmarks (the table is in the .cpp) and as sure as the
/// least sure of them.  Landmarks carry no orientation, so the joints carry none.
[[nodiscard]] std::array<Joint, kJointCount> joints_of(const Landmarks& landmarks);

}  // namespace chorus::importers
