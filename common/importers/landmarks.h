// Files with pose landmarks: the 33 of MediaPipe Pose (common/layout/mediapipe.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "common/base/duration.h"
#include "common/importers/import_options.h"
#include "common/layout/layout.h"

namespace chorus::importers {

/// Number of landmarks.  0 is the nose, 11 and 12 are the shoulders; from 7 on, odd numbers are
/// left.
inline constexpr std::size_t kLandmarkCount = 33;

/// A landmark with a lower MediaPipe visibility is a guess: Inferred.
inline constexpr double kTrackedVisibility = 0.6;

/// What the detector found in one picture.
struct DetectedLandmarks {
  std::array<Eigen::Vector2d, kLandmarkCount> pixel;
  std::array<Eigen::Vector3d, kLandmarkCount> in_body;  ///< Hip-centred, OpenCV axes [m].
  std::array<double, kLandmarkCount> visibility{};
};

struct LandmarkFrame {
  Duration at{0};                             ///< Since the recording's start.
  std::optional<DetectedLandmarks> detected;  ///< None: nobody was detected.
};

struct LandmarkView {
  std::string camera;
  std::vector<LandmarkFrame> frames;
};

/// Reads {"camera", "fps", "frames": [{"t_s", "image": 33 x [u, v, visibility], "world": 33 x [x,
/// y, z]}]}.
[[nodiscard]] Result<LandmarkView> read_landmark_view(const std::filesystem::path& file,
                                                      const ImportLimits& limits = {});

/// Landmarks in a metric space, or rays to them, in the order of layout::kMediapipe.
using Landmarks = std::array<layout::Landmark, kLandmarkCount>;

}  // namespace chorus::importers
