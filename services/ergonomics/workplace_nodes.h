// A person's size, and what they reach and see of a scene, as documents of linked data.
#pragma once

#include <optional>

#include "common/resource/frame_resource.h"
#include "common/resource/node.h"
#include "common/workplace/scene.h"

namespace chorus::ergonomics_service {

/// Stature and the lengths of the segments that fusion has learned, each with its standard
/// deviation, and the weight if it was told: what a digital human is scaled by.
[[nodiscard]] resource::Node size_node(const resource::BodyResource& body,
                                       std::optional<double> weight_kg);

/// Each point for each hand, and each point and box in the view.
[[nodiscard]] resource::Node workplace_node(const resource::BodyResource& body,
                                            const workplace::Scene& scene);

}  // namespace chorus::ergonomics_service
