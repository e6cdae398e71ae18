#include "fusion-server/server/fusion_settings.h"

#include <array>
#include <limits>
#include <set>
#include <utility>

#include "common/base/config_reader.h"
#include "common/client/follow_config.h"
#include "common/http/client.h"
#include "common/sensor/limits.h"
#include "common/service/http_config.h"
#include "fusion-server/learn/error_file.h"
#include "fusion-server/server/facing_settings.h"
#include "fusion-server/wire/session_limits.h"

namespace chorus::server {
namespace {

using std::chrono::milliseconds;

void read_noise(ConfigReader& reader, fusion::NoiseModel& out) {
  reader.read("along_m", out.along, 1e-4, 1.0);
  reader.read("across_m", out.across, 1e-4, 1.0);
  reader.read("inferred_factor", out.inferred_factor, 1.0, 100.0);
  reader.read_deg("ray_deg", out.ray, 0.01, 45.0);
}

/// The learned errors in a file; none for "".
void read_errors(ConfigReader& reader, fusion::SharedPredictor& out) {
  std::string file;
  reader.read("errors", file);
  if (file.empty()) return;
  auto predictor = learn::load_predictor(file);
  if (!predictor) return reader.complain("errors", to_string(predictor.error()));
  out = std::move(*predictor);
}

struct SensorReading {
  LiveSettings& out;
  const tls::Trust& trust;
  std::set<SensorId> known = {};
};

void read_sensor(ConfigReader& reader, SensorReading& reading) {
  LiveSettings& out = reading.out;
  auto sensor = client::read_followed(reader, reading.trust);
  if (!sensor) return;
  const SensorId id = sensor->id;
  if (!reading.known.insert(id).second)
    return reader.complain("id", "is the id of another sensor too");
  if (reader.has("noise")) {
    fusion::NoiseModel noise = out.pipeline.fusion.noise;
    ConfigReader child = reader.child("noise");
    read_noise(child, noise);
    out.pipeline.fusion.sensor_noise[id] = noise;
  }
  if (reader.has("errors")) read_errors(reader, out.pipeline.fusion.sensor_errors[id]);
  out.sensors.push_back(std::move(*sensor));
}

void read_sensors(ConfigReader& root, const tls::Trust& trust, LiveSettings& out) {
  SensorReading reading{out, trust};
  for (ConfigReader& reader : root.items("sensors")) read_sensor(reader, reading);
  if (out.sensors.size() > kMaxSensors) {
    root.complain("sensors", "at most " + std::to_string(kMaxSensors) + " are possible");
  }
}

void read_output(ConfigReader reader, FusionSettings& out) {
  reader.read("rate_hz", out.live.output.rate_hz, 1, 240);
  reader.read_ms("alignment_delay_ms", out.live.output.alignment_delay, milliseconds(0),
                 std::chrono::seconds(2));
  reader.read_s("history_s", out.at_start.history, std::chrono::seconds(1),
                std::chrono::seconds(120));
}

void read_align(ConfigReader reader, align::AlignConfig& out) {
  reader.read_ms("max_gap_ms", out.max_gap, milliseconds(1), std::chrono::seconds(2));
  reader.read_ms("patience_ms", out.patience, milliseconds(1), std::chrono::seconds(5));
  reader.read_ms("unsteady_ms", out.unsteady, milliseconds(0), std::chrono::seconds(5));
  reader.read_ms("slowest_ms", out.slowest, milliseconds(0), std::chrono::seconds(3));
  reader.read("max_speed_m_s", out.max_speed, 0.1, 1000.0);
}

void read_quality(ConfigReader reader, fusion::QualityLimits& out) {
  reader.read("best_distance_m", out.best_distance, 0.1, 20.0);
  reader.read("distance_reach_m", out.distance_reach, 0.1, 20.0);
  reader.read_deg("max_facing_deg", out.max_facing, 1.0, 180.0);
  reader.read_deg("max_bearing_deg", out.max_bearing, 1.0, 180.0);
  auto bearing_of = static_cast<std::size_t>(out.bearing_of);
  reader.read_choice("bearing_of", bearing_of, {"neck", "centre-axis"});
  out.bearing_of = static_cast<fusion::BearingOf>(bearing_of);
}

/// A key that is no longer read, and what to say instead of it.
void refuse_gone(ConfigReader& reader, std::string_view key, std::string_view instead) {
  if (!reader.has(key)) return;
  double unused = 0.0;
  reader.read(key, unused, std::numeric_limits<double>::lowest(),
              std::numeric_limits<double>::max());
  reader.complain(key, "is no longer read, take it out: " + std::string(instead));
}

void read_association(ConfigReader reader, associate::AssociationConfig& out) {
  for (const char* key : {"alone_s", "motionless_s", "look_angle_deg", "look_range_m"})
    refuse_gone(reader, key, "association.doubt_s says how long a newcomer is doubted");
  reader.read("gate_m", out.gate, 0.05, 10.0);
  reader.read("gate_growth_m_s", out.gate_growth, 0.0, 10.0);
  reader.read("cluster_m", out.cluster, 0.05, 10.0);
  reader.read("ray_cluster_m", out.ray_cluster, 0.001, 10.0);
  reader.read("confirm_frames", out.confirm_frames, 1, 1000);
  reader.read_s("coast_s", out.coast, std::chrono::seconds(0), std::chrono::seconds(60));
  reader.read_s("carry_s", out.carry, std::chrono::seconds(0), std::chrono::seconds(60));
  reader.read_s("slow_down_s", out.slow_down, std::chrono::seconds(0), std::chrono::seconds(60));
  reader.read_s("remember_s", out.remember, std::chrono::seconds(0), std::chrono::seconds(3600));
  reader.read("merge_frames", out.merge_frames, 1, 1000);
  reader.read_s("doubt_s", out.doubt, std::chrono::seconds(0), std::chrono::seconds(60));
  reader.read("max_range_m", out.bodies.max_range, 1.0, 1000.0);
  reader.read_s("frozen_s", out.bodies.max_frozen, std::chrono::seconds(0),
                std::chrono::seconds(3600));
}

void read_pose_error(ConfigReader reader, fusion::PoseError& out) {
  reader.read("neck_m", out.neck, 0.0, 1.0);
  reader.read("trunk_m", out.trunk, 0.0, 1.0);
  reader.read("girdle_m", out.girdle, 0.0, 1.0);
  reader.read("elbow_knee_m", out.middle, 0.0, 1.0);
  reader.read("wrist_ankle_m", out.end, 0.0, 1.0);
  reader.read("tip_m", out.tip, 0.0, 1.0);
  reader.read("inferred_factor", out.inferred_factor, 1.0, 100.0);
}

void read_body(ConfigReader reader, fusion::BodyModel& out) {
  reader.read("scale", out.scale, 0.0, 0.5);
  reader.read_deg("turn_deg", out.turn, 0.0, 90.0);
  reader.read_deg("turn_from_deg", out.turn_from, 0.0, 90.0);
  reader.read_deg("turn_full_deg", out.turn_full, 0.0, 90.0);
  reader.read("turn_doubt_m_per_rad", out.turn_doubt, 0.0, 10.0);
  reader.read("bone_m", out.bone, 0.0, 1.0);
  reader.read_s("bone_memory_s", out.bone_memory, std::chrono::seconds(1),
                std::chrono::seconds(3600));
  reader.read("limb_end", out.limb_end, 0.0, 10.0);
  reader.read("bias_rate_hz", out.bias_rate, 0.0, 30.0);
  reader.read_ms("bias_memory_ms", out.bias_memory, milliseconds(1), std::chrono::seconds(10));
  reader.read_deg("bias_turn_deg", out.bias_turn, 1.0, 360.0);
  reader.read_ms("handover_ms", out.handover, milliseconds(0), std::chrono::seconds(10));
  reader.read("leap_m", out.leap, 0.0, 10.0);
  reader.read("pose", out.pose, 0.0, 10.0);
  reader.read("inferred_factor", out.inferred, 1.0, 100.0);
  reader.read("huber", out.huber, 0.0, 100.0);
  reader.read("resting_m2_s3", out.resting, 0.0, 1000.0);
  reader.read("moving_m2_s3", out.moving, 1e-3, 1e4);
  reader.read("limb", out.limb, 0.1, 100.0);
  reader.read("white", out.white, 1e-3, 1.0);
  reader.read("proportion", out.proportion, 0.0, 10.0);
  reader.read("disagreement", out.disagreement, 0.0, 10.0);
  reader.read("common_m", out.common, 0.0, 1.0);
  reader.read_ms("carry_ms", out.carry, milliseconds(0), std::chrono::seconds(1));
}

/// What is learned of worn sensors, and how they steer bodies: one switch for both.
void read_worn(ConfigReader reader, LiveSettings& out) {
  fusion::InertialModel& model = out.pipeline.fusion.inertial;
  reader.read("enabled", model.enabled);
  out.worn.enabled = model.enabled;
  reader.read("gate", model.gate, 0.5, 100.0);
  reader.read_ms("hidden_ms", model.hidden, milliseconds(1), std::chrono::seconds(60));
  reader.read_ms("handback_ms", model.handback, milliseconds(1), std::chrono::seconds(10));
  reader.read_deg("most_sigma_deg", model.most_sigma, 1.0, 90.0);
  out.worn.most_sigma = model.most_sigma;
  reader.read_deg("heading_walk_deg", out.worn.heading_walk, 0.0, 30.0);
  reader.read_deg("slip_deg", out.worn.slip, 1.0, 90.0);
  reader.read_deg("most_prediction_deg", out.worn.most_prediction, 1.0, 90.0);
}

void read_fusion(ConfigReader reader, fusion::FusionConfig& out) {
  std::vector<std::string_view> names;
  for (const fusion::MethodRow& row : fusion::methods()) names.push_back(row.name);
  std::size_t chosen = names.size();
  reader.read_choice("method", chosen, names);
  if (chosen < names.size()) out.method = fusion::methods()[chosen].method;
  reader.read("zero_weight_floor", out.zero_weight_floor, 0.0, 1.0);
  reader.read("common_sigma_m", out.common_sigma, 0.0, 1.0);
  reader.read("huber", out.huber, 0.1, 100.0);
  reader.read_ms("hysteresis_ms", out.hysteresis, milliseconds(0), std::chrono::seconds(10));
  reader.read("kalman_sigma_m", out.kalman_sigma, 1e-4, 1.0);
  reader.read_ms("kalman_coast_ms", out.kalman_coast, milliseconds(0), std::chrono::seconds(10));
  reader.read("max_sigma_m", out.max_sigma, 1e-3, 100.0);
  read_pose_error(reader.child("pose_error"), out.pose_error);
  read_body(reader.child("body"), out.body);
  read_errors(reader, out.errors);
  ConfigReader noise = reader.child("noise");
  read_noise(noise, out.noise);
}

void read_smoothing(ConfigReader reader, pipeline::SmoothingConfig& out) {
  reader.read("live", out.live);
  reader.read_ms("sides_ms", out.sides, milliseconds(0), std::chrono::seconds(60));
  reader.read_ms("bodies_ms", out.bodies, milliseconds(0), std::chrono::seconds(10));
}

void read_pairing(ConfigReader& reader, registration::RegistrationConfig& out) {
  using registration::JointChoice;
  using registration::PairMethod;
  std::size_t method = static_cast<std::size_t>(out.method);
  reader.read_choice("method", method, {"timed-robust", "icp-only"});
  out.method = method == 0 ? PairMethod::TimedRobust : PairMethod::IcpOnly;
  std::size_t joints = static_cast<std::size_t>(out.joints);
  reader.read_choice("joints", joints, {"neck", "core", "all"});
  out.joints = static_cast<JointChoice>(joints);
  reader.read("use_floor", out.use_floor);
  reader.read("along_ratio", out.along_ratio, 1.0, 100.0);
  reader.read("depth_bias_m", out.depth_bias, 0.0, 0.2);
  reader.read("depth_bias_sigma_m", out.depth_bias_sigma, 0.0, 0.2);
  reader.read("adjust_together", out.adjust_together);
  reader.read_ms("latency_sigma_ms", out.latency_sigma, milliseconds(0), milliseconds(200));
  reader.read_ms("max_gap_ms", out.max_gap, milliseconds(1), std::chrono::seconds(1));
  reader.read("min_distance_m", out.min_distance, 0.0, 20.0);
  reader.read("max_distance_m", out.max_distance, 0.1, 50.0);
  reader.read("max_speed_m_s", out.max_speed, 0.1, 20.0);
  int min_pairs = static_cast<int>(out.min_pairs);
  reader.read("min_pairs", min_pairs, 3, 100000);
  out.min_pairs = static_cast<std::size_t>(min_pairs);
  reader.read("min_spread_m", out.min_spread, 0.0, 20.0);
  reader.read("max_edge_rms_m", out.max_edge_rms, 0.001, 5.0);
  reader.read("good_rms_m", out.good_rms, 0.001, 5.0);
  reader.read("good_position_m", out.good_position, 0.001, 5.0);
  reader.read("max_position_m", out.max_position, 0.001, 5.0);
  reader.read_s("good_duration_s", out.good_duration, std::chrono::seconds(1),
                std::chrono::seconds(300));
}

/// Two sensors and their distance.
void read_known_distance(ConfigReader reader, registration::RegistrationConfig& out) {
  constexpr double kShortest = 0.1;   // [m]
  constexpr double kLongest = 100.0;  // [m]
  std::vector<std::string> between;
  double length = 0.0;
  reader.read("between", between);
  if (!reader.has("m")) return reader.complain("m", "is missing: the distance in metres");
  reader.read("m", length, kShortest, kLongest);
  if (between.size() != 2 || between[0] == between[1])
    return reader.complain("between", "must name two sensors");
  const auto first = SensorId::parse(between[0]);
  const auto second = SensorId::parse(between[1]);
  if (!first) return reader.complain("between", first.error().message);
  if (!second) return reader.complain("between", second.error().message);
  out.known_distances.push_back({*first, *second, length});
}

void read_lengths(ConfigReader& reader, registration::RegistrationConfig& out) {
  constexpr double kTallest = 2.5;  // [m]
  double stature = 0.0;
  reader.read("stature_m", stature, 0.0, kTallest);
  if (stature > 0.0) out.stature = stature;
  for (const ConfigReader& each : reader.items("known_distances")) read_known_distance(each, out);
}

void read_watch(ConfigReader reader, watch::WatchConfig& out) {
  reader.read("enabled", out.enabled);
  reader.read("least_shift_m", out.least_shift, 0.005, 1.0);
  reader.read("least_sigmas", out.least_sigmas, 2.0, 100.0);
  reader.read("least_drift_m", out.least_drift, 0.01, 1.0);
}

void read_registration(ConfigReader reader, FusionSettings& out) {
  auto& [live, at_start] = out;
  reader.read("auto", live.session.automatic);
  double target = chorus::seconds(live.session.target);
  reader.read("seconds", target, wire::kMinSession, wire::kMaxSession);
  live.session.target = from_seconds(target);
  std::size_t adoption = static_cast<std::size_t>(live.session.adoption);
  reader.read_choice("adopt", adoption, {"at-once", "when-accepted"});
  live.session.adoption = static_cast<Adoption>(adoption);
  reader.read("target_m", live.session.target_radius, 0.0, 1.0);
  reader.read_s("first_solve_s", live.session.first_solve, std::chrono::seconds(2),
                std::chrono::seconds(60));
  reader.read_s("solve_every_s", live.session.solve_every, std::chrono::seconds(1),
                std::chrono::seconds(60));
  reader.read("file", at_start.registration_file);
  std::string master;
  reader.read("master", master);
  if (!master.empty()) {
    auto id = SensorId::parse(master);
    if (id) {
      live.registration.master = *id;
    } else {
      reader.complain("master", id.error().message);
    }
  }
  read_pairing(reader, live.registration);
  read_lengths(reader, live.registration);
  read_watch(reader.child("watch"), live.watch);
}

void read_inertial(ConfigReader& root, const tls::Trust& trust, LiveSettings& out) {
  std::set<SensorId> known;
  for (ConfigReader& reader : root.items("inertial")) {
    auto source = client::read_followed(reader, trust);
    if (source && !known.insert(source->id).second)
      reader.complain("id", "is the id of another inertial source too");
    if (source) out.inertial.push_back(std::move(*source));
  }
  if (out.inertial.size() > kMaxSensors)
    root.complain("inertial", "at most " + std::to_string(kMaxSensors) + " are possible");
}

void read_evaluation(ConfigReader reader, const tls::Trust& trust, StartSettings& out) {
  client::FollowedService service{SensorId::parse("evaluation").value(), "", "", trust};
  reader.read("url", service.url);
  reader.read("token", service.token);
  if (service.url.empty()) {
    if (!service.token.empty())
      reader.complain("token", "is for the service at evaluation.url, which is empty");
    return;
  }
  if (auto url = http::parse_url(service.url); !url) reader.complain("url", url.error().message);
  out.evaluation.push_back(std::move(service));
}

}  // namespace

Result<FusionSettings> read_fusion_settings(ConfigReader root) {
  FusionSettings settings;
  auto& [live, at_start] = settings;
  at_start.state_dir = "auto";
  at_start.viewer_dir = "auto";
  root.read("title", at_start.title);
  service::read_http(root.child("http"), at_start.http);
  live.tokens = http::all_tokens(std::exchange(at_start.http.bearer_token, {}),
                                 std::exchange(at_start.http.tokens, {}));
  live.identity = std::exchange(at_start.http.identity, {});
  at_start.secure = live.identity.has_value();
  service::read_log(root.child("log"), live.log);
  client::read_timings(root.child("poll"), at_start.poll);
  read_output(root.child("output"), settings);
  read_align(root.child("align"), live.pipeline.align);
  read_quality(root.child("quality"), live.pipeline.quality);
  read_association(root.child("association"), live.pipeline.association);
  read_facing(root.child("facing"), live.pipeline.sides);
  ConfigReader fusion = root.child("fusion");
  read_smoothing(fusion.child("smoothing"), live.pipeline.smoothing);
  read_worn(fusion.child("inertial"), live);
  read_fusion(std::move(fusion), live.pipeline.fusion);
  const tls::Trust trust = client::read_trust(root.child("poll"));
  live.trust = trust;
  read_sensors(root, trust, live);
  read_inertial(root, trust, live);
  read_evaluation(root.child("evaluation"), trust, at_start);
  read_registration(root.child("registration"), settings);
  outputs::read_outputs(root.child("outputs"), settings.live.outputs);
  read_site(root.child("site"), at_start.site, live.site_places);
  at_start.props = workplace::read_props(root);
  root.read("state_dir", at_start.state_dir);
  root.read("viewer_dir", at_start.viewer_dir);
  service::read_recording(root.child("recording"), at_start.recording);
  if (auto ok = root.finish(); !ok) return pass(ok);
  return settings;
}

}  // namespace chorus::server
