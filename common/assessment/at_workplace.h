// What a person of a recording reached and saw of a scene, and where the things were that they
// held.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "common/ergonomics/live.h"
#include "common/workplace/held_prop.h"
#include "common/workplace/scene.h"

namespace chorus::assessment {

struct PointReached {
  std::string name;
  bool left = false;
  double nearest = 0.0;      ///< Least distance of the wrist [m]; infinite: the arm is never seen.
  double arm = 0.0;          ///< Share of the instants at which the arm alone probably gets there.
  double leaning = 0.0;      ///< The same, leaning from the hips.
  std::string blocked_by{};  ///< An obstacle that stood between for most of the time; empty: none.
};

struct TargetSeen {
  std::string name;
  double in_view = 0.0;  ///< Mean probability of being in the cone.
  double hidden = 0.0;   ///< Share of the instants at which an obstacle is in between.
};

struct PropPath {
  struct At {
    double seconds = 0.0;  ///< Since the recording's beginning.
    workplace::PropPose pose;
  };
  std::string name;
  std::vector<At> places;  ///< While it was held.
};

struct AtWorkplace {
  std::vector<PointReached> reached;
  std::vector<TargetSeen> seen;
  std::vector<PropPath> props;
  double gaze_assumed = 0.0;  ///< Share of the instants without an orientation of the head.
};

struct WorkplaceInput {
  std::uint64_t id = 0;  ///< Of the person, for marks that name one.
  const std::vector<ergonomics::BodyAt>& bodies;
  Timestamp start;
};

/// Instants at which no sensor saw the person do not count.
[[nodiscard]] AtWorkplace at_workplace(const WorkplaceInput& person, const workplace::Scene& scene);

/// {"reach": [...], "view": [...], "props": [...], "gazeAssumed"}; of a prop, where it was taken up
/// and put down.
[[nodiscard]] nlohmann::json workplace_json(const AtWorkplace& found);

}  // namespace chorus::assessment
