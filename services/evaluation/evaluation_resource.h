// `/evaluation`: how far what the sensors on each limb say differs from what the tracker says;
// `/evaluation/segments`: the tracking errors since the start.
#pragma once

#include <string>
#include <vector>

#include "common/resource/node.h"
#include "services/evaluation/live_judge.h"

namespace chorus::evaluation_service {

struct EvaluationResource {
  std::uint64_t sequence = 0;
  Timestamp captured;   ///< The instant of the tracker that was judged last, by our clock.
  std::string tracker;  ///< The url of the one that is judged.
  std::vector<LimbJudgement> limbs;
};

/// Angles in degrees with one decimal; specified in proto/README.md.
[[nodiscard]] resource::Node evaluation_node(const EvaluationResource& evaluation);

[[nodiscard]] resource::Node segments_node(const std::vector<LimbSegment>& segments);

}  // namespace chorus::evaluation_service
