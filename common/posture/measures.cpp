#include "common/posture/measures.h"

#include <string>

namespace chorus::posture {
namespace {

constexpr std::string_view kRula =
    "RULA (McAtamney & Corlett 1993), REBA (Hignett & McAtamney 2000)";
constexpr std::string_view kIso = "ISO 11226:2000, EN 1005-4:2005";
constexpr std::string_view kOwas = "OWAS (Karhu et al. 1977)";
constexpr std::string_view kEaws = "EAWS section 1 (Schaub et al. 2013)";

// clang-format off
constexpr std::array<MeasureRow, kCentres> kCentreRows{{
    {"trunkFlexion", Unit::Angle, "hips to shoulders vertical", "leaning forward, in the pelvis's sagittal plane", kRula, Zeroing::Shifted},
    {"trunkSideBend", Unit::Angle, "hips to shoulders in the pelvis's sagittal plane", "leaning to the left", kRula, Zeroing::Shifted},
    {"trunkTwist", Unit::Angle, "shoulders parallel to the hips", "turning the shoulders to the left", kRula, Zeroing::Shifted},
    {"neckFlexion", Unit::Angle, "head in line with the trunk", "nodding forward, in the trunk's sagittal plane", kRula, Zeroing::Shifted},
    {"neckSideBend", Unit::Angle, "head in the trunk's sagittal plane", "leaning the head to the left", kRula, Zeroing::Shifted},
    {"neckTwist", Unit::Angle, "face in the trunk's sagittal plane", "turning the face to the left", kRula, Zeroing::Shifted},
    {"headInclination", Unit::Angle, "head vertical", "forward", kIso, Zeroing::Shifted},
}};
constexpr std::array<MeasureRow, kLimbs> kLimbRows{{
    {"upperArmRaise", Unit::Angle, "arm along the trunk", "away from the trunk; negative: backward", kRula, Zeroing::Shortened},
    {"upperArmElevation", Unit::Angle, "arm hanging", "away from the vertical", kIso, Zeroing::Shortened},
    {"upperArmAbduction", Unit::Angle, "arm in the trunk's sagittal plane", "outward", kRula, Zeroing::Shifted},
    {"shoulderRaise", Unit::Angle, "shoulder square to the trunk", "upward", kRula, Zeroing::Shifted},
    {"elbowFlexion", Unit::Angle, "arm straight", "bending", kRula, Zeroing::Shortened},
    {"forearmAcross", Unit::Distance, "wrist on the trunk's mid-plane", "beyond it, to the other side", kRula, Zeroing::Kept},
    {"forearmOut", Unit::Distance, "wrist as far out as the shoulder", "farther out", kRula, Zeroing::Kept},
    {"wristFlexion", Unit::Angle, "hand in line with the forearm", "bending in any direction", kRula, Zeroing::Shortened},
    {"handAboveHead", Unit::Distance, "hand as high as the head", "higher", kEaws, Zeroing::Kept},
    {"handReach", Unit::Distance, "hand above or below the middle of the hips", "horizontally away", kEaws, Zeroing::Kept},
    {"hipFlexion", Unit::Angle, "thigh in line with the trunk", "bending", "Wu et al. 2002", Zeroing::Shortened},
    {"thighInclination", Unit::Angle, "thigh vertical", "away from the vertical", kOwas, Zeroing::Shortened},
    {"kneeFlexion", Unit::Angle, "leg straight", "bending", kRula, Zeroing::Shortened},
    {"shankInclination", Unit::Angle, "shank vertical", "away from the vertical", kOwas, Zeroing::Shortened},
    {"footLift", Unit::Distance, "ankle as low as the lower one", "higher", kRula, Zeroing::Kept},
    {"kneeHeight", Unit::Distance, "knee as low as the lower ankle", "higher", kOwas, Zeroing::Kept},
}};
// clang-format on

std::string sided(std::string_view side, std::string_view name) {
  std::string text(side);
  text += static_cast<char>(name.front() - 'a' + 'A');
  return text + std::string(name.substr(1));
}

std::array<std::string, kMeasures> texts() {
  std::array<std::string, kMeasures> all;
  for (std::size_t i = 0; i < kCentres; ++i) all[i] = kCentreRows[i].name;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    all[kCentres + i] = sided("left", kLimbRows[i].name);
    all[kCentres + kLimbs + i] = sided("right", kLimbRows[i].name);
  }
  return all;
}

}  // namespace

const std::array<MeasureRow, kCentres>& centre_rows() { return kCentreRows; }
const std::array<MeasureRow, kLimbs>& limb_rows() { return kLimbRows; }

const MeasureRow& row_of(std::size_t index) {
  return index < kCentres ? kCentreRows[index] : kLimbRows[(index - kCentres) % kLimbs];
}

const std::array<std::string_view, kMeasures>& measure_names() {
  static const std::array<std::string, kMeasures> kTexts = texts();
  static const std::array<std::string_view, kMeasures> kNames = [] {
    std::array<std::string_view, kMeasures> views;
    for (std::size_t i = 0; i < kMeasures; ++i) views[i] = kTexts[i];
    return views;
  }();
  return kNames;
}

std::string_view name_of(std::size_t index) { return measure_names()[index]; }

}  // namespace chorus::posture
