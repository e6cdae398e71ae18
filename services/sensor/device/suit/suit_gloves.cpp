#include "services/sensor/device/suit/suit_gloves.h"

#include <utility>

#include "common/base/file.h"
#include "common/hand/hand_json.h"

namespace chorus::suit {
namespace {

constexpr std::uintmax_t kMostHandBytes = 1 << 20;
constexpr std::uintmax_t kMostTakeBytes = 1 << 28;

tl::unexpected<Error> at_key(const std::string& key, const Error& error) {
  return fail(error.code, "gloves." + key, error.context + ": " + error.message);
}

Result<hand::CarriedHand> open_glove(const GloveFiles& files, const std::string& suit_file) {
  const auto text = read_file(files.hand, kMostHandBytes);
  if (!text) return at_key("hand", text.error());
  const auto skeleton = hand::read_skeleton(*text);
  if (!skeleton) return at_key("hand", skeleton.error());
  const std::string& take_file = files.take.empty() ? suit_file : files.take;
  if (take_file.empty())
    return fail(ErrorCode::InvalidArgument, "gloves.take",
                "is missing: a .bvh that says how the hand is held (a stream has no fingers)");
  const auto take_text = read_file(take_file, kMostTakeBytes);
  if (!take_text) return at_key("take", take_text.error());
  auto take = hand::read_glove_take(*take_text, take_file, skeleton->side);
  if (!take) return at_key("take", take.error());
  return hand::CarriedHand(*skeleton, std::move(*take));
}

}  // namespace

Result<SuitGloves> SuitGloves::open(const SuitSettings& settings) {
  SuitGloves out;
  out.filed_ = !settings.file.empty();
  for (const GloveFiles& files : settings.gloves) {
    auto glove = open_glove(files, settings.file);
    if (!glove) return pass(glove);
    for (const hand::CarriedHand& other : out.gloves_) {
      if (other.side() == glove->side())
        return fail(ErrorCode::Conflict, "gloves",
                    "names two " + std::string(name_of(glove->side())) + " hands");
    }
    out.gloves_.push_back(std::move(*glove));
  }
  return out;
}

/// Beside a stream a take loops; its rounds begin at whole multiples of its length since 1970, as
/// those of the device `glove` do.
double SuitGloves::seconds_in(const hand::CarriedHand& glove, const SuitInstant& instant) const {
  if (filed_) return seconds(instant.pose.time);
  const Duration length = std::max(from_seconds(glove.length_s()), Duration{1});
  return seconds(instant.captured.time_since_epoch() % length);
}

}  // namespace chorus::suit
