// What `chorus align` says: as text for people, and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/alignment/trajectory_alignment.h"
#include "services/ctl/align/person_place.h"
#include "services/ctl/align/sensor_comparison.h"

namespace chorus::ctl {

struct AlignmentFindings {
  std::string body;   ///< Of the reference.
  std::string joint;  ///< Ours.
  bool utc = false;   ///< The reference's stamps are UTC.
  std::optional<alignment::Alignment> walk = {};
  Eigen::Isometry3d ours_from_reference = Eigen::Isometry3d::Identity();
  std::vector<SensorDeviation> sensors = {};      ///< In that alignment.
  std::vector<SensorDeviation> from_master = {};  ///< With the master put on its body.
};

/// The origin and front of the reference in our world, as `chorus origin` takes them.
[[nodiscard]] alignment::FloorPose origin_of(const Eigen::Isometry3d& ours_from_reference);

[[nodiscard]] std::string alignment_text(const AlignmentFindings& found);
[[nodiscard]] nlohmann::json alignment_json(const AlignmentFindings& found);

}  // namespace chorus::ctl
