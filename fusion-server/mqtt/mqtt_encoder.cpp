#include "fusion-server/mqtt/mqtt_encoder.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/body/bones.h"

namespace chorus::mqtt {
namespace {

void append_joint(std::string& out, std::string_view name, const outlet::TrackerJoint& joint) {
  const Eigen::Vector3d& p = joint.position;
  out += fmt::format(R"({}"{}": {{"place": [{:.5f}, {:.5f}, {:.5f}])",
                     out.ends_with('{') ? "" : ", ", name, p.x(), p.y(), p.z());
  const Eigen::Quaterniond& q = joint.orientation;
  if (joint.oriented)
    out += fmt::format(R"(, "orientation": [{:.5f}, {:.5f}, {:.5f}, {:.5f}])", q.x(), q.y(), q.z(),
                       q.w());
  out += '}';
}

}  // namespace

std::string encode(const outlet::TrackerFrame& frame, const outlet::TrackerBody& body) {
  std::string out =
      fmt::format(R"({{"id": {}, "slot": {}, "sequence": {}, "at": "{}", "joints": {{)",
                  body.person.value, body.slot, frame.sequence, to_unix_ns(frame.instant));
  for (std::size_t i = 0; i < kJointCount; ++i)
    if (body.joints[i].tracked) append_joint(out, kJointNames[i], body.joints[i]);
  return out + "}}";
}

std::string person_topic(std::string_view prefix, PersonId person) {
  return fmt::format("{}/people/{}", prefix, person.value);
}

std::string status_topic(std::string_view prefix) { return fmt::format("{}/status", prefix); }

bool is_topic(std::string_view prefix) {
  constexpr std::size_t kLongest = 256;
  const auto bad = [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '#' || c == '+'; };
  return !prefix.empty() && prefix.size() <= kLongest && std::ranges::none_of(prefix, bad) &&
         !prefix.starts_with('/') && !prefix.ends_with('/') && !prefix.starts_with('$') &&
         prefix.find("//") == std::string_view::npos;
}

}  // namespace chorus::mqtt
