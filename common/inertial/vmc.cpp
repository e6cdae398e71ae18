#include "common/inertial/vmc.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "common/base/units.h"
#include "common/inertial/osc_message.h"
#include "common/inertial/segment_poses.h"

namespace chorus::inertial {
namespace {

// clang-format off
constexpr std::array<SegmentRow, 22> kBones{{
  {"Hips", -1, Limb::Pelvis}, {"Spine", 0, {}}, {"Chest", 1, {}}, {"UpperChest", 2, Limb::Chest}, {"Neck", 3, {}}, {"Head", 4, Limb::Head},
  {"LeftShoulder", 3, {}}, {"LeftUpperArm", 6, Limb::UpperArmLeft}, {"LeftLowerArm", 7, Limb::ForearmLeft}, {"LeftHand", 8, Limb::HandLeft},
  {"RightShoulder", 3, {}}, {"RightUpperArm", 10, Limb::UpperArmRight}, {"RightLowerArm", 11, Limb::ForearmRight}, {"RightHand", 12, Limb::HandRight},
  {"LeftUpperLeg", 0, Limb::ThighLeft}, {"LeftLowerLeg", 14, Limb::ShankLeft}, {"LeftFoot", 15, Limb::FootLeft}, {"LeftToes", 16, {}},
  {"RightUpperLeg", 0, Limb::ThighRight}, {"RightLowerLeg", 18, Limb::ShankRight}, {"RightFoot", 19, Limb::FootRight}, {"RightToes", 20, {}}}};
constexpr std::array<SegmentRow, 9> kVrchat{{
  {"1", -1, Limb::Pelvis}, {"2", -1, Limb::FootLeft}, {"3", -1, Limb::FootRight}, {"4", -1, Limb::ThighLeft}, {"5", -1, Limb::ThighRight},
  {"6", -1, Limb::Chest}, {"7", -1, Limb::UpperArmLeft}, {"8", -1, Limb::UpperArmRight}, {"head", -1, Limb::Head}}};
// clang-format on

template <std::size_t kCount>
SegmentPoses poses_of(const std::array<SegmentRow, kCount>& rows, std::string_view prefix) {
  std::vector<Segment> segments;
  for (const SegmentRow& row : rows)
    segments.push_back({std::string(prefix) + std::string(row.name), row.parent, row.limb});
  return SegmentPoses(std::move(segments));
}

/// px py pz qx qy qz qw of a message, as our rotation.
Result<Eigen::Quaterniond> rotation_of(const OscMessage& message, std::string_view name) {
  const auto& n = message.numbers;
  if (n.size() < 7)
    return fail(ErrorCode::Malformed, "segment " + std::string(name.substr(0, kMaxSensorName)),
                "has fewer than seven numbers");
  auto rotation = sent_rotation(name, {n[6], n[3], n[4], n[5]});
  if (!rotation) return rotation;
  return from_unity(*rotation);
}

/// Hands each message of a datagram on; ends at the first that is refused.
template <class Take>
Result<void> each_message(std::string_view bytes, const Take& take) {
  const auto messages = parse_osc(bytes);
  if (!messages) return pass(messages);
  for (const OscMessage& message : *messages)
    if (auto ok = take(message); !ok) return ok;
  return {};
}

class VmcReader final : public StreamReader {
 public:
  [[nodiscard]] Result<void> take(std::string_view bytes, Timestamp now) override {
    return each_message(bytes, [&](const OscMessage& m) { return take_message(m, now); });
  }

  [[nodiscard]] std::optional<InertialFrame> instant(Timestamp now) override {
    auto frame = bones_.instant(now);
    if (!frame) {
      frame.emplace();
      frame->captured = now;
    }
    for (auto& [serial, reading] : trackers_) frame->readings.push_back(std::move(reading));
    trackers_.clear();
    if (frame->readings.empty()) return std::nullopt;
    frame->sequence = ++instants_;
    return frame;
  }

 private:
  static constexpr std::size_t kMostTrackers = 32;

  Result<void> take_message(const OscMessage& message, Timestamp now) {
    const bool bone = message.address == "/VMC/Ext/Bone/Pos";
    if ((!bone && message.address != "/VMC/Ext/Tra/Pos") || message.texts.empty()) return {};
    const std::string_view name = message.texts.front();
    if (bone) {
      // Fingers, eyes and jaw are worn by nobody.
      const auto segment = bones_.find(name);
      if (!segment) return {};
      const auto rotation = rotation_of(message, name);
      if (!rotation) return pass(rotation);
      bones_.turn(*segment, *rotation, now);
      return {};
    }
    return take_tracker(message, name, now);
  }

  Result<void> take_tracker(const OscMessage& message, std::string_view serial, Timestamp now) {
    const auto rotation = rotation_of(message, serial);
    if (!rotation) return pass(rotation);
    const std::string name = "Tra/" + std::string(serial.substr(0, kMaxSensorName - 4));
    if (trackers_.size() >= kMostTrackers && !trackers_.contains(name))
      return fail(ErrorCode::TooLarge, "VMC", "there are more than 32 trackers");
    InertialReading reading;
    reading.sensor = name;
    reading.captured = now;
    reading.inertial_from_sensor = *rotation;
    trackers_[name] = std::move(reading);
    return {};
  }

  SegmentPoses bones_ = poses_of(kBones, "");
  std::map<std::string, InertialReading> trackers_;
  std::uint64_t instants_ = 0;
};

class VrchatReader final : public StreamReader {
 public:
  [[nodiscard]] Result<void> take(std::string_view bytes, Timestamp now) override {
    return each_message(bytes, [&](const OscMessage& m) { return take_message(m, now); });
  }
  [[nodiscard]] std::optional<InertialFrame> instant(Timestamp now) override {
    return trackers_.instant(now);
  }

 private:
  static constexpr std::string_view kBefore = "/tracking/trackers/";
  static constexpr std::string_view kBehind = "/rotation";

  Result<void> take_message(const OscMessage& message, Timestamp now) {
    std::string_view which = message.address;
    if (!which.starts_with(kBefore) || !which.ends_with(kBehind)) return {};
    which.remove_prefix(kBefore.size());
    which.remove_suffix(std::min(which.size(), kBehind.size()));
    const auto tracker = trackers_.find("vrchat-" + std::string(which));
    if (!tracker)
      return fail(ErrorCode::Malformed, "VRChat tracker " + std::string(which.substr(0, 20)),
                  "is none: they are called 1 to 8 and head");
    const auto& n = message.numbers;
    const bool fine = n.size() >= 3 && std::all_of(n.begin(), n.begin() + 3, [](double each) {
                        return std::abs(each) < 1e5;  // also false for NaN
                      });
    if (!fine)
      return fail(ErrorCode::Malformed, "VRChat tracker " + std::string(which),
                  "its rotation is not three angles in degrees");
    const Eigen::Quaterniond turned =
        Eigen::AngleAxisd(deg(n[1]), Eigen::Vector3d::UnitY()) *
        Eigen::AngleAxisd(deg(n[0]), Eigen::Vector3d::UnitX()) *
        Eigen::Quaterniond(Eigen::AngleAxisd(deg(n[2]), Eigen::Vector3d::UnitZ()));
    trackers_.turn(*tracker, from_unity(turned), now);
    return {};
  }

  SegmentPoses trackers_ = poses_of(kVrchat, "vrchat-");
};

}  // namespace

std::unique_ptr<StreamReader> make_vmc_reader() { return std::make_unique<VmcReader>(); }
std::unique_ptr<StreamReader> make_vrchat_reader() { return std::make_unique<VrchatReader>(); }

}  // namespace chorus::inertial
