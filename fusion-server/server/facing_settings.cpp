#include "fusion-server/server/facing_settings.h"

namespace chorus::server {
namespace {

using std::chrono::milliseconds;

constexpr double kMaxLogOdds = 20.0;
constexpr double kMaxRate = 100.0;   // [1/s]
constexpr double kMaxTime = 3600.0;  // [s]

void read_cue(ConfigReader reader, facing::Cue& out) {
  reader.read("log_odds", out.log_odds, -kMaxLogOdds, kMaxLogOdds);
  reader.read("full_at", out.at, 1e-3, 10.0);
}

void read_posture(ConfigReader reader, facing::PostureCues& out) {
  read_cue(reader.child("knees"), out.knees);
  read_cue(reader.child("wrists"), out.wrists);
  read_cue(reader.child("elbows"), out.elbows);
  read_cue(reader.child("lean"), out.lean);
  read_cue(reader.child("hidden_arms"), out.hidden);
  read_cue(reader.child("feet"), out.feet);
  reader.read("same_s", out.same, 0.01, kMaxTime);
}

void read_walking(ConfigReader reader, facing::WalkingCue& out) {
  reader.read("log_odds", out.log_odds, 0.0, kMaxLogOdds);
  reader.read("from_m_s", out.from, 0.0, 10.0);
  reader.read("full_m_s", out.full, 0.0, 10.0);
  reader.read("smoothing_s", out.smoothing, 0.0, 10.0);
  reader.read("same_s", out.same, 0.01, kMaxTime);
  reader.read("level_share", out.level, 0.0, 10.0);
  reader.read("steep_share", out.steep, 0.01, 10.0);
  if (out.steep <= out.level) reader.complain("steep_share", "must be above level_share");
  if (out.full <= out.from) reader.complain("full_m_s", "must be above from_m_s");
}

void read_upright(ConfigReader reader, facing::UprightRange& out) {
  reader.read_deg("full_deg", out.full, 0.0, 180.0);
  reader.read_deg("none_deg", out.none, 1.0, 180.0);
  if (out.none <= out.full) reader.complain("none_deg", "must be above full_deg");
}

void read_spell(ConfigReader reader, facing::Spell& out) {
  reader.read("share", out.share, 1e-6, 0.5);
  reader.read("length_s", out.length, 0.01, kMaxTime);
}

void read_habit(ConfigReader reader, facing::HabitPrior& out) {
  reader.read("front_out_per_s", out.front_out, 1e-6, kMaxRate);
  reader.read("front_back_per_s", out.front_back, 1e-6, kMaxRate);
  reader.read("side_out_per_s", out.side_out, 1e-6, kMaxRate);
  reader.read("side_back_per_s", out.side_back, 1e-6, kMaxRate);
  reader.read("rear_per_s", out.rear, 1e-6, kMaxRate);
  reader.read("facing_time_s", out.facing_time, 1e-3, kMaxTime);
  reader.read("rear_time_s", out.rear_time, 1e-3, kMaxTime);
  reader.read("most_time_s", out.most_time, 1.0, 24 * kMaxTime);
}

void read_telling(ConfigReader reader, facing::TellingPrior& out) {
  reader.read_deg("from_deg", out.from, 90.0, 180.0);
  reader.read("log_odds", out.log_odds, 0.0, kMaxLogOdds);
  reader.read("time_s", out.time, 1e-3, kMaxTime);
  reader.read("limit_log_odds", out.limit, 0.0, kMaxLogOdds);
  reader.read("mistaken_share", out.mistaken, 1e-3, 0.49);
  reader.read("same_s", out.same, 1e-3, kMaxTime);
}

void read_limbs(ConfigReader reader, facing::LimbLimits& out) {
  reader.read("mend", out.mend);
  reader.read("apart_m", out.apart, 0.01, 1.0);
  reader.read("better_share", out.better, 0.0, 1.0);
}

}  // namespace

void read_facing(ConfigReader reader, facing::SidesConfig& out) {
  reader.read("resolve_sides", out.resolve);
  std::size_t by = static_cast<std::size_t>(out.by);
  reader.read_choice("by", by, {"evidence", "shoulders"});
  out.by = by == 0 ? facing::SidesBy::Evidence : facing::SidesBy::Shoulders;
  read_posture(reader.child("posture"), out.posture);
  read_walking(reader.child("walking"), out.walking);
  read_upright(reader.child("upright"), out.upright);
  read_spell(reader.child("backwards"), out.person.backwards);
  reader.read("slip_per_s", out.person.slip, 0.0, kMaxRate);
  reader.read("lost_per_s", out.person.lost, 0.0, kMaxRate);
  read_habit(reader.child("habit"), out.habit);
  read_telling(reader.child("telling"), out.telling);
  read_limbs(reader.child("limbs"), out.limbs);
  reader.read("change_log_odds", out.change_odds, 0.0, kMaxLogOdds);
  reader.read_deg("turn_sigma_deg", out.turn_sigma, 10.0, 90.0);
  reader.read("smoothing_s", out.smoothing, 0.0, 10.0);
  reader.read("learn_from", out.learn_from, 0.5, 1.0);
  reader.read_s("forget_s", out.forget, milliseconds(1), std::chrono::seconds(60));
}

}  // namespace chorus::server
