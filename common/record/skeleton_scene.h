// Skeletons as lines between joints, in messages that recording viewers can draw without plug-ins.
//
// JSON of the published Foxglove schemas foxglove.SceneUpdate and foxglove.FrameTransforms. Viewers
// have +z up, so their root frame `map` is our world (+y up), turned by one transform.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "common/resource/frame_resource.h"

namespace chorus::record {

inline constexpr std::string_view kSceneSchemaName = "foxglove.SceneUpdate";
inline constexpr std::string_view kTransformsSchemaName = "foxglove.FrameTransforms";
[[nodiscard]] std::string_view scene_schema();
[[nodiscard]] std::string_view transforms_schema();

/// Frame of the fused bodies; each sensor's bodies are in the frame named by its id.
inline constexpr std::string_view kWorldFrame = "world";

/// Where a frame stands in the world [m].
struct NamedPlace {
  std::string name;  ///< "s1"
  Eigen::Isometry3d world_from_named = Eigen::Isometry3d::Identity();

  bool operator==(const NamedPlace& other) const {
    return name == other.name && world_from_named.matrix() == other.world_from_named.matrix();
  }
};

/// One entity per body; it disappears by itself when the body is no longer seen.  Bones with a
/// joint that is not tracked are left out.
[[nodiscard]] std::string scene_update(const resource::FrameResource& frame,
                                       std::string_view frame_id);

/// The transforms map -> world -> each place.
[[nodiscard]] std::string frame_transforms(Timestamp at, const std::vector<NamedPlace>& places);

}  // namespace chorus::record
