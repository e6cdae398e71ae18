#include "common/motion/bvh.h"

#include <algorithm>
#include <array>

#include "common/base/units.h"
#include "common/motion/text_lines.h"

namespace chorus::motion {
namespace {

constexpr std::array<std::string_view, 6> kChannelNames{"Xposition", "Yposition", "Zposition",
                                                        "Xrotation", "Yrotation", "Zrotation"};
constexpr std::uint8_t kFirstRotation = 3;
constexpr std::size_t kMaxChannels = 6;

class BvhReader {
 public:
  BvhReader(std::string_view text, std::string_view origin, double metres_per_unit)
      : lines_(text, origin), scale_(metres_per_unit) {}
  Result<Bvh> read();

 private:
  Result<void> read_hierarchy();
  Result<void> read_hierarchy_line();
  Result<void> open_joint(std::string name);
  Result<void> read_offset();
  Result<void> read_channels();
  Result<void> read_motion();
  Result<std::vector<double>> read_frame();

  TextLines lines_;
  double scale_;
  Bvh bvh_;
  std::vector<std::size_t> open_;  ///< Joints whose '{' has not been closed, outermost first.
  bool awaiting_brace_ = false;
};

Result<Bvh> BvhReader::read() {
  if (!lines_.next() || lines_.word(0) != "HIERARCHY") return lines_.wrong("expected HIERARCHY");
  if (const auto ok = read_hierarchy(); !ok) return pass(ok);
  if (const auto ok = read_motion(); !ok) return pass(ok);
  return std::move(bvh_);
}

Result<void> BvhReader::read_hierarchy() {
  while (lines_.next()) {
    if (lines_.word(0) == "MOTION") {
      if (!open_.empty() || awaiting_brace_) return lines_.wrong("a joint is not closed");
      if (bvh_.joints.empty()) return lines_.wrong("there is no joint");
      return {};
    }
    if (const auto ok = read_hierarchy_line(); !ok) return ok;
  }
  return lines_.wrong("the file ends before MOTION");
}

Result<void> BvhReader::read_hierarchy_line() {
  const std::string_view key = lines_.word(0);
  if (awaiting_brace_ != (key == "{"))
    return lines_.wrong("expected '{' after the name of a joint");
  if (key == "{") {
    awaiting_brace_ = false;
    return {};
  }
  if (key == "ROOT" && !bvh_.joints.empty()) return lines_.wrong("a second ROOT");
  if (key == "ROOT") return open_joint(std::string(lines_.word(1)));
  if (open_.empty()) return lines_.wrong("expected ROOT");
  if (key == "JOINT") return open_joint(std::string(lines_.word(1)));
  if (key == "End") return open_joint(bvh_.joints[open_.back()].name + " End");
  if (key == "OFFSET") return read_offset();
  if (key == "CHANNELS") return read_channels();
  if (key != "}") return lines_.wrong("unknown keyword '" + std::string(key.substr(0, 40)) + "'");
  open_.pop_back();
  return {};
}

Result<void> BvhReader::open_joint(std::string name) {
  if (name.empty()) return lines_.wrong("a joint needs a name");
  if (bvh_.joints.size() >= kMaxSegments) return lines_.too_large("more than 512 joints");
  BvhJoint joint;
  joint.name = std::move(name);
  joint.parent = open_.empty() ? 0 : open_.back();
  joint.first_channel = bvh_.channel_count;
  open_.push_back(bvh_.joints.size());
  bvh_.joints.push_back(std::move(joint));
  awaiting_brace_ = true;
  if (lines_.words().back() == "{") awaiting_brace_ = false;
  return {};
}

Result<void> BvhReader::read_offset() {
  const auto xyz = lines_.numbers(1, 3);
  if (!xyz) return pass(xyz);
  bvh_.joints[open_.back()].offset = scale_ * Eigen::Vector3d(xyz->data());
  return {};
}

Result<void> BvhReader::read_channels() {
  BvhJoint& joint = bvh_.joints[open_.back()];
  const std::size_t count = lines_.words().size() - std::min<std::size_t>(2, lines_.words().size());
  if (lines_.word(1) != std::to_string(count) || count > kMaxChannels || !joint.channels.empty()) {
    return lines_.wrong("the number of channels does not match their names");
  }
  if (open_.back() + 1 != bvh_.joints.size()) {
    return lines_.wrong("the channels of a joint must come before its children");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto* found = std::find(kChannelNames.begin(), kChannelNames.end(), lines_.word(2 + i));
    if (found == kChannelNames.end()) return lines_.wrong("unknown channel");
    joint.channels.push_back(static_cast<std::uint8_t>(found - kChannelNames.begin()));
  }
  joint.first_channel = bvh_.channel_count;
  bvh_.channel_count += count;
  return {};
}

Result<void> BvhReader::read_motion() {
  double count = 0;
  if (!lines_.next() || lines_.word(0) != "Frames:" || !read_finite(lines_.word(1), count)) {
    return lines_.wrong("expected 'Frames: N'");
  }
  if (count < 0 || count > static_cast<double>(kMaxFrames)) {
    return lines_.too_large("more than 200000 frames");
  }
  if (!lines_.next() || lines_.word(0) != "Frame" || lines_.word(1) != "Time:" ||
      !read_finite(lines_.word(2), bvh_.frame_time) || !(bvh_.frame_time > 0)) {
    return lines_.wrong("expected 'Frame Time: SECONDS' above zero");
  }
  while (lines_.next()) {
    if (static_cast<double>(bvh_.frames.size()) >= count) {
      return lines_.wrong("more frames than announced");
    }
    auto frame = read_frame();
    if (!frame) return pass(frame);
    bvh_.frames.push_back(std::move(*frame));
  }
  if (static_cast<double>(bvh_.frames.size()) != count || bvh_.frames.empty()) {
    return lines_.wrong("found " + std::to_string(bvh_.frames.size()) +
                        " frames, not as announced");
  }
  return {};
}

Result<std::vector<double>> BvhReader::read_frame() {
  if (lines_.words().size() != bvh_.channel_count) {
    return lines_.wrong("expected " + std::to_string(bvh_.channel_count) + " numbers, found " +
                        std::to_string(lines_.words().size()));
  }
  auto values = lines_.numbers(0, bvh_.channel_count);
  if (!values) return values;
  for (const BvhJoint& joint : bvh_.joints) {
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      double& value = (*values)[joint.first_channel + i];
      value = joint.channels[i] < kFirstRotation ? scale_ * value : deg(value);
    }
  }
  return values;
}

}  // namespace

Result<Bvh> parse_bvh(std::string_view text, std::string_view origin, double metres_per_unit) {
  if (text.size() > kMaxTextBytes) {
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 64 MB");
  }
  return BvhReader(text, origin, metres_per_unit).read();
}

std::vector<Eigen::Vector3d> joint_positions(const Bvh& bvh, std::size_t frame) {
  std::vector<Eigen::Vector3d> positions(bvh.joints.size(), Eigen::Vector3d::Zero());
  if (frame >= bvh.frames.size()) return positions;
  std::vector<Eigen::Isometry3d> world_from_joint(bvh.joints.size(), Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
    const BvhJoint& joint = bvh.joints[i];
    Eigen::Vector3d moved = joint.offset;
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
    for (std::size_t c = 0; c < joint.channels.size(); ++c) {
      const double value = bvh.frames[frame][joint.first_channel + c];
      const std::uint8_t kind = joint.channels[c];
      if (kind < kFirstRotation) {
        moved[kind] = value;
      } else {
        turned = turned * Eigen::AngleAxisd(value, Eigen::Vector3d::Unit(kind - kFirstRotation));
      }
    }
    Eigen::Isometry3d parent_from_joint = Eigen::Translation3d(moved) * turned;
    if (i > 0) parent_from_joint = world_from_joint[joint.parent] * parent_from_joint;
    world_from_joint[i] = parent_from_joint;
    positions[i] = parent_from_joint.translation();
  }
  return positions;
}

}  // namespace chorus::motion
