// PictureSight from the outline of a body of capsules (common/silhouette).  Pure.
#pragma once

#include <memory>
#include <vector>

#include "common/positioning/picture_sight.h"
#include "common/silhouette/floor_search.h"

namespace chorus::positioning {

/// Width of the pictures in which outlines are sought [px]; all widths in pixels are for it.
inline constexpr int kSightWidth = 640;
inline constexpr double kSightFieldScale = 0.5;  ///< Of the distance field against it.

/// The lens of pictures of another size, for pictures of kSightWidth.
[[nodiscard]] Intrinsics sight_lens(const Intrinsics& lens);

struct SightSettings {
  silhouette::SearchSettings search{};
  silhouette::OutlineSettings outline{};
  silhouette::FloorSearch floor{};
  /// The field is made of a region of interest around the expected body, and of the whole picture
  /// only while nobody is there.
  bool regions = true;
};

/// What is the same for all pictures of one camera.
struct SightCamera {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  Intrinsics lens;
  std::vector<silhouette::ShapedBone> shape;  ///< Of the person.
};

[[nodiscard]] std::shared_ptr<const PictureSight> outline_sight(const SightCamera& camera,
                                                                silhouette::EvidenceSource source,
                                                                const SightSettings& settings = {});

}  // namespace chorus::positioning
