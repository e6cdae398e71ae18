#include "fusion-server/natnet/bone_lengths.h"

#include <algorithm>
#include <cmath>

#include "common/base/median.h"

namespace chorus::natnet {
namespace {

constexpr std::size_t kHip = 0;
constexpr std::array<std::size_t, 4> kLegs{14, 15, 17, 18};  ///< LShin, LFoot, RShin, RFoot.

double length_of(const std::array<double, 3>& offset) {
  return std::hypot(offset[0], offset[1], offset[2]);
}

double leg_of(const BoneOffsets& offsets) {
  double both = 0.0;
  for (const std::size_t bone : kLegs) both += length_of(offsets[bone]);
  return both / 2.0;
}

bool differ(const BoneOffsets& a, const BoneOffsets& b, double tolerance) {
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    if (std::abs(length_of(a[i]) - length_of(b[i])) > tolerance) return true;
  }
  return false;
}

}  // namespace

BoneOffsets adult_offsets() {
  BoneOffsets offsets{};
  for (std::size_t i = 0; i < kBoneCount; ++i) offsets[i] = motive_bones()[i].offset;
  return offsets;
}

std::optional<BoneOffsets> BoneLengths::add(PersonId person, const MotiveSkeleton& local) {
  if (!wants(person)) return std::nullopt;
  if (person != person_ || frames_ == 0) {
    person_ = person;
    done_ = false;
    frames_ = 0;
    for (auto& lengths : lengths_) lengths.clear();
  }
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const std::int32_t parent = motive_bones()[i].parent;
    if (parent == 0 || !local[i].tracked || !local[static_cast<std::size_t>(parent - 1)].tracked) {
      continue;
    }
    lengths_[i].push_back(local[i].position.norm());
  }
  if (++frames_ < kFrames) return std::nullopt;
  done_ = true;
  const BoneOffsets found = measured();
  if (!differ(found, described_, kTolerance)) return std::nullopt;
  described_ = found;
  return found;
}

/// The measured offsets.  Directions are those of the T-pose.  A bone seen in less than half of the
/// frames gets an adult's length.  The hip is as high as the legs are long.
BoneOffsets BoneLengths::measured() const {
  BoneOffsets offsets = adult_offsets();
  const double adult_leg = leg_of(offsets);
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const double adult = length_of(offsets[i]);
    if (lengths_[i].size() < kFrames / 2 || adult == 0.0) continue;
    const double scale = median(lengths_[i]) / adult;
    for (double& part : offsets[i]) part *= scale;
  }
  offsets[kHip][1] += leg_of(offsets) - adult_leg;
  return offsets;
}

}  // namespace chorus::natnet
