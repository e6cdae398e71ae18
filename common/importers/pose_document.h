// What one JSON file says about people in one or several pictures.
//
//   OpenPose   {"people": [{"person_id": [-1], "pose_keypoints_2d": [u, v, confidence, ...]}]}
//   MMPose     [{"keypoints": [[u, v], ...], "keypoint_scores": [...]}] for a picture;
//              [{"frame_id": 0, "instances": [...]}] or {"instance_info": [...]} for a video
//   COCO       [{"image_id": 7, "keypoints": [u, v, confidence, ...], "score": ...}] for a video;
//              {"images": [...], "annotations": [...]}; AlphaPose's image_id is a name: "7.jpg"
//   AlphaPose  {"7.jpg": {"people": [...]}} or {"7.jpg": {"bodies": [{"joints": [...]}]}}
//
// The layout follows from the number of landmarks of a person: BODY_25, COCO 17 and 18, HALPE 26,
// and the bodies of COCO wholebody (133) and HALPE (136).
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/importers/import_options.h"
#include "common/importers/pose_people.h"
#include "common/layout/layout.h"

namespace chorus::importers {

/// The layout of a person with this number of landmarks; none if no layout has it.
[[nodiscard]] const layout::Layout* layout_of(const PosePerson& person);

using People = std::vector<PosePerson>;

/// People, by the number of the picture.
struct Pictures {
  double rate_hz = 30.0;
  std::map<std::uint64_t, People> people = {};
  std::size_t without_landmarks = 0;  ///< People like `{}`, who were left out.
  std::size_t unreadable = 0;         ///< People who could not be read and were left out.
  std::string first_unreadable = {};
  bool by_order = false;      ///< Of PictureNumbers.
  std::size_t at_origin = 0;  ///< Landmarks at pixel 0, 0 that claim to be seen.

  /// Malformed: `number` is too large for the number of a picture.  Conflict: another picture has
  /// that number.
  [[nodiscard]] Result<void> add(std::uint64_t number, People&& found, const std::string& at);
};

/// `number` is that of the picture, for a file that describes a single one.  A person who cannot be
/// read is left out; Malformed when nobody can, and nothing else says what the file is.
[[nodiscard]] Result<void> read_pose_document(const std::filesystem::path& file,
                                              std::uint64_t number, const ImportLimits& limits,
                                              Pictures& out);

}  // namespace chorus::importers
