// From a picture to a hand's skeleton.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/hand/hand_json.h"
#include "common/hand/scan.h"
#include "services/sensor/device/camera/hand_finder.h"

namespace chorus::scan {

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

/// A picture as it came, for its density, and decoded.
struct ScanSource {
  std::string name;  ///< For messages.
  std::string bytes;
  camera::Picture picture;
};

/// `finder`: null without a network.
[[nodiscard]] Result<ScannedHand> scan_picture(const ScanSource& source, const HandScan& how,
                                               camera::HandFinder* finder);
/// The same of a file.
[[nodiscard]] Result<ScannedHand> scan_hand(const std::string& file, const HandScan& how,
                                            camera::HandFinder* finder);

}  // namespace chorus::scan
