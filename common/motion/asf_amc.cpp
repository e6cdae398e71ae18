#include "common/motion/asf_amc.h"

#include <algorithm>
#include <optional>

#include "common/base/units.h"
#include "common/motion/text_lines.h"

namespace chorus::motion {
namespace {

constexpr double kMetresPerInch = 0.0254;
constexpr std::size_t kRootChannels = 6;
constexpr std::array<std::string_view, 3> kTurnNames{"rx", "ry", "rz"};
constexpr std::array<std::string_view, 7> kRootOrder{"order", "TX", "TY", "TZ", "RX", "RY", "RZ"};

Eigen::Quaterniond fixed_xyz(double x, double y, double z) {
  return Eigen::AngleAxisd(z, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(y, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(x, Eigen::Vector3d::UnitX());
}

/// A bone as the file states it, before the hierarchy defines the order of the bones.
struct WrittenBone {
  AsfBone bone;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length = 0.0;
};

class AsfReader {
 public:
  AsfReader(std::string_view text, std::string_view origin) : lines_(text, origin) {}
  Result<AsfSkeleton> read();

 private:
  Result<void> read_sections();
  Result<void> read_units();
  Result<void> read_root();
  Result<void> read_bones();
  Result<void> read_bone();
  Result<void> read_bone_line(WrittenBone& written);
  Result<void> read_axis(AsfBone& bone);
  Result<void> read_turns(AsfBone& bone);
  Result<void> read_hierarchy();
  Result<void> hang(std::string_view parent, std::string_view child);
  bool next();

  TextLines lines_;
  bool held_ = false;  ///< The current line has not yet been consumed.
  AsfSkeleton skeleton_;
  std::vector<WrittenBone> written_;
};

bool AsfReader::next() {
  if (held_) {
    held_ = false;
    return true;
  }
  return lines_.next();
}

Result<AsfSkeleton> AsfReader::read() {
  AsfBone root;
  root.name = "root";
  root.turns = {true, true, true};
  skeleton_.bones.push_back(root);
  skeleton_.metres_per_unit = kMetresPerInch;
  if (const Result<void> ok = read_sections(); !ok) return pass(ok);
  if (skeleton_.bones.size() != written_.size() + 1 || written_.empty()) {
    return lines_.wrong("the hierarchy hangs " + std::to_string(skeleton_.bones.size() - 1) +
                        " of " + std::to_string(written_.size()) + " bones");
  }
  skeleton_.channel_count = kRootChannels;
  for (std::size_t i = 1; i < skeleton_.bones.size(); ++i) {
    AsfBone& bone = skeleton_.bones[i];
    bone.first_channel = skeleton_.channel_count;
    skeleton_.channel_count +=
        static_cast<std::size_t>(std::count(bone.turns.begin(), bone.turns.end(), true));
  }
  return skeleton_;
}

Result<void> AsfReader::read_sections() {
  while (next()) {
    Result<void> ok;
    if (lines_.word(0) == ":units") ok = read_units();
    if (lines_.word(0) == ":root") ok = read_root();
    if (lines_.word(0) == ":bonedata") ok = read_bones();
    if (lines_.word(0) == ":hierarchy") ok = read_hierarchy();
    if (!ok) return ok;
  }
  return {};
}

Result<void> AsfReader::read_units() {
  while (next()) {
    if (lines_.word(0).starts_with(':')) return held_ = true, Result<void>();
    if (lines_.word(0) == "length") {
      const auto scale = lines_.numbers(1, 1);
      if (!scale) return pass(scale);
      if (!(scale->front() > 0)) return lines_.wrong("the unit of length must be above zero");
      skeleton_.metres_per_unit = kMetresPerInch / scale->front();
    }
    if (lines_.word(0) == "angle" && lines_.word(1) != "deg") {
      return lines_.wrong("only angles in deg are read");
    }
  }
  return {};
}

Result<void> AsfReader::read_root() {
  while (next()) {
    if (lines_.word(0).starts_with(':')) return held_ = true, Result<void>();
    if (lines_.word(0) == "order" && !std::equal(kRootOrder.begin(), kRootOrder.end(),
                                                 lines_.words().begin(), lines_.words().end())) {
      return lines_.wrong("the root order must be TX TY TZ RX RY RZ");
    }
    if (lines_.word(0) == "axis" && lines_.word(1) != "XYZ") {
      return lines_.wrong("the root axis order must be XYZ");
    }
    if (lines_.word(0) == "position" || lines_.word(0) == "orientation") {
      const auto zero = lines_.numbers(1, 3);
      if (!zero) return pass(zero);
      if (std::any_of(zero->begin(), zero->end(), [](double v) { return v != 0; })) {
        return lines_.wrong("a root that does not start at zero is not supported");
      }
    }
  }
  return {};
}

Result<void> AsfReader::read_bones() {
  while (next()) {
    if (lines_.word(0).starts_with(':')) return held_ = true, Result<void>();
    if (lines_.word(0) != "begin") return lines_.wrong("expected 'begin' of a bone");
    if (const Result<void> ok = read_bone(); !ok) return ok;
    if (written_.size() >= kMaxSegments) return lines_.too_large("more than 512 bones");
  }
  return {};
}

Result<void> AsfReader::read_bone() {
  WrittenBone written;
  while (next()) {
    if (lines_.word(0) == "end") {
      if (written.bone.name.empty()) return lines_.wrong("this bone has no name");
      written.bone.reach = skeleton_.metres_per_unit * written.length * written.direction;
      written_.push_back(std::move(written));
      return {};
    }
    if (const Result<void> ok = read_bone_line(written); !ok) return ok;
  }
  return lines_.wrong("the file ends inside a bone");
}

Result<void> AsfReader::read_bone_line(WrittenBone& written) {
  const std::string_view key = lines_.word(0);
  if (key == "name") written.bone.name = std::string(lines_.word(1));
  if (key == "dof") return read_turns(written.bone);
  if (key == "axis") return read_axis(written.bone);
  if (key == "length") {
    const auto length = lines_.numbers(1, 1);
    if (!length) return pass(length);
    written.length = length->front();
  }
  if (key == "direction") {
    const auto xyz = lines_.numbers(1, 3);
    if (!xyz) return pass(xyz);
    written.direction = Eigen::Vector3d(xyz->data()).stableNormalized();
  }
  return {};
}

Result<void> AsfReader::read_axis(AsfBone& bone) {
  const auto angles = lines_.numbers(1, 3);
  if (!angles) return pass(angles);
  if (lines_.word(4) != "XYZ") return lines_.wrong("the axis order must be XYZ");
  bone.axis = fixed_xyz(deg((*angles)[0]), deg((*angles)[1]), deg((*angles)[2]));
  return {};
}

Result<void> AsfReader::read_turns(AsfBone& bone) {
  std::size_t least = 0;
  for (std::size_t i = 1; i < lines_.words().size(); ++i) {
    const auto* found = std::find(kTurnNames.begin(), kTurnNames.end(), lines_.word(i));
    const auto turn = static_cast<std::size_t>(found - kTurnNames.begin());
    if (turn == kTurnNames.size() || turn < least) {
      return lines_.wrong("degrees of freedom must be a subset of rx ry rz in this order");
    }
    bone.turns[turn] = true;
    least = turn + 1;
  }
  return {};
}

Result<void> AsfReader::read_hierarchy() {
  while (next()) {
    if (lines_.word(0) == "begin") continue;
    if (lines_.word(0) == "end") return {};
    for (std::size_t i = 1; i < lines_.words().size(); ++i) {
      if (const Result<void> ok = hang(lines_.word(0), lines_.word(i)); !ok) return ok;
    }
  }
  return lines_.wrong("the file ends inside the hierarchy");
}

Result<void> AsfReader::hang(std::string_view parent, std::string_view child) {
  const std::size_t above = bone_named(skeleton_, parent);
  if (above == skeleton_.bones.size()) {
    return lines_.wrong("'" + std::string(parent) +
                        "' is not part of the hierarchy above this line");
  }
  if (bone_named(skeleton_, child) != skeleton_.bones.size()) {
    return lines_.wrong("'" + std::string(child) + "' has two parents");
  }
  const auto found = std::find_if(written_.begin(), written_.end(),
                                  [&](const WrittenBone& each) { return each.bone.name == child; });
  if (found == written_.end()) {
    return lines_.wrong("there is no bone '" + std::string(child) + "'");
  }
  skeleton_.bones.push_back(found->bone);
  skeleton_.bones.back().parent = above;
  return {};
}

/// Reads one line such as "lfemur 1.0 2.0 3.0" into the bone's channels.
Result<void> read_amc_line(const TextLines& lines, const AsfSkeleton& skeleton, AmcFrame& frame,
                           std::vector<bool>& seen) {
  const std::size_t index = bone_named(skeleton, lines.word(0));
  if (index == skeleton.bones.size()) {
    return lines.wrong("the skeleton has no bone '" + std::string(lines.word(0).substr(0, 40)) +
                       "'");
  }
  const AsfBone& bone = skeleton.bones[index];
  const std::size_t count =
      index == 0 ? kRootChannels
                 : static_cast<std::size_t>(std::count(bone.turns.begin(), bone.turns.end(), true));
  if (lines.words().size() != count + 1) {
    return lines.wrong("expected " + std::to_string(count) + " numbers for " + bone.name);
  }
  const auto values = lines.numbers(1, count);
  if (!values) return pass(values);
  for (std::size_t i = 0; i < count; ++i) {
    const bool length = index == 0 && i < 3;
    frame[bone.first_channel + i] =
        length ? skeleton.metres_per_unit * (*values)[i] : deg((*values)[i]);
  }
  seen[index] = true;
  return {};
}

/// The first bone with channels that is missing in this frame.
std::optional<std::string> absent_bone(const AsfSkeleton& skeleton, const std::vector<bool>& seen) {
  for (std::size_t i = 0; i < skeleton.bones.size(); ++i) {
    const auto& turns = skeleton.bones[i].turns;
    if (!seen[i] && std::count(turns.begin(), turns.end(), true) > 0) return skeleton.bones[i].name;
  }
  return std::nullopt;
}

bool is_frame_number(const TextLines& lines) {
  return lines.words().size() == 1 && lines.word(0)[0] >= '0' && lines.word(0)[0] <= '9';
}

}  // namespace

std::size_t bone_named(const AsfSkeleton& skeleton, std::string_view name) {
  const auto found = std::find_if(skeleton.bones.begin(), skeleton.bones.end(),
                                  [&](const AsfBone& bone) { return bone.name == name; });
  return static_cast<std::size_t>(found - skeleton.bones.begin());
}

Result<AsfSkeleton> parse_asf(std::string_view text, std::string_view origin) {
  if (text.size() > kMaxTextBytes) {
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 64 MB");
  }
  return AsfReader(text, origin).read();
}

Result<std::vector<AmcFrame>> parse_amc(std::string_view text, std::string_view origin,
                                        const AsfSkeleton& skeleton) {
  if (text.size() > kMaxTextBytes) {
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 64 MB");
  }
  TextLines lines(text, origin);
  std::vector<AmcFrame> frames;
  std::vector<bool> seen;
  while (lines.next()) {
    if (lines.word(0) == ":RADIANS") return lines.wrong("only motion in degrees is read");
    if (lines.word(0).starts_with(':')) continue;
    if (is_frame_number(lines)) {
      if (const auto absent = frames.empty() ? std::nullopt : absent_bone(skeleton, seen)) {
        return lines.wrong("the frame before this line lacks " + *absent);
      }
      double number = 0;
      if (!read_finite(lines.word(0), number) || number != static_cast<double>(frames.size() + 1)) {
        return lines.wrong("expected frame " + std::to_string(frames.size() + 1));
      }
      if (frames.size() >= kMaxFrames) return lines.too_large("more than 200000 frames");
      frames.emplace_back(skeleton.channel_count, 0.0);
      seen.assign(skeleton.bones.size(), false);
    } else if (frames.empty()) {
      return lines.wrong("expected frame number 1");
    } else if (const auto ok = read_amc_line(lines, skeleton, frames.back(), seen); !ok) {
      return pass(ok);
    }
  }
  if (frames.empty()) return lines.wrong("there is no frame");
  if (const auto absent = absent_bone(skeleton, seen)) {
    return lines.wrong("the last frame lacks " + *absent);
  }
  return frames;
}

std::vector<Eigen::Vector3d> bone_ends(const AsfSkeleton& skeleton, const AmcFrame& frame) {
  const std::size_t count = skeleton.bones.size();
  std::vector<Eigen::Vector3d> ends(count, Eigen::Vector3d::Zero());
  std::vector<Eigen::Matrix3d> world_from_bone(count, Eigen::Matrix3d::Identity());
  if (frame.size() < skeleton.channel_count || count == 0) return ends;
  ends[0] = Eigen::Vector3d(frame.data());
  world_from_bone[0] = fixed_xyz(frame[3], frame[4], frame[5]).toRotationMatrix();
  for (std::size_t i = 1; i < count; ++i) {
    const AsfBone& bone = skeleton.bones[i];
    std::array<double, 3> angles{};
    std::size_t channel = bone.first_channel;
    for (std::size_t turn = 0; turn < 3; ++turn) {
      if (bone.turns[turn]) angles[turn] = frame[channel++];
    }
    const Eigen::Quaterniond turned =
        bone.axis * fixed_xyz(angles[0], angles[1], angles[2]) * bone.axis.conjugate();
    world_from_bone[i] = world_from_bone[bone.parent] * turned.toRotationMatrix();
    ends[i] = ends[bone.parent] + world_from_bone[i] * bone.reach;
  }
  return ends;
}

}  // namespace chorus::motion
