#include "common/synthetic/kinect/profile.h"

#include <array>
#include <functional>

#include <nlohmann/json.hpp>

#include "common/synthetic/draw.h"
#include "profiles_text.h"

namespace chorus::synthetic::kinect {
namespace {

enum class Unit { One, Degrees, Milliseconds, Millimetres, PartsPerMillion };

double in_our_units(double value, Unit unit) {
  switch (unit) {
    case Unit::One:
      return value;
    case Unit::Degrees:
      return deg(value);
    case Unit::Milliseconds:
      return value * 1e-3;
    case Unit::Millimetres:
      return mm(value);
    case Unit::PartsPerMillion:
      return value * 1e-6;
  }
  return value;
}

struct Binding {
  const char* key;
  Unit unit;
  double& (*field)(Profile&);
};

#define CHORUS_FIELD(member) [](Profile& p) -> double& { return p.member; }

// One row per entry of profiles.json; a test compares the two lists.
constexpr std::array kBindings{
    Binding{"view.half_width_deg", Unit::Degrees, CHORUS_FIELD(view.half_width)},
    Binding{"view.half_height_deg", Unit::Degrees, CHORUS_FIELD(view.half_height)},
    Binding{"view.margin_deg", Unit::Degrees, CHORUS_FIELD(view.margin)},
    Binding{"view.least_range_m", Unit::One, CHORUS_FIELD(view.least_range)},
    Binding{"view.most_range_m", Unit::One, CHORUS_FIELD(view.most_range)},
    Binding{"delivery.period_ms", Unit::Milliseconds, CHORUS_FIELD(delivery.period)},
    Binding{"delivery.jitter_ms", Unit::Milliseconds, CHORUS_FIELD(delivery.jitter)},
    Binding{"delivery.drop_share", Unit::One, CHORUS_FIELD(delivery.drop_share)},
    Binding{"delivery.gaps_per_minute", Unit::One, CHORUS_FIELD(delivery.gaps_per_minute)},
    Binding{"delivery.gap_least_s", Unit::One, CHORUS_FIELD(delivery.gap_least)},
    Binding{"delivery.gap_most_s", Unit::One, CHORUS_FIELD(delivery.gap_most)},
    Binding{"delivery.gap_block_s", Unit::One, CHORUS_FIELD(delivery.gap_block)},
    Binding{"delivery.slow_share", Unit::One, CHORUS_FIELD(delivery.slow_share)},
    Binding{"delivery.slow_s", Unit::One, CHORUS_FIELD(delivery.slow_time)},
    Binding{"delivery.latency_ms", Unit::Milliseconds, CHORUS_FIELD(delivery.latency)},
    Binding{"delivery.latency_jitter_ms", Unit::Milliseconds,
            CHORUS_FIELD(delivery.latency_jitter)},
    Binding{"visibility.rays", Unit::One, CHORUS_FIELD(visibility.rays)},
    Binding{"visibility.girth", Unit::One, CHORUS_FIELD(visibility.girth)},
    Binding{"visibility.fan_mm", Unit::Millimetres, CHORUS_FIELD(visibility.fan)},
    Binding{"visibility.skin_mm", Unit::Millimetres, CHORUS_FIELD(visibility.skin)},
    Binding{"visibility.inferred_visible", Unit::One, CHORUS_FIELD(visibility.inferred_visible)},
    Binding{"visibility.inferred_occluded", Unit::One, CHORUS_FIELD(visibility.inferred_occluded)},
    Binding{"visibility.notice_s", Unit::One, CHORUS_FIELD(visibility.notice)},
    Binding{"visibility.hidden_scale", Unit::One, CHORUS_FIELD(visibility.hidden_scale)},
    Binding{"visibility.hidden_depth", Unit::One, CHORUS_FIELD(visibility.hidden_depth)},
    Binding{"visibility.hidden_tau_s", Unit::One, CHORUS_FIELD(visibility.hidden_tau)},
    Binding{"visibility.state_hold_s", Unit::One, CHORUS_FIELD(visibility.state_hold)},
    Binding{"yaw.reliable_deg", Unit::Degrees, CHORUS_FIELD(yaw.reliable)},
    Binding{"yaw.shoulder_slope", Unit::One, CHORUS_FIELD(yaw.shoulder_slope)},
    Binding{"yaw.hip_slope", Unit::One, CHORUS_FIELD(yaw.hip_slope)},
    Binding{"yaw.flip_to_rear_deg", Unit::Degrees, CHORUS_FIELD(yaw.flip_to_rear)},
    Binding{"yaw.flip_to_front_deg", Unit::Degrees, CHORUS_FIELD(yaw.flip_to_front)},
    Binding{"yaw.flip_own_deg", Unit::Degrees, CHORUS_FIELD(yaw.flip_own)},
    Binding{"yaw.flip_back_own_deg", Unit::Degrees, CHORUS_FIELD(yaw.flip_back_own)},
    Binding{"yaw.flip_s", Unit::One, CHORUS_FIELD(yaw.flip_time)},
    Binding{"bias.core_mm", Unit::Millimetres, CHORUS_FIELD(bias.core)},
    Binding{"bias.head_forward_mm", Unit::Millimetres, CHORUS_FIELD(bias.head_forward)},
    Binding{"bias.hip_radial_mm", Unit::Millimetres, CHORUS_FIELD(bias.hip_radial)},
    Binding{"bias.vertical_mm", Unit::Millimetres, CHORUS_FIELD(bias.vertical)},
    Binding{"bias.limb_factor", Unit::One, CHORUS_FIELD(bias.limb_factor)},
    Binding{"bias.common_share", Unit::One, CHORUS_FIELD(bias.common_share)},
    Binding{"bias.neck_factor", Unit::One, CHORUS_FIELD(bias.neck_factor)},
    Binding{"bias.follow_share", Unit::One, CHORUS_FIELD(bias.follow_share)},
    Binding{"bias.harmonic", Unit::One, CHORUS_FIELD(bias.harmonic)},
    Binding{"bias.head_from_deg", Unit::Degrees, CHORUS_FIELD(bias.head_from)},
    Binding{"bias.head_width_deg", Unit::Degrees, CHORUS_FIELD(bias.head_width)},
    Binding{"bias.hip_from_deg", Unit::Degrees, CHORUS_FIELD(bias.hip_from)},
    Binding{"bias.hip_width_deg", Unit::Degrees, CHORUS_FIELD(bias.hip_width)},
    Binding{"coloured.core_tau_s", Unit::One, CHORUS_FIELD(coloured.core_tau)},
    Binding{"coloured.limb_tau_s", Unit::One, CHORUS_FIELD(coloured.limb_tau)},
    Binding{"coloured.foot_tau_s", Unit::One, CHORUS_FIELD(coloured.foot_tau)},
    Binding{"coloured.moving_speed_m_s", Unit::One, CHORUS_FIELD(coloured.moving_speed)},
    Binding{"coloured.rest_share", Unit::One, CHORUS_FIELD(coloured.rest_share)},
    Binding{"coloured.shared_cell_m", Unit::One, CHORUS_FIELD(coloured.shared_cell)},
    Binding{"coloured.scale", Unit::One, CHORUS_FIELD(coloured.scale)},
    Binding{"coloured.depth_factor", Unit::One, CHORUS_FIELD(coloured.depth_factor)},
    Binding{"coloured.turn_growth", Unit::One, CHORUS_FIELD(coloured.turn_growth)},
    Binding{"coloured.distance_growth", Unit::One, CHORUS_FIELD(coloured.distance_growth)},
    Binding{"coloured.inferred_factor", Unit::One, CHORUS_FIELD(coloured.inferred_factor)},
    Binding{"coloured.inferred_least_mm", Unit::Millimetres, CHORUS_FIELD(coloured.inferred_least)},
    Binding{"coloured.inferred_pull", Unit::One, CHORUS_FIELD(coloured.inferred_pull)},
    Binding{"coloured.core_correlation", Unit::One, CHORUS_FIELD(coloured.core_correlation)},
    Binding{"coloured.follow_share", Unit::One, CHORUS_FIELD(coloured.follow_share)},
    Binding{"coloured.sensor_correlation", Unit::One, CHORUS_FIELD(coloured.sensor_correlation)},
    Binding{"coloured.neck_correlation", Unit::One, CHORUS_FIELD(coloured.neck_correlation)},
    Binding{"coloured.view_twice", Unit::One, CHORUS_FIELD(coloured.view_twice)},
    Binding{"coloured.best_distance_m", Unit::One, CHORUS_FIELD(coloured.best_distance)},
    Binding{"coloured.good_depth_m", Unit::One, CHORUS_FIELD(coloured.good_depth)},
    Binding{"coloured.student_nu", Unit::One, CHORUS_FIELD(coloured.student_nu)},
    Binding{"coloured.tail_s", Unit::One, CHORUS_FIELD(coloured.tail_time)},
    Binding{"coloured.most_tail", Unit::One, CHORUS_FIELD(coloured.most_tail)},
    Binding{"white.scale", Unit::One, CHORUS_FIELD(white_scale)},
    Binding{"white.inferred_mm", Unit::Millimetres, CHORUS_FIELD(white_inferred)},
    Binding{"fit.bones", Unit::One, CHORUS_FIELD(fit.bones)},
    Binding{"fit.scale", Unit::One, CHORUS_FIELD(fit.scale)},
    Binding{"fit.scale_tau_s", Unit::One, CHORUS_FIELD(fit.scale_tau)},
    Binding{"fit.scale_white", Unit::One, CHORUS_FIELD(fit.scale_white)},
    Binding{"fit.proportion", Unit::One, CHORUS_FIELD(fit.proportion)},
    Binding{"gross.teleports_per_joint_s", Unit::One, CHORUS_FIELD(gross.teleports)},
    Binding{"gross.teleport_m", Unit::One, CHORUS_FIELD(gross.teleport_size)},
    Binding{"gross.teleport_s", Unit::One, CHORUS_FIELD(gross.teleport_time)},
    Binding{"gross.ghosts_per_minute", Unit::One, CHORUS_FIELD(gross.ghosts_per_minute)},
    Binding{"gross.ghost_s", Unit::One, CHORUS_FIELD(gross.ghost_time)},
    Binding{"gross.ghost_aside_m", Unit::One, CHORUS_FIELD(gross.ghost_aside)},
    Binding{"gross.ghost_near_m", Unit::One, CHORUS_FIELD(gross.ghost_near)},
    Binding{"gross.ghost_far_m", Unit::One, CHORUS_FIELD(gross.ghost_far)},
    Binding{"gross.ghost_below_m", Unit::One, CHORUS_FIELD(gross.ghost_below)},
    Binding{"gross.ghost_limb_m", Unit::One, CHORUS_FIELD(gross.ghost_limb)},
    Binding{"gross.ghost_joint_m", Unit::One, CHORUS_FIELD(gross.ghost_joint)},
    Binding{"gross.id_swap_per_contact", Unit::One, CHORUS_FIELD(gross.id_swap)},
    Binding{"gross.contact_m", Unit::One, CHORUS_FIELD(gross.contact)},
    Binding{"gross.leg_merge", Unit::One, CHORUS_FIELD(gross.leg_merge)},
    Binding{"gross.merge_angle_deg", Unit::Degrees, CHORUS_FIELD(gross.merge_angle)},
    Binding{"clock.offset_ms", Unit::Milliseconds, CHORUS_FIELD(clock.offset)},
    Binding{"clock.drift_ppm", Unit::PartsPerMillion, CHORUS_FIELD(clock.drift)},
    Binding{"clock.step_ms", Unit::Milliseconds, CHORUS_FIELD(clock.step)},
    Binding{"clock.step_chance", Unit::One, CHORUS_FIELD(clock.step_chance)},
    Binding{"clock.step_within_s", Unit::One, CHORUS_FIELD(clock.step_within)},
    Binding{"floor.tilt_deg", Unit::Degrees, CHORUS_FIELD(floor.tilt)},
    Binding{"floor.tilt_now_deg", Unit::Degrees, CHORUS_FIELD(floor.tilt_now)},
    Binding{"floor.offset_mm", Unit::Millimetres, CHORUS_FIELD(floor.offset)},
    Binding{"floor.offset_now_mm", Unit::Millimetres, CHORUS_FIELD(floor.offset_now)},
};
#undef CHORUS_FIELD

const nlohmann::json& parameters() {
  // The text is part of the program and read by a test; it cannot fail at run time.
  static const nlohmann::json parsed = nlohmann::json::parse(kProfilesText, nullptr, true, true);
  return parsed;
}

/// Fills every field; `scale(spread)` gives the factor on a nominal value.
Profile filled(std::string_view name, const std::function<double(double)>& scale) {
  Profile profile;
  profile.name = name;
  for (const Binding& binding : kBindings) {
    const nlohmann::json& entry = parameters().at(binding.key);
    const double nominal = entry.at(std::string(name)).get<double>();
    const double spread = entry.at("spread").get<double>();
    binding.field(profile) = in_our_units(nominal * scale(spread), binding.unit);
  }
  return profile;
}

}  // namespace

Profile nominal_profile(std::string_view name) {
  return filled(name, [](double) { return 1.0; });
}

Profile draw_profile(std::string_view name, std::uint64_t seed) {
  constexpr std::uint64_t kPurpose = 901;
  Draw draw{seed, kPurpose};
  return filled(name, [&draw](double spread) { return 1.0 + draw.uniform(-spread, spread); });
}

std::vector<Parameter> parameters_of(Profile profile) {
  std::vector<Parameter> all;
  for (const Binding& binding : kBindings) all.push_back({binding.key, binding.field(profile)});
  return all;
}

std::string frozen_hash() { return kProfilesHash; }

}  // namespace chorus::synthetic::kinect
