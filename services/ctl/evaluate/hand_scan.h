// From a picture file to a hand's skeleton.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/hand/hand_json.h"
#include "common/hand/scan.h"
#include "services/sensor/device/camera/hand_finder.h"

namespace chorus::ctl {

/// What tells the size of the hand.
enum class ScaleBy { File, Dpi, A4, Card };

struct HandScan {
  ScaleBy scale = ScaleBy::File;
  double dpi = 0.0;  ///< For ScaleBy::Dpi.
  hand::ScanOptions options;
};

struct ScannedHand {
  hand::HandShape shape;
  hand::Skeleton skeleton;
  hand::ScanRecord record;
  std::shared_ptr<const cv::Mat> drawn;  ///< The picture with what was found.
};

/// `finder`: null without a network.
[[nodiscard]] Result<ScannedHand> scan_hand(const std::string& file, const HandScan& how,
                                            camera::HandFinder* finder);

}  // namespace chorus::ctl
