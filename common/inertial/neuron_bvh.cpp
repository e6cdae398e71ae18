#include "common/inertial/neuron_bvh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/base/parse.h"
#include "common/base/units.h"
#include "common/inertial/segment_poses.h"

namespace chorus::inertial {
namespace {

constexpr std::size_t kNeuronBones = 59;
constexpr std::size_t kMostFrame = 16'384;  // [bytes]; 59 bones need about 4000
constexpr std::string_view kFrameEnd = "||";

struct NeuronRow {
  std::size_t index;  ///< Among the 59.
  std::string_view name;
  int parent;  ///< Row here.
  std::optional<Limb> limb;
};
// Fingers are left out: nobody's limb hangs from them.
// clang-format off
constexpr std::array<NeuronRow, 21> kNeuron{{
  {0, "Hips", -1, Limb::Pelvis},
  {1, "RightUpLeg", 0, Limb::ThighRight}, {2, "RightLeg", 1, Limb::ShankRight}, {3, "RightFoot", 2, Limb::FootRight},
  {4, "LeftUpLeg", 0, Limb::ThighLeft}, {5, "LeftLeg", 4, Limb::ShankLeft}, {6, "LeftFoot", 5, Limb::FootLeft},
  {7, "Spine", 0, {}}, {8, "Spine1", 7, {}}, {9, "Spine2", 8, {}}, {10, "Spine3", 9, Limb::Chest}, {11, "Neck", 10, {}}, {12, "Head", 11, Limb::Head},
  {13, "RightShoulder", 10, {}}, {14, "RightArm", 13, Limb::UpperArmRight}, {15, "RightForeArm", 14, Limb::ForearmRight}, {16, "RightHand", 15, Limb::HandRight},
  {36, "LeftShoulder", 10, {}}, {37, "LeftArm", 17, Limb::UpperArmLeft}, {38, "LeftForeArm", 18, Limb::ForearmLeft}, {39, "LeftHand", 19, Limb::HandLeft}}};
// clang-format on

SegmentPoses neuron_segments() {
  std::vector<Segment> segments;
  for (const NeuronRow& row : kNeuron)
    segments.push_back({std::string(row.name), row.parent, row.limb});
  return SegmentPoses(std::move(segments));
}

std::vector<std::string_view> words_in(std::string_view text) {
  std::vector<std::string_view> out;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(" \r\n\t", at)) != std::string_view::npos) {
    const std::size_t end = std::min(text.size(), text.find_first_of(" \r\n\t", at));
    out.push_back(text.substr(at, end - at));
    at = end;
  }
  return out;
}

/// R = Ry Rx Rz of the angles as they are sent, in degrees.
Eigen::Quaterniond turned_by(double y, double x, double z) {
  return Eigen::AngleAxisd(deg(y), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(deg(x), Eigen::Vector3d::UnitX()) *
         Eigen::Quaterniond(Eigen::AngleAxisd(deg(z), Eigen::Vector3d::UnitZ()));
}

class NeuronReader final : public StreamReader {
 public:
  explicit NeuronReader(int avatar) : avatar_(avatar) {}

  [[nodiscard]] Result<void> take(std::string_view bytes, Timestamp now) override {
    Result<void> all{};
    waiting_.append(bytes);
    std::size_t begin = 0;
    for (std::size_t end = 0; (end = waiting_.find(kFrameEnd, begin)) != std::string::npos;
         begin = end + kFrameEnd.size()) {
      auto ok = take_frame(std::string_view(waiting_).substr(begin, end - begin), now);
      if (!ok) all = std::move(ok);
    }
    waiting_.erase(0, begin);
    if (waiting_.size() <= kMostFrame) return all;
    waiting_.clear();
    return fail(ErrorCode::TooLarge, "BVH stream",
                "has a frame of more than 16 kB; is \"BVH, string\" chosen?");
  }
  [[nodiscard]] std::optional<InertialFrame> instant(Timestamp now) override {
    return poses_.instant(now);
  }
  void restart() override { waiting_.clear(); }

 private:
  Result<void> take_frame(std::string_view text, Timestamp now) {
    const auto words = words_in(text);
    constexpr std::size_t kHead = 2;  // the avatar's number and name
    constexpr std::size_t kFull = 6 * kNeuronBones, kLean = 3 * kNeuronBones + 3;
    const std::size_t numbers = words.size() < kHead ? 0 : words.size() - kHead;
    if (numbers != kFull && numbers != kLean)
      return fail(
          ErrorCode::Malformed, "BVH stream",
          "a frame has " + std::to_string(numbers) +
              " numbers; it should be 354 (with displacement) or 180; choose the skeleton of 59 "
              "bones, without a reference");
    const auto avatar = parse_finite(words[0]);
    if (!avatar) return fail(ErrorCode::Malformed, "BVH stream", "a frame has no avatar's number");
    if (*avatar != avatar_) return {};  // Somebody else.
    for (std::size_t row = 0; row < kNeuron.size(); ++row) {
      const std::size_t bone = kNeuron[row].index;
      const std::size_t first = kHead + 3 + (numbers == kFull ? 6 * bone : 3 * bone);
      const auto y = parse_finite(words[first]), x = parse_finite(words[first + 1]),
                 z = parse_finite(words[first + 2]);
      if (!x || !y || !z)
        return fail(ErrorCode::Malformed, "BVH bone " + std::string(kNeuron[row].name),
                    "its rotation is not three numbers");
      poses_.turn(row, turned_by(*y, *x, *z), now);
    }
    return {};
  }

  int avatar_;
  std::string waiting_;
  SegmentPoses poses_ = neuron_segments();
};

}  // namespace

std::unique_ptr<StreamReader> make_neuron_reader(int avatar) {
  return std::make_unique<NeuronReader>(avatar);
}

}  // namespace chorus::inertial
