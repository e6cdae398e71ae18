#include "common/motion/bvh.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "common/base/units.h"
#include "common/motion/text_lines.h"

namespace chorus::motion {
namespace {

constexpr std::array<std::string_view, 6> kChannelNames{"xposition", "yposition", "zposition",
                                                        "xrotation", "yrotation", "zrotation"};
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::uint8_t kFirstRotation = 3;
constexpr std::size_t kMaxChannels = 6;

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// A number with a decimal point or, as some locales write it, a comma.
bool read_decimal(std::string_view word, double& out) {
  std::string text(word);
  std::replace(text.begin(), text.end(), ',', '.');
  return read_finite(text, out);
}

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
  Result<void> read_frame_time();
  void read_frame();
  [[nodiscard]] double number_after_colon() const;
  [[nodiscard]] std::string key(std::size_t i = 0) const { return lower_case(lines_.word(i)); }
  [[nodiscard]] std::string rest_of_line() const;
  void note_frames(double announced);

  TextLines lines_;
  double scale_;
  Bvh bvh_;
  std::vector<std::size_t> open_;  ///< Joints whose '{' has not been closed, outermost first.
  bool awaiting_brace_ = false;
  std::vector<std::size_t> unread_;  ///< Numbers of the motion's lines that could not be read.
};

Result<Bvh> BvhReader::read() {
  if (!lines_.next() || key() != "hierarchy") return lines_.wrong("expected HIERARCHY");
  if (const auto ok = read_hierarchy(); !ok) return pass(ok);
  if (const auto ok = read_motion(); !ok) return pass(ok);
  return std::move(bvh_);
}

Result<void> BvhReader::read_hierarchy() {
  while (lines_.next()) {
    if (key() == "motion") {
      if (!open_.empty() || awaiting_brace_) return lines_.wrong("a joint is not closed");
      if (bvh_.joints.empty()) return lines_.wrong("there is no joint");
      return {};
    }
    if (const auto ok = read_hierarchy_line(); !ok) return ok;
  }
  return lines_.wrong("the file ends before MOTION");
}

Result<void> BvhReader::read_hierarchy_line() {
  const std::string key = this->key();
  if (awaiting_brace_ != (key == "{"))
    return lines_.wrong("expected '{' after the name of a joint");
  if (key == "{") {
    awaiting_brace_ = false;
    return {};
  }
  if (key == "root" && !bvh_.joints.empty())
    return lines_.wrong("a second ROOT; export one person a file");
  if (key == "root") return open_joint(rest_of_line());
  if (open_.empty()) return lines_.wrong("expected ROOT");
  if (key == "joint") return open_joint(rest_of_line());
  if (key == "end") return open_joint(bvh_.joints[open_.back()].name + " End");
  if (key == "offset") return read_offset();
  if (key == "channels") return read_channels();
  if (key != "}")
    return lines_.wrong("unknown keyword '" + std::string(lines_.word(0).substr(0, 40)) + "'");
  open_.pop_back();
  return {};
}

/// The words after the first, without a brace: names may contain blanks.
std::string BvhReader::rest_of_line() const {
  std::string text;
  for (std::size_t i = 1; i < lines_.words().size(); ++i) {
    if (lines_.word(i) == "{") break;
    text += (i == 1 ? "" : " ") + std::string(lines_.word(i));
  }
  return text;
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
    const auto* found = std::find(kChannelNames.begin(), kChannelNames.end(), key(2 + i));
    if (found == kChannelNames.end()) return lines_.wrong("unknown channel");
    joint.channels.push_back(static_cast<std::uint8_t>(found - kChannelNames.begin()));
  }
  joint.first_channel = bvh_.channel_count;
  bvh_.channel_count += count;
  return {};
}

/// The number in "Frames: 12", "Frames:12" or "Frame Time: 0.03"; NaN if there is none.
double BvhReader::number_after_colon() const {
  const std::string last = std::string(lines_.words().back());
  const std::size_t colon = last.rfind(':');
  double value = std::nan("");
  read_decimal(colon == std::string::npos ? last : last.substr(colon + 1), value);
  return value;
}

Result<void> BvhReader::read_frame_time() {
  if (!lines_.next() || key() != "frame" || !key(1).starts_with("time") ||
      !((bvh_.frame_time = number_after_colon()) > 0))
    return lines_.wrong("expected 'Frame Time: SECONDS' above zero");
  return {};
}

Result<void> BvhReader::read_motion() {
  if (!lines_.next() || !key().starts_with("frames")) return lines_.wrong("expected 'Frames: N'");
  const double announced = number_after_colon();
  if (!(announced >= 0)) return lines_.wrong("expected 'Frames: N'");
  if (const auto ok = read_frame_time(); !ok) return ok;
  while (lines_.next()) {
    if (bvh_.frames.size() >= kMaxFrames) return lines_.too_large("more than 200000 frames");
    read_frame();
  }
  note_frames(announced);
  if (bvh_.frames.empty()) return lines_.wrong("there is no frame; is the file cut off?");
  if (unread_.size() == bvh_.frames.size())
    return lines_.wrong("expected " + std::to_string(bvh_.channel_count) +
                        " numbers in every line, as many as there are channels; none has them");
  return {};
}

/// Says what is not as announced, and leaves out a last line that is cut off.
void BvhReader::note_frames(double announced) {
  const std::size_t there = bvh_.frames.size();
  if (there > 0 && bvh_.frames.back().empty()) {
    bvh_.frames.pop_back();
    unread_.pop_back();
    bvh_.notes.emplace_back("the last line is cut off and was left out");
  }
  if (static_cast<double>(there) != announced)
    bvh_.notes.push_back("announces " + std::to_string(static_cast<std::size_t>(announced)) +
                         " frames and holds " + std::to_string(there) + ", which were read");
  if (!unread_.empty())
    bvh_.notes.push_back(std::to_string(unread_.size()) +
                         " frames cannot be read and show nobody; the first is in line " +
                         std::to_string(unread_.front()));
}

/// Adds the frame of this line; an empty one if the line is not as many numbers as channels.
void BvhReader::read_frame() {
  std::vector<double> values(lines_.words().size());
  bool whole = values.size() == bvh_.channel_count;
  for (std::size_t i = 0; i < values.size() && whole; ++i)
    whole = read_decimal(lines_.word(i), values[i]);
  if (!whole) {
    unread_.push_back(lines_.number());
    bvh_.frames.emplace_back();
    return;
  }
  for (const BvhJoint& joint : bvh_.joints) {
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      double& value = values[joint.first_channel + i];
      value = joint.channels[i] < kFirstRotation ? scale_ * value : deg(value);
    }
  }
  bvh_.frames.push_back(std::move(values));
}

}  // namespace

Result<Bvh> parse_bvh(std::string_view text, std::string_view origin, double metres_per_unit) {
  if (text.size() > kMaxTextBytes) {
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 64 MB");
  }
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return BvhReader(text, origin, metres_per_unit).read();
}

std::vector<Eigen::Vector3d> joint_positions(const Bvh& bvh, std::size_t frame) {
  std::vector<Eigen::Vector3d> positions(bvh.joints.size(), Eigen::Vector3d::Zero());
  if (frame >= bvh.frames.size() || bvh.frames[frame].empty()) return positions;
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
