// Skeletons as lines between joints, in messages that viewers of recordings can draw without
// plug-ins.
//
// The messages are JSON of the published Foxglove schemas foxglove.SceneUpdate and
// foxglove.FrameTransforms.  These viewers have +z up, so their root frame `map` is our world (+y
// up) turned by one transform.
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

/// The frame of the fused bodies; each sensor's bodies are in the frame named by the sensor's id.
inline constexpr std::string_view kWorldFrame = "world";

/// Where a frame stands in the world [m].
struct NamedPlace {
  std::string name;  ///< "s1"
  Eigen::Isometry3d world_from_named = Eigen::Isometry3d::Identity();

  bool operator==(const NamedPlace& other) const {
    return name == other.name && world_from_named.matrix() == other.world_from_named.matrix();
  }
};

/// One entity per body, with a life time, so that it disappears when the body is no longer seen.  A
/// bone is left out unless both of its joints have a usable position.
[[nodiscard]] std::string scene_update(const resource::FrameResource& frame,
                                       std::string_view frame_id);

/// The transforms map -> world -> each place.
[[nodiscard]] std::string frame_transforms(Timestamp at, const std::vector<NamedPlace>& places);

}  // namespace chorus::record
