#include "fusion-server/wire/registration_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/geometry/error_radius.h"

namespace chorus::wire {
namespace {

using resource::Decimal;
using resource::Node;

constexpr std::array<std::pair<Verdict, std::string_view>, 4> kVerdicts{{
    {Verdict::None, "None"},
    {Verdict::Provisional, "Provisional"},
    {Verdict::Good, "Good"},
    {Verdict::Refused, "Refused"},
}};

/// The covariance row by row, with enough digits for squares of 0.1 mm and 0.01 degree.
std::vector<Decimal> decimals_of(const Eigen::Matrix<double, 6, 6>& covariance) {
  constexpr int kCovarianceDigits = 10;
  std::vector<Decimal> values;
  for (const double value : covariance.transpose().reshaped())
    values.push_back({value, kCovarianceDigits});
  return values;
}

void add_verdict(Node& node, const SensorVerdict& own) {
  node.properties.emplace_back("verdict", std::string(name_of(own.verdict)));
  node.properties.emplace_back("reasons", own.reasons);
}

Node sensor_node(const SensorId& id, const Extrinsics& place) {
  const Eigen::Vector3d p = place.world_from_sensor.translation();
  const Eigen::Quaterniond q(place.world_from_sensor.rotation());
  constexpr int kPlaceDigits = 4;  // 0.1 mm
  constexpr int kRotationDigits = 5;
  Node node{"sensors/" + id.str(), {"RegisteredSensor"}, {{"sensorId", id.str()}}};
  const auto put = [&](const char* key, double value, int digits) {
    node.properties.emplace_back(key, Decimal{value, digits});
  };
  put("x", p.x(), kPlaceDigits);
  put("y", p.y(), kPlaceDigits);
  put("z", p.z(), kPlaceDigits);
  put("qx", q.x(), kRotationDigits);
  put("qy", q.y(), kRotationDigits);
  put("qz", q.z(), kRotationDigits);
  put("qw", q.w(), kRotationDigits);
  put("error", place.error, kPlaceDigits);
  node.properties.emplace_back("chain", names_of(place.chain));
  if (!place.next_chain.empty()) {
    node.properties.emplace_back("nextChain", names_of(place.next_chain));
    put("nextError", place.next_error, kPlaceDigits);
  }
  if (place.scale != 1.0) put("scale", place.scale, kRotationDigits);
  // All zero means that the covariance is unknown.
  if (place.covariance.isZero(0.0)) return node;
  node.properties.emplace_back("covariance", decimals_of(place.covariance));
  const double radius = radius_on_floor(place.covariance);
  if (std::isfinite(radius)) put("presentRadius", radius, kPlaceDigits);
  return node;
}

/// Adds the offset of the sensor's clock, if one was found from the walk.
void add_clock(Node& node, const Registration& registration, const SensorId& id) {
  const auto clock = registration.clocks.find(id);
  if (clock == registration.clocks.end()) return;
  constexpr int kDigits = 3;
  constexpr double kPerSecond = 1e3;
  const auto put = [&](const char* key, Duration value) {
    node.properties.emplace_back(key, Decimal{kPerSecond * seconds(value), kDigits});
  };
  put("clockOffsetMilliseconds", clock->second.added);
  put("clockUncertaintyMilliseconds", clock->second.sigma);
}

/// Adds the sensor's latency relative to the others, if the walk told it.
void add_latency(Node& node, const Registration& registration, const SensorId& id) {
  const auto latency = registration.latencies.find(id);
  if (latency == registration.latencies.end()) return;
  constexpr int kDigits = 3;
  constexpr double kPerSecond = 1e3;
  const auto put = [&](const char* key, Duration value) {
    node.properties.emplace_back(key, Decimal{kPerSecond * seconds(value), kDigits});
  };
  put("latencyMilliseconds", latency->second.found);
  put("latencyUncertaintyMilliseconds", latency->second.sigma);
  node.properties.emplace_back("latencyCorrected", latency->second.applied);
}

Node edge_node(const PairwiseRegistration& edge) {
  constexpr int kDigits = 4;
  Node node{"_",
            {"RegistrationEdge"},
            {{"target", edge.target.str()},
             {"source", edge.source.str()},
             {"rms", Decimal{edge.rms, kDigits}},
             {"pairs", static_cast<std::int64_t>(edge.pairs)},
             {"inliers", static_cast<std::int64_t>(edge.inliers)}}};
  if (edge.apart) node.properties.emplace_back("apart", Decimal{*edge.apart, kDigits});
  if (edge.loop) node.properties.emplace_back("loopError", Decimal{*edge.loop, kDigits});
  if (edge.loop_turn)
    node.properties.emplace_back("loopDegrees", Decimal{to_deg(*edge.loop_turn), kDigits});
  return node;
}

/// The newest session; its state is "idle" unless it is running.
Node newest_session(const RegistrationProgress& progress) {
  constexpr int kDigits = 1;
  const SessionStatus session =
      progress.sessions.empty() ? SessionStatus{} : progress.sessions.front();
  Node node{"_", {"RegistrationSession"}, {}};
  if (session.id != 0) {
    node.properties.emplace_back("sessionId", static_cast<std::int64_t>(session.id));
    node.properties.emplace_back("progress", resource::Ref{session_path(session.id)});
  }
  node.properties.emplace_back("state",
                               std::string(running(session) ? name_of(session.state) : "idle"));
  node.properties.emplace_back("elapsedSeconds", Decimal{session.elapsed, kDigits});
  node.properties.emplace_back("targetSeconds", Decimal{session.target, kDigits});
  node.properties.emplace_back("reasons", session.reasons);
  return node;
}

/// The last few sessions, newest first.
std::vector<resource::Ref> session_refs(const RegistrationProgress& progress) {
  std::vector<resource::Ref> refs;
  for (const SessionStatus& session : progress.sessions) refs.push_back({session_path(session.id)});
  return refs;
}

/// What each pair of sensors saw together.
std::vector<Node> pair_nodes(const SessionStatus& session) {
  constexpr int kDigits = 3;
  std::vector<Node> nodes;
  for (const PairCoverage& pair : session.pairs) {
    nodes.push_back({"_",
                     {"PairCoverage"},
                     {{"target", pair.first.str()},
                      {"source", pair.second.str()},
                      {"sightings", static_cast<std::int64_t>(pair.sightings)},
                      {"spread", Decimal{pair.spread, kDigits}},
                      {"expectedRadius", Decimal{pair.expected, kDigits}}}});
  }
  return nodes;
}

/// How well the walk places each sensor so far.
std::vector<Node> accuracy_nodes(const SessionStatus& session) {
  constexpr int kDigits = 3;
  std::vector<Node> nodes;
  for (const SensorAccuracy& own : session.accuracy) {
    Node node{"_", {"SensorAccuracy"}, {{"sensorId", own.sensor.str()}}};
    if (own.radius && std::isfinite(*own.radius))
      node.properties.emplace_back("expectedRadius", Decimal{*own.radius, kDigits});
    nodes.push_back(std::move(node));
  }
  return nodes;
}

/// Where somebody walked, from above.
std::vector<Node> cell_nodes(const SessionStatus& session) {
  constexpr int kDigits = 2;
  std::vector<Node> nodes;
  for (const CoveredCell& cell : session.cells) {
    nodes.push_back({"_",
                     {"CoveredCell"},
                     {{"x", Decimal{cell.x, kDigits}},
                      {"z", Decimal{cell.z, kDigits}},
                      {"seenBy", static_cast<std::int64_t>(cell.sensors)}}});
  }
  return nodes;
}

void add_storage(Node& node, const RegistrationProgress& progress) {
  const StorageStatus& storage = progress.storage;
  node.properties.emplace_back("stored", stored(progress));
  std::string problem = storage.trouble.empty() ? storage.damage : storage.trouble;
  if (storage.folder.empty()) {
    problem =
        "state_dir is empty, or \"auto\" without a HOME: the registration is forgotten when the "
        "server ends";
  }
  if (!problem.empty()) node.properties.emplace_back("storeProblem", std::move(problem));
}

/// The registration that an undo goes back to.
Node earlier_node(const Registration& registration) {
  return {"_",
          {"EarlierRegistration"},
          {{"version", static_cast<std::int64_t>(registration.version)},
           {"verdict", std::string(name_of(registration.verdict))},
           {"solved", registration.solved}}};
}

/// A registration that waits to be accepted, and what it would change.
Node proposal_node(const Proposal& proposal) {
  constexpr int kDigits = 4;
  const Registration& proposed = proposal.registration;
  Node node{"_",
            {"ProposedRegistration"},
            {{"sessionId", static_cast<std::int64_t>(proposal.session)},
             {"verdict", std::string(name_of(proposed.verdict))},
             {"reasons", proposed.reasons},
             {"solved", proposed.solved}}};
  std::vector<Node> changes;
  for (const PlaceChange& change : proposal.changes) {
    changes.push_back({"_", {"PlaceChange"}, {{"sensorId", change.sensor.str()}}});
    const auto put = [&](const char* key, const std::optional<double>& value) {
      if (value) changes.back().properties.emplace_back(key, Decimal{*value, kDigits});
    };
    put("presentRadius", change.radius_now);
    put("expectedRadius", change.radius_then);
    put("moves", change.shift);
    if (change.turn) put("turnsDegrees", to_deg(*change.turn));
  }
  node.properties.emplace_back("changes", std::move(changes));
  return node;
}

/// Sensors that took part in a walk but have no place.
std::vector<Node> unplaced_nodes(const Registration& registration) {
  std::vector<Node> nodes;
  for (const auto& [id, own] : registration.verdicts) {
    if (registration.sensors.contains(id)) continue;
    Node node{"sensors/" + id.str(), {"UnplacedSensor"}, {{"sensorId", id.str()}}};
    add_verdict(node, own);
    nodes.push_back(std::move(node));
  }
  return nodes;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<SensorId>& sensors) {
  std::vector<std::string> names;
  names.reserve(sensors.size());
  for (const SensorId& sensor : sensors) names.push_back(sensor.str());
  return names;
}

std::string_view name_of(Verdict verdict) noexcept {
  for (const auto& [value, name] : kVerdicts) {
    if (value == verdict) return name;
  }
  return "None";
}

std::string_view name_of(SessionState state) noexcept {
  switch (state) {
    case SessionState::Collecting:
      return "collecting";
    case SessionState::Solving:
      return "solving";
    case SessionState::Done:
      return "done";
    case SessionState::Cancelled:
      return "cancelled";
  }
  return "done";
}

std::string_view name_of(Adoption adoption) noexcept {
  return adoption == Adoption::AtOnce ? "at-once" : "when-accepted";
}

std::optional<Adoption> adoption_named(std::string_view name) noexcept {
  for (const Adoption value : {Adoption::AtOnce, Adoption::WhenAccepted}) {
    if (name_of(value) == name) return value;
  }
  return std::nullopt;
}

std::string session_path(std::uint64_t id) {
  return "/registration/sessions/" + std::to_string(id);
}

std::optional<Verdict> verdict_named(std::string_view name) noexcept {
  for (const auto& [value, known] : kVerdicts) {
    if (known == name) return value;
  }
  return std::nullopt;
}

Node session_node(const SessionStatus& session, const std::vector<std::string>& awaits) {
  constexpr int kDigits = 1;
  Node node{"", {"RegistrationSession"}, {}};
  auto& out = node.properties;
  out.emplace_back("sessionId", static_cast<std::int64_t>(session.id));
  out.emplace_back("state", std::string(name_of(session.state)));
  out.emplace_back("automatic", session.automatic);
  out.emplace_back("adopt", std::string(name_of(session.adoption)));
  out.emplace_back("started", session.started);
  out.emplace_back("elapsedSeconds", Decimal{session.elapsed, kDigits});
  out.emplace_back("targetSeconds", Decimal{session.target, kDigits});
  out.emplace_back("verdict", std::string(name_of(session.verdict)));
  out.emplace_back("adopted", session.adopted);
  out.emplace_back("reasons", session.reasons);
  if (running(session)) out.emplace_back("awaits", awaits);
  if (session.target_radius > 0) {
    constexpr int kRadiusDigits = 3;
    out.emplace_back("targetRadius", Decimal{session.target_radius, kRadiusDigits});
    out.emplace_back("targetReached", session.reached);
  }
  out.emplace_back("accuracy", accuracy_nodes(session));
  out.emplace_back("coverage", pair_nodes(session));
  out.emplace_back("floorCells", cell_nodes(session));
  out.emplace_back("registration", resource::Ref{"/registration"});
  return node;
}

Node registration_node(const Registration& registration, const RegistrationProgress& progress) {
  Node node{"", {"Registration"}, {}};
  node.properties.emplace_back("version", static_cast<std::int64_t>(registration.version));
  node.properties.emplace_back("verdict", std::string(name_of(registration.verdict)));
  node.properties.emplace_back("reasons", registration.reasons);
  node.properties.emplace_back("awaits", progress.awaits);
  node.properties.emplace_back("alarms", progress.alarms);
  if (!registration.sensors.empty()) {
    node.properties.emplace_back("master", registration.master.str());
    node.properties.emplace_back("solved", registration.solved);
  }
  if (progress.earlier) node.properties.emplace_back("earlier", earlier_node(*progress.earlier));
  if (progress.proposal)
    node.properties.emplace_back("proposal", proposal_node(*progress.proposal));
  add_storage(node, progress);
  node.properties.emplace_back("session", newest_session(progress));
  node.properties.emplace_back("sessions", session_refs(progress));
  std::vector<Node> sensors;
  for (const auto& [id, place] : registration.sensors) {
    sensors.push_back(sensor_node(id, place));
    if (std::ranges::find(progress.unpolled, id) != progress.unpolled.end())
      sensors.back().properties.emplace_back("polled", false);
    add_clock(sensors.back(), registration, id);
    add_latency(sensors.back(), registration, id);
    const auto own = registration.verdicts.find(id);
    add_verdict(sensors.back(), own != registration.verdicts.end()
                                    ? own->second
                                    : SensorVerdict{registration.verdict, {}});
  }
  node.properties.emplace_back("sensors", std::move(sensors));
  node.properties.emplace_back("unplaced", unplaced_nodes(registration));
  std::vector<Node> edges;
  for (const PairwiseRegistration& edge : registration.edges) edges.push_back(edge_node(edge));
  node.properties.emplace_back("edges", std::move(edges));
  return node;
}

}  // namespace chorus::wire
