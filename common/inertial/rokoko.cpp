#include "common/inertial/rokoko.h"

#include <array>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "common/inertial/lz4_frame.h"
#include "common/inertial/segment_poses.h"

namespace chorus::inertial {
namespace {

using nlohmann::json;

struct RokokoRow {
  std::string_view name;   ///< Version 3.
  std::string_view older;  ///< Version 2.
  Limb limb;
};
// clang-format off
constexpr std::array<RokokoRow, 15> kRokoko{{
  {"hip", "hip", Limb::Pelvis}, {"chest", "chest", Limb::Chest}, {"head", "head", Limb::Head},
  {"leftUpperArm", "leftArm", Limb::UpperArmLeft}, {"leftLowerArm", "leftForearm", Limb::ForearmLeft}, {"leftHand", "leftHand", Limb::HandLeft},
  {"rightUpperArm", "rightArm", Limb::UpperArmRight}, {"rightLowerArm", "rightForearm", Limb::ForearmRight}, {"rightHand", "rightHand", Limb::HandRight},
  {"leftUpLeg", "leftUpleg", Limb::ThighLeft}, {"leftLeg", "leftLeg", Limb::ShankLeft}, {"leftFoot", "leftFoot", Limb::FootLeft},
  {"rightUpLeg", "rightUpleg", Limb::ThighRight}, {"rightLeg", "rightLeg", Limb::ShankRight}, {"rightFoot", "rightFoot", Limb::FootRight}}};
// clang-format on

SegmentPoses rokoko_segments() {
  std::vector<Segment> segments;
  for (const RokokoRow& row : kRokoko) segments.push_back({std::string(row.name), -1, row.limb});
  return SegmentPoses(std::move(segments));
}

/// Unpacked: a scene of several people with hands and faces takes some hundred kB.
constexpr std::size_t kMostText = 4U << 20;

tl::unexpected<Error> not_rokoko(std::string what) {
  return fail(ErrorCode::Malformed, "Rokoko", std::move(what));
}

const json* member(const json& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

/// 3 of "3,0", "3.0" or 3; 0 if there is none.
int version_of(const json& document) {
  const json* const version = member(document, "version");
  if (version == nullptr) return 0;
  if (version->is_number()) {
    const double number = version->get<double>();
    return number >= 0.0 && number < 100.0 ? static_cast<int>(number) : 0;
  }
  return version->is_string() ? std::atoi(version->get_ref<const std::string&>().c_str()) : 0;
}

/// The list of people; Studio's "2.5" says 3 and is 2: it has trackers.
const json* actors_of(const json& document) {
  if (version_of(document) >= 3 && member(document, "trackers") == nullptr) {
    const json* const scene = member(document, "scene");
    return scene == nullptr ? nullptr : member(*scene, "actors");
  }
  return version_of(document) >= 2 ? member(document, "actors") : nullptr;
}

std::optional<double> number_in(const json& object, std::string_view key) {
  const json* const value = member(object, key);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

class RokokoReader final : public StreamReader {
 public:
  explicit RokokoReader(std::string actor) : actor_(std::move(actor)) {}

  [[nodiscard]] Result<void> take(std::string_view bytes, Timestamp now) override {
    if (bytes.size() > kMaxStreamDatagram)
      return fail(ErrorCode::TooLarge, "Rokoko", "is longer than a datagram");
    if (!is_lz4_frame(bytes)) return take_text(bytes, now);
    const auto text = unpacked_lz4(bytes, kMostText);
    if (!text) return fail(text.error().code, "Rokoko", to_string(text.error()));
    return take_text(*text, now);
  }
  [[nodiscard]] std::optional<InertialFrame> instant(Timestamp now) override {
    return poses_.instant(now);
  }

 private:
  Result<void> take_text(std::string_view bytes, Timestamp now) {
    const json document = json::parse(bytes, nullptr, false);
    if (document.is_discarded()) return not_rokoko("is no JSON");
    const json* const actors = actors_of(document);
    if (actors == nullptr || !actors->is_array())
      return not_rokoko("has no actors, or a version other than 2 and 3");
    const json* const body = body_of(*actors);
    if (body == nullptr) return not_rokoko("has no actor named \"" + actor_ + "\"");
    for (std::size_t i = 0; i < kRokoko.size(); ++i)
      if (auto ok = take_bone(*body, i, now); !ok) return ok;
    return {};
  }

  /// Where the bones of the actor are.
  [[nodiscard]] const json* body_of(const json& actors) const {
    for (const json& actor : actors) {
      const json* const name = member(actor, "name");
      const bool ours =
          name != nullptr && name->is_string() && name->get_ref<const std::string&>() == actor_;
      if (!actor_.empty() && !ours) continue;
      const json* const body = member(actor, "body");
      return body != nullptr ? body : &actor;
    }
    return nullptr;
  }

  Result<void> take_bone(const json& body, std::size_t i, Timestamp now) {
    const json* bone = member(body, kRokoko[i].name);
    if (bone == nullptr) bone = member(body, kRokoko[i].older);
    if (bone == nullptr || bone->is_null()) return {};  // A suit with fewer sensors.
    const json* const rotation = member(*bone, "rotation");
    const json none;
    const json& sent = rotation == nullptr ? none : *rotation;
    const auto x = number_in(sent, "x"), y = number_in(sent, "y"), z = number_in(sent, "z"),
               w = number_in(sent, "w");
    if (!x || !y || !z || !w)
      return fail(ErrorCode::Malformed, "Rokoko segment " + std::string(kRokoko[i].name),
                  "has no rotation of x, y, z, w");
    const auto turned = sent_rotation(kRokoko[i].name, {*w, *x, *y, *z});
    if (!turned) return pass(turned);
    poses_.turn(i, from_unity(*turned), now);
    return {};
  }

  std::string actor_;
  SegmentPoses poses_ = rokoko_segments();
};

}  // namespace

std::unique_ptr<StreamReader> make_rokoko_reader(std::string actor) {
  return std::make_unique<RokokoReader>(std::move(actor));
}

}  // namespace chorus::inertial
