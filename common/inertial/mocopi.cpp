#include "common/inertial/mocopi.h"

#include <array>
#include <bit>
#include <string>

#include "common/inertial/segment_poses.h"

namespace chorus::inertial {
namespace mocopi {
namespace {

constexpr std::size_t kMostBones = 64;
constexpr std::size_t kBoxHead = 8;
constexpr std::size_t kTransformBytes = 28;
constexpr std::uint16_t kNoParent = 0xffff;
constexpr std::string_view kFormat = "sony motion format";

struct Box {
  std::string_view name, content;
};

std::uint32_t little(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

tl::unexpected<Error> damaged(std::string_view box, std::string what) {
  return fail(ErrorCode::Malformed, "mocopi box " + std::string(box), std::move(what));
}

Result<std::vector<Box>> boxes_of(std::string_view in, std::string_view bytes) {
  std::vector<Box> out;
  while (!bytes.empty()) {
    if (bytes.size() < kBoxHead) return damaged(in, "ends too early");
    const std::size_t size = little(bytes.substr(0, 4));
    if (size > bytes.size() - kBoxHead) return damaged(in, "ends too early");
    out.push_back({bytes.substr(4, 4), bytes.substr(kBoxHead, size)});
    bytes.remove_prefix(kBoxHead + size);
  }
  return out;
}

const Box* box_named(const std::vector<Box>& boxes, std::string_view name) {
  for (const Box& box : boxes)
    if (box.name == name) return &box;
  return nullptr;
}

Result<Bone> bone_of(const Box& box, bool skeleton) {
  const auto parts = boxes_of(box.name, box.content);
  if (!parts) return pass(parts);
  const Box* const id = box_named(*parts, "bnid");
  const Box* const parent = box_named(*parts, "pbid");
  const Box* const transform = box_named(*parts, "tran");
  const bool whole = id != nullptr && id->content.size() == 2 && transform != nullptr &&
                     transform->content.size() == kTransformBytes &&
                     (!skeleton || (parent != nullptr && parent->content.size() == 2));
  if (!whole) return damaged(box.name, "lacks its number, its parent or its transform");
  Bone out;
  out.id = static_cast<std::uint16_t>(little(id->content));
  if (skeleton) {
    const auto above = static_cast<std::uint16_t>(little(parent->content));
    if (above != kNoParent && above >= out.id)
      return damaged(box.name, "has a parent that comes behind it");
    out.parent = above == kNoParent ? -1 : above;
  }
  const auto real = [&](std::size_t index) {
    return static_cast<double>(
        std::bit_cast<float>(little(transform->content.substr(4 * index, 4))));
  };
  const auto rotation =
      sent_rotation("bone " + std::to_string(out.id), {real(3), real(0), real(1), real(2)});
  if (!rotation) return pass(rotation);
  out.in_parent = *rotation;
  return out;
}

Result<void> read_bones(const std::vector<Box>& parts, Packet& out) {
  const Box* const list = box_named(parts, out.skeleton ? "bons" : "btrs");
  if (list == nullptr) return damaged(out.skeleton ? "skdf" : "fram", "has no bones");
  const auto bones = boxes_of(list->name, list->content);
  if (!bones) return pass(bones);
  if (bones->size() > kMostBones)
    return fail(ErrorCode::TooLarge, "mocopi", "has more than 64 bones");
  for (const Box& box : *bones) {
    auto bone = bone_of(box, out.skeleton);
    if (!bone) return pass(bone);
    out.bones.push_back(*bone);
  }
  return {};
}

std::string boxed(std::string_view name, const std::string& content) {
  std::string out;
  for (int shift = 0; shift < 32; shift += 8)
    out.push_back(static_cast<char>(content.size() >> shift & 0xff));
  return out + std::string(name) + content;
}

template <class Number>
std::string little_bytes(Number value) {
  std::string out;
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
  return out;
}

std::string transform_bytes(const Eigen::Quaterniond& q) {
  std::string out;
  for (const double each : {q.x(), q.y(), q.z(), q.w(), 0.0, 0.0, 0.0})
    out += little_bytes(std::bit_cast<std::uint32_t>(static_cast<float>(each)));
  return out;
}

}  // namespace

Result<Packet> parse(std::string_view datagram) {
  if (datagram.size() > kMaxStreamDatagram)
    return fail(ErrorCode::TooLarge, "mocopi", "is longer than a datagram");
  const auto boxes = boxes_of("datagram", datagram);
  if (!boxes) return pass(boxes);
  const Box* const head = box_named(*boxes, "head");
  if (head == nullptr) return fail(ErrorCode::Malformed, "mocopi", "is no mocopi: no head");
  const auto in_head = boxes_of("head", head->content);
  if (!in_head) return pass(in_head);
  const Box* const format = box_named(*in_head, "ftyp");
  if (format == nullptr || format->content != kFormat)
    return fail(ErrorCode::Malformed, "mocopi", "is no mocopi: another format");
  const Box* const skeleton = box_named(*boxes, "skdf");
  const Box* const frame = box_named(*boxes, "fram");
  if (skeleton == nullptr && frame == nullptr) return Packet{};
  Packet out;
  out.skeleton = skeleton != nullptr;
  const auto parts =
      out.skeleton ? boxes_of("skdf", skeleton->content) : boxes_of("fram", frame->content);
  if (!parts) return pass(parts);
  const Box* const number = box_named(*parts, "fnum");
  if (number != nullptr && number->content.size() == 4) out.number = little(number->content);
  if (auto ok = read_bones(*parts, out); !ok) return pass(ok);
  return out;
}

std::string encode(const Packet& packet) {
  std::string bones;
  for (const Bone& bone : packet.bones) {
    std::string one = boxed("bnid", little_bytes(bone.id));
    if (packet.skeleton)
      one += boxed("pbid", little_bytes(bone.parent < 0 ? kNoParent
                                                        : static_cast<std::uint16_t>(bone.parent)));
    one += boxed("tran", transform_bytes(bone.in_parent));
    bones += boxed(packet.skeleton ? "bndt" : "btdt", one);
  }
  const std::string head =
      boxed("head", boxed("ftyp", std::string(kFormat)) + boxed("vrsn", std::string(1, '\1')));
  if (packet.skeleton) return head + boxed("skdf", boxed("bons", bones));
  return head + boxed("fram", boxed("fnum", little_bytes(packet.number)) + boxed("btrs", bones));
}

}  // namespace mocopi

namespace {

// clang-format off
constexpr std::array<SegmentRow, 27> kMocopi{{
  {"root", -1, Limb::Pelvis}, {"torso_1", 0, {}}, {"torso_2", 1, {}}, {"torso_3", 2, {}}, {"torso_4", 3, {}}, {"torso_5", 4, {}},
  {"torso_6", 5, {}}, {"torso_7", 6, Limb::Chest}, {"neck_1", 7, {}}, {"neck_2", 8, {}}, {"head", 9, Limb::Head},
  {"l_shoulder", 7, {}}, {"l_up_arm", 11, Limb::UpperArmLeft}, {"l_low_arm", 12, Limb::ForearmLeft}, {"l_hand", 13, Limb::HandLeft},
  {"r_shoulder", 7, {}}, {"r_up_arm", 15, Limb::UpperArmRight}, {"r_low_arm", 16, Limb::ForearmRight}, {"r_hand", 17, Limb::HandRight},
  {"l_up_leg", 0, Limb::ThighLeft}, {"l_low_leg", 19, Limb::ShankLeft}, {"l_foot", 20, Limb::FootLeft}, {"l_toes", 21, {}},
  {"r_up_leg", 0, Limb::ThighRight}, {"r_low_leg", 23, Limb::ShankRight}, {"r_foot", 24, Limb::FootRight}, {"r_toes", 25, {}}}};
// clang-format on

SegmentPoses mocopi_segments() {
  std::vector<Segment> segments;
  for (const SegmentRow& row : kMocopi)
    segments.push_back({std::string(row.name), row.parent, row.limb});
  return SegmentPoses(std::move(segments));
}

class MocopiReader final : public StreamReader {
 public:
  [[nodiscard]] Result<void> take(std::string_view bytes, Timestamp now) override {
    const auto packet = mocopi::parse(bytes);
    if (!packet) return pass(packet);
    for (const mocopi::Bone& bone : packet->bones) {
      if (bone.id >= poses_.size())
        return fail(ErrorCode::Malformed, "mocopi bone " + std::to_string(bone.id),
                    "is none of the 27");
      if (packet->skeleton) poses_.set_parent(bone.id, bone.parent);
    }
    if (packet->skeleton || packet->bones.empty()) return {};
    // A datagram that was sent twice; far back, the app began anew.
    constexpr std::uint32_t kAnew = 1000;
    if (number_ && packet->number <= *number_ && *number_ - packet->number < kAnew)
      return fail(ErrorCode::Malformed, "mocopi frame " + std::to_string(packet->number),
                  "is not newer than the last one");
    number_ = packet->number;
    for (const mocopi::Bone& bone : packet->bones) poses_.turn(bone.id, bone.in_parent, now);
    return {};
  }
  [[nodiscard]] std::optional<InertialFrame> instant(Timestamp now) override {
    return poses_.instant(now);
  }

 private:
  SegmentPoses poses_ = mocopi_segments();
  std::optional<std::uint32_t> number_;
};

}  // namespace

std::unique_ptr<StreamReader> make_mocopi_reader() { return std::make_unique<MocopiReader>(); }

}  // namespace chorus::inertial
