#include "fusion-server/wire/registration_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/units.h"
#include "common/sensor/limits.h"
#include "fusion-server/wire/registration_fields.h"
#include "fusion-server/wire/registration_nodes.h"

namespace chorus::wire {
namespace {

using nlohmann::json;

// 64 sensors with covariances and all edges need less than 1 MB.
constexpr JsonLimits kLimits{4U << 20U, 16};
constexpr double kLeastScale = 0.1;
constexpr double kMostScale = 10.0;
constexpr const char* kClockOffset = "clockOffsetMilliseconds";
constexpr const char* kClockUncertainty = "clockUncertaintyMilliseconds";
constexpr const char* kClockStated = "clockStatedMilliseconds";
constexpr const char* kClockLeastAge = "clockLeastAgeMilliseconds";
constexpr double kMillisecond = 1e3;
constexpr double kMaxClockOffset = 60e3;  // [ms]
constexpr double kMaxLatency = 1e3;       // [ms]
constexpr const char* kLatency = "latencyMilliseconds";
constexpr const char* kLatencyUncertainty = "latencyUncertaintyMilliseconds";
constexpr const char* kLatencyApplied = "latencyCorrected";
constexpr double kMaxClockAge = 60e3;  // [ms]

json verdict_json(const SensorVerdict& own) {
  return {{"verdict", name_of(own.verdict)}, {"reasons", own.reasons}};
}

json sensor_json(const SensorId& id, const Extrinsics& place) {
  json covariance = json::array();
  for (const double value : place.covariance.reshaped()) covariance.push_back(value);
  json object = pose_json(place.world_from_sensor);
  object.update({{"@id", "sensors/" + id.str()},
                 {"error", place.error},
                 {"chain", names_of(place.chain)},
                 {"nextChain", names_of(place.next_chain)},
                 {"nextError", place.next_error},
                 {"covariance", std::move(covariance)},
                 {"scale", place.scale}});
  return object;
}

Result<SensorVerdict> verdict_of(const json& object, const std::string& where, Verdict fallback) {
  SensorVerdict own{fallback, {}};
  if (const auto it = object.find("verdict"); it != object.end()) {
    const std::string word = it->is_string() ? it->get<std::string>() : "";
    const auto known = verdict_named(word);
    if (!known)
      return tl::unexpected(wrong(where + ".verdict", "\"" + word + "\" is not a verdict"));
    own.verdict = *known;
  }
  if (const auto it = object.find("reasons"); it != object.end() && it->is_array()) {
    for (const json& reason : *it) {
      if (reason.is_string()) own.reasons.push_back(reason.get<std::string>());
    }
  }
  return own;
}

Result<Extrinsics> extrinsics_of(const json& object, const std::string& where) {
  if (!object.is_object()) return tl::unexpected(wrong(where, "an object is wanted"));
  Extrinsics out;
  auto pose = pose_of(object, where);
  if (!pose) return pass(pose);
  out.world_from_sensor = *pose;
  auto chain = ids_of(object, where, "chain");
  if (!chain) return pass(chain);
  out.chain = std::move(*chain);
  auto next = ids_of(object, where, "nextChain");
  if (!next) return pass(next);
  out.next_chain = std::move(*next);
  const auto error = number(object, where, "error", kMaxPlace, 0.0);
  const auto next_error = number(object, where, "nextError", kMaxPlace, 0.0);
  if (!error) return pass(error);
  if (!next_error) return pass(next_error);
  out.error = *error;
  out.next_error = *next_error;
  const auto scale = number(object, where, "scale", kMostScale, 1.0);
  if (!scale) return pass(scale);
  if (*scale < kLeastScale)
    return tl::unexpected(wrong(where + ".scale", "a scale from 0.1 to 10 is wanted"));
  out.scale = *scale;
  if (auto ok = read_matrix(object, where, "covariance", out.covariance); !ok) return pass(ok);
  if (auto ok = check_covariance(out.covariance, where + ".covariance"); !ok) return pass(ok);
  return out;
}

/// Reads the offset of a sensor's clock, which is there if it was found from the walk.
Result<void> read_clock(const json& object, const std::string& where, const SensorId& sensor,
                        Registration& out) {
  if (!object.contains(kClockOffset)) return {};
  const auto added = number(object, where, kClockOffset, kMaxClockOffset);
  const auto sigma = number(object, where, kClockUncertainty, kMaxClockOffset, 0.0);
  if (!added) return pass(added);
  if (!sigma) return pass(sigma);
  ClockOffset& clock = out.clocks[sensor];
  clock.added = from_seconds(*added / kMillisecond);
  clock.sigma = from_seconds(std::abs(*sigma) / kMillisecond);
  const double unknown = kMillisecond * kUnknownClock;
  const auto stated = number(object, where, kClockStated, kMaxClockOffset, unknown);
  if (!stated) return pass(stated);
  clock.stated = from_seconds(std::abs(*stated) / kMillisecond);
  if (!object.contains(kClockLeastAge)) return {};
  const auto age = number(object, where, kClockLeastAge, kMaxClockAge);
  if (!age) return pass(age);
  clock.least_age = from_seconds(*age / kMillisecond);
  return {};
}

/// Reads the sensor's latency, which is there if a walk told it.
Result<void> read_latency(const json& object, const std::string& where, const SensorId& sensor,
                          Registration& out) {
  if (!object.contains(kLatency)) return {};
  const auto found = number(object, where, kLatency, kMaxLatency);
  const auto sigma = number(object, where, kLatencyUncertainty, kMaxLatency, 0.0);
  if (!found) return pass(found);
  if (!sigma) return pass(sigma);
  const auto applied = object.find(kLatencyApplied);
  out.latencies[sensor] = {from_seconds(*found / kMillisecond),
                           from_seconds(std::abs(*sigma) / kMillisecond),
                           applied != object.end() && *applied == true};
  return {};
}

void add_latency(json& object, const Latency& latency) {
  object[kLatency] = kMillisecond * seconds(latency.found);
  object[kLatencyUncertainty] = kMillisecond * seconds(latency.sigma);
  object[kLatencyApplied] = latency.applied;
}

void add_clock(json& object, const ClockOffset& clock) {
  object[kClockOffset] = kMillisecond * seconds(clock.added);
  object[kClockUncertainty] = kMillisecond * seconds(clock.sigma);
  object[kClockStated] = kMillisecond * seconds(clock.stated);
  if (clock.least_age) object[kClockLeastAge] = kMillisecond * seconds(*clock.least_age);
}

json edge_json(const PairwiseRegistration& edge) {
  json object{{"target", edge.target.str()},
              {"source", edge.source.str()},
              {"rms", edge.rms},
              {"pairs", edge.pairs},
              {"inliers", edge.inliers}};
  if (edge.apart) object["apart"] = *edge.apart;
  if (edge.loop) object["loopError"] = *edge.loop;
  if (edge.loop_turn) object["loopDegrees"] = to_deg(*edge.loop_turn);
  return object;
}

Result<PairwiseRegistration> edge_of(const json& object) {
  if (!object.is_object()) return tl::unexpected(wrong("edges", "objects are wanted"));
  PairwiseRegistration edge;
  for (const auto& [key, out] : {std::pair{"target", &edge.target}, {"source", &edge.source}}) {
    const auto name = text_of(object, "edges.", key);
    if (!name) return pass(name);
    auto id = SensorId::parse(*name);
    if (!id) return tl::unexpected(wrong(std::string("edges.") + key, id.error().message));
    *out = std::move(*id);
  }
  constexpr double kMaxPairs = 1e9;
  const auto rms = number(object, "edges", "rms", kMaxPlace, 0.0);
  const auto pairs = number(object, "edges", "pairs", kMaxPairs, 0.0);
  const auto inliers = number(object, "edges", "inliers", kMaxPairs, 0.0);
  if (!rms) return pass(rms);
  if (!pairs) return pass(pairs);
  if (!inliers) return pass(inliers);
  for (const auto& [key, out] : {std::pair{"apart", &edge.apart}, {"loopError", &edge.loop}}) {
    if (!object.contains(key)) continue;
    const auto value = number(object, "edges", key, kMaxPlace);
    if (!value) return pass(value);
    *out = *value;
  }
  if (object.contains("loopDegrees")) {
    constexpr double kHalfTurn = 180.0;
    const auto turn = number(object, "edges", "loopDegrees", kHalfTurn);
    if (!turn) return pass(turn);
    edge.loop_turn = deg(*turn);
  }
  edge.rms = *rms;
  edge.pairs = static_cast<std::size_t>(std::max(0.0, *pairs));
  edge.inliers = static_cast<std::size_t>(std::max(0.0, *inliers));
  return edge;
}

/// What a file without sensors is, where somebody has named the wrong one.
std::string kind_of(const json& root) {
  if (root.contains("fx") && root.contains("cx")) return "; this is the lens of a camera";
  if (root.contains("restMm")) return "; this is a hand of chorus scan";
  return "";
}

Result<void> read_sensors(const json& root, Registration& out) {
  const auto it = root.find("sensors");
  if (it == root.end() || !it->is_object() || it->empty()) {
    return tl::unexpected(
        wrong("sensors", "an object of sensor places is missing" + kind_of(root)));
  }
  if (it->size() > kMaxSensors)
    return tl::unexpected(
        wrong("sensors", "at most " + std::to_string(kMaxSensors) + " are possible"));
  for (const auto& [name, object] : it->items()) {
    auto id = SensorId::parse(name);
    if (!id) return tl::unexpected(wrong("sensors." + name, id.error().message));
    auto place = extrinsics_of(object, "sensors." + name);
    if (!place) return pass(place);
    if (place->chain.empty()) place->chain = {*id};
    if (auto ok = read_clock(object, "sensors." + name, *id, out); !ok) return ok;
    if (auto ok = read_latency(object, "sensors." + name, *id, out); !ok) return ok;
    out.sensors.emplace(std::move(*id), std::move(*place));
  }
  return {};
}

/// Reads the anchors, if there are any.
Result<void> read_anchors(const json& root, Registration& out) {
  const auto it = root.find("anchors");
  if (it == root.end()) return {};
  if (!it->is_object() || it->size() > kMaxSensors)
    return tl::unexpected(wrong("anchors", "an object of sensor places is wanted"));
  for (const auto& [name, object] : it->items()) {
    const std::string where = "anchors." + name;
    auto id = SensorId::parse(name);
    if (!id) return tl::unexpected(wrong(where, id.error().message));
    if (!object.is_object()) return tl::unexpected(wrong(where, "an object is wanted"));
    auto pose = pose_of(object, where);
    if (!pose) return pass(pose);
    out.anchors.emplace(std::move(*id), *pose);
  }
  return {};
}

/// Reads the sensors' verdicts, if there are any; one that is not stated is `fallback`.
Result<void> read_verdicts(const json& root, const char* key, Verdict fallback, Registration& out) {
  const auto it = root.find(key);
  if (it == root.end() || !it->is_object()) return {};
  if (it->size() > kMaxSensors) {
    return tl::unexpected(
        wrong(key, "at most " + std::to_string(kMaxSensors) + " sensors are possible"));
  }
  for (const auto& [name, object] : it->items()) {
    auto id = SensorId::parse(name);
    const std::string where = std::string(key) + "." + name;
    if (!id) return tl::unexpected(wrong(where, id.error().message));
    auto own = verdict_of(object, where, fallback);
    if (!own) return pass(own);
    out.verdicts.emplace(std::move(*id), std::move(*own));
  }
  return {};
}

Result<void> read_master(const json& root, Registration& out) {
  out.master = out.sensors.begin()->first;
  const auto master = text_of(root, "", "master");
  if (!master) return pass(master);
  if (master->empty()) return {};
  auto id = SensorId::parse(*master);
  if (!id || !out.sensors.contains(*id))
    return tl::unexpected(wrong("master", "\"" + *master + "\" is none of the sensors"));
  out.master = std::move(*id);
  return {};
}

Result<void> read_header(const json& root, Registration& out) {
  const auto version = number(root, "", "version", 1e15, 1.0);
  if (!version) return pass(version);
  out.version = static_cast<std::uint64_t>(std::max(0.0, *version));
  // Given extrinsics without a verdict count as good.
  const auto verdict = text_of(root, "", "verdict", "Good");
  if (!verdict) return pass(verdict);
  const auto known = verdict_named(*verdict);
  if (!known) return tl::unexpected(wrong("verdict", "\"" + *verdict + "\" is not a verdict"));
  out.verdict = *known;
  const auto solved = text_of(root, "", "solved");
  if (!solved) return pass(solved);
  if (!solved->empty()) {
    auto time = parse_iso8601(*solved);
    if (!time) return tl::unexpected(wrong("solved", time.error().message));
    out.solved = *time;
  }
  return read_master(root, out);
}

Result<Registration> registration_of(const json& root) {
  if (!root.is_object()) return tl::unexpected(wrong("document", "an object is wanted"));
  Registration out;
  if (auto ok = read_sensors(root, out); !ok) return pass(ok);
  if (auto ok = read_header(root, out); !ok) return pass(ok);
  if (auto ok = read_anchors(root, out); !ok) return pass(ok);
  if (auto ok = read_verdicts(root, "sensors", out.verdict, out); !ok) return pass(ok);
  if (auto ok = read_verdicts(root, "unplaced", Verdict::Refused, out); !ok) return pass(ok);
  if (const auto it = root.find("reasons"); it != root.end() && it->is_array()) {
    for (const json& reason : *it) {
      if (reason.is_string()) out.reasons.push_back(reason.get<std::string>());
    }
  }
  if (const auto it = root.find("edges"); it != root.end() && it->is_array()) {
    for (const json& object : *it) {
      auto edge = edge_of(object);
      if (!edge) return pass(edge);
      out.edges.push_back(std::move(*edge));
    }
  }
  return out;
}

}  // namespace

std::string write_registration(const Registration& registration) {
  json sensors = json::object();
  json unplaced = json::object();
  for (const auto& [id, place] : registration.sensors) sensors[id.str()] = sensor_json(id, place);
  for (const auto& [id, own] : registration.verdicts) {
    if (sensors.contains(id.str())) {
      sensors[id.str()].update(verdict_json(own));
    } else {
      unplaced[id.str()] = verdict_json(own);
    }
  }
  for (const auto& [id, clock] : registration.clocks) {
    if (sensors.contains(id.str())) add_clock(sensors[id.str()], clock);
  }
  for (const auto& [id, latency] : registration.latencies) {
    if (sensors.contains(id.str())) add_latency(sensors[id.str()], latency);
  }
  json anchors = json::object();
  for (const auto& [id, pose] : registration.anchors) anchors[id.str()] = pose_json(pose);
  json edges = json::array();
  for (const PairwiseRegistration& edge : registration.edges) {
    edges.push_back(edge_json(edge));
  }
  const json root{{"@type", "Registration"},
                  {"version", registration.version},
                  {"verdict", name_of(registration.verdict)},
                  {"reasons", registration.reasons},
                  {"master", registration.master.str()},
                  {"solved", to_iso8601(registration.solved)},
                  {"sensors", std::move(sensors)},
                  {"unplaced", std::move(unplaced)},
                  {"anchors", std::move(anchors)},
                  {"edges", std::move(edges)}};
  return root.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

Result<Registration> read_registration(std::string_view text) {
  const auto document = parse_json(text, kLimits);
  if (!document) {
    const std::string why = to_string(document.error());
    return fail(ErrorCode::Malformed, "registration", why);
  }
  try {
    return registration_of(*document);
  } catch (const json::exception& e) {
    return tl::unexpected(wrong("document", e.what()));
  }
}

record::PlacesChanged places_changed(Timestamp at, const Registration& registration) {
  record::PlacesChanged changed{at, write_registration(registration), {}};
  for (const auto& [sensor, place] : registration.sensors)
    changed.places.push_back({sensor.str(), place.world_from_sensor});
  return changed;
}

}  // namespace chorus::wire
