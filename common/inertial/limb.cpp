#include "common/inertial/limb.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace chorus::inertial {
namespace {

enum class Side : std::uint8_t { None, Left, Right };

struct Meaning {
  std::string_view word;
  Limb left;   ///< Of the trunk: the limb itself.
  Limb right;  ///< The same as `left` for the trunk.
};

// Longer words first: "upperarm" before "arm", "forearm" before "arm".
constexpr std::array kMeanings{
    Meaning{"upperarm", Limb::UpperArmLeft, Limb::UpperArmRight},
    Meaning{"uparm", Limb::UpperArmLeft, Limb::UpperArmRight},
    Meaning{"humerus", Limb::UpperArmLeft, Limb::UpperArmRight},
    Meaning{"lowerarm", Limb::ForearmLeft, Limb::ForearmRight},
    Meaning{"lowarm", Limb::ForearmLeft, Limb::ForearmRight},
    Meaning{"forearm", Limb::ForearmLeft, Limb::ForearmRight},
    Meaning{"radius", Limb::ForearmLeft, Limb::ForearmRight},
    Meaning{"ulna", Limb::ForearmLeft, Limb::ForearmRight},
    Meaning{"hand", Limb::HandLeft, Limb::HandRight},
    Meaning{"upperleg", Limb::ThighLeft, Limb::ThighRight},
    Meaning{"upleg", Limb::ThighLeft, Limb::ThighRight},
    Meaning{"thigh", Limb::ThighLeft, Limb::ThighRight},
    Meaning{"femur", Limb::ThighLeft, Limb::ThighRight},
    Meaning{"lowerleg", Limb::ShankLeft, Limb::ShankRight},
    Meaning{"lowleg", Limb::ShankLeft, Limb::ShankRight},
    Meaning{"shank", Limb::ShankLeft, Limb::ShankRight},
    Meaning{"tibia", Limb::ShankLeft, Limb::ShankRight},
    Meaning{"calf", Limb::ShankLeft, Limb::ShankRight},
    Meaning{"calcn", Limb::FootLeft, Limb::FootRight},
    Meaning{"foot", Limb::FootLeft, Limb::FootRight},
    Meaning{"pelvis", Limb::Pelvis, Limb::Pelvis},
    Meaning{"hips", Limb::Pelvis, Limb::Pelvis},
    Meaning{"waist", Limb::Pelvis, Limb::Pelvis},
    Meaning{"sternum", Limb::Chest, Limb::Chest},
    Meaning{"chest", Limb::Chest, Limb::Chest},
    Meaning{"torso", Limb::Chest, Limb::Chest},
    Meaning{"t8", Limb::Chest, Limb::Chest},
    Meaning{"head", Limb::Head, Limb::Head},
};

/// The words of a name in lower case: "LeftUpperLeg" and "left_upper-leg" give left, upper, leg.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  bool open = false;
  bool was_lower = false;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) == 0) {
      open = false;
      continue;
    }
    if (!open || (was_lower && std::isupper(u) != 0)) words.emplace_back();
    open = true;
    was_lower = std::islower(u) != 0;
    words.back().push_back(static_cast<char>(std::tolower(u)));
  }
  return words;
}

Side side_of(const std::string& word) {
  if (word == "l" || word == "left") return Side::Left;
  return word == "r" || word == "right" ? Side::Right : Side::None;
}

}  // namespace

std::optional<Limb> limb_named(std::string_view name) {
  const auto found = std::ranges::find(kLimbNames, name);
  if (found == kLimbNames.end()) return std::nullopt;
  return static_cast<Limb>(found - kLimbNames.begin());
}

std::optional<Limb> limb_meant_by(std::string_view name) {
  if (const auto exact = limb_named(name)) return exact;
  Side side = Side::None;
  std::string rest;
  for (const std::string& word : words_of(name)) {
    const Side here = side_of(word);
    if (here == Side::None) {
      rest += word;
    } else if (side != Side::None && side != here) {
      return std::nullopt;
    } else {
      side = here;
    }
  }
  const auto meant = std::ranges::find_if(
      kMeanings, [&](const Meaning& each) { return rest.find(each.word) != std::string::npos; });
  if (meant == kMeanings.end()) return std::nullopt;
  if (meant->left != meant->right && side == Side::None) return std::nullopt;
  return side == Side::Right ? meant->right : meant->left;
}

std::string_view words_for(Limb limb) {
  // clang-format off
  static constexpr std::array<std::string_view, kLimbCount> kWords{
    "pelvis", "chest", "head",
    "left upper arm", "left forearm", "left hand",
    "right upper arm", "right forearm", "right hand",
    "left thigh", "left shank", "left foot",
    "right thigh", "right shank", "right foot"};
  // clang-format on
  return kWords[index_of(limb)];
}

Limb mirror_of(Limb limb) {
  if (limb <= Limb::Head) return limb;
  const std::size_t beyond = index_of(limb) - index_of(Limb::UpperArmLeft);
  constexpr std::size_t kPerSide = 3;  // left arm, right arm, left leg, right leg
  const bool left = (beyond / kPerSide) % 2 == 0;
  return static_cast<Limb>(left ? index_of(limb) + kPerSide : index_of(limb) - kPerSide);
}

}  // namespace chorus::inertial
