#include "common/exporters/sto.h"

#include <array>
#include <cmath>

#include "common/evaluation/limb_frame.h"
#include "common/inertial/orientation_table.h"

namespace chorus::exporters {
namespace {

using inertial::InertialFrame;
using inertial::InertialReading;
using inertial::kLimbCount;
using inertial::Limb;

// clang-format off
constexpr std::array<std::string_view, kLimbCount> kOpenSenseNames{
  "pelvis_imu", "torso_imu", "head_imu",
  "humerus_l_imu", "radius_l_imu", "hand_l_imu",
  "humerus_r_imu", "radius_r_imu", "hand_r_imu",
  "femur_l_imu", "tibia_l_imu", "calcn_l_imu",
  "femur_r_imu", "tibia_r_imu", "calcn_r_imu"};
// clang-format on

std::array<bool, kLimbCount> often_seen(const PersonTrack& track) {
  std::array<bool, kLimbCount> out{};
  for (std::size_t i = 0; i < kLimbCount; ++i) {
    std::size_t seen = 0;
    for (const Pose& pose : track.poses)
      seen += evaluation::limb_from_joints(pose.skeleton, static_cast<Limb>(i)) ? 1 : 0;
    out[i] = seen > 0 && 2 * seen >= track.poses.size();
  }
  return out;
}

}  // namespace

Result<std::string> sto_of(const PersonTrack& track, double rate_hz) {
  const auto wanted = often_seen(track);
  std::vector<InertialFrame> frames;
  for (std::size_t k = 0; k < track.poses.size(); ++k) {
    InertialFrame& frame = frames.emplace_back();
    frame.captured = from_unix_ns(std::llround(1e9 * static_cast<double>(k) / rate_hz));
    for (std::size_t i = 0; i < kLimbCount; ++i) {
      const auto limb = evaluation::limb_from_joints(track.poses[k].skeleton, static_cast<Limb>(i));
      if (!wanted[i] || !limb) continue;
      InertialReading& reading = frame.readings.emplace_back();
      reading.sensor = kOpenSenseNames[i];
      reading.inertial_from_sensor = limb->world_from_limb;
    }
  }
  for (const bool any : wanted)
    if (any) return inertial::write_orientation_table(frames);
  return fail(ErrorCode::Unsupported, "fused frames",
              "show no limb's orientation in half of the time; .sto holds nothing else");
}

}  // namespace chorus::exporters
