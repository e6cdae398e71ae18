#include "fusion-server/wire/registration_resource.h"

#include <array>
#include <utility>

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

/// Row by row; squares of 0.1 mm and of a hundredth of a degree, with two digits more.
std::vector<Decimal> decimals_of(const Eigen::Matrix<double, 6, 6>& covariance) {
  constexpr int kCovarianceDigits = 10;
  std::vector<Decimal> values;
  for (const double value : covariance.transpose().reshaped())
    values.push_back({value, kCovarianceDigits});
  return values;
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
  if (!place.covariance.isZero(0.0))  // else nothing is known of it
    node.properties.emplace_back("covariance", decimals_of(place.covariance));
  return node;
}

Node edge_node(const PairwiseRegistration& edge) {
  constexpr int kDigits = 4;
  return {"_",
          {"RegistrationEdge"},
          {{"target", edge.target.str()},
           {"source", edge.source.str()},
           {"rms", Decimal{edge.rms, kDigits}},
           {"pairs", static_cast<std::int64_t>(edge.pairs)},
           {"inliers", static_cast<std::int64_t>(edge.inliers)}}};
}

Node session_node(const SessionStatus& session) {
  constexpr int kDigits = 1;
  return {"_",
          {"RegistrationSession"},
          {{"state", std::string(session.collecting ? "collecting" : "idle")},
           {"elapsedSeconds", Decimal{session.elapsed, kDigits}},
           {"targetSeconds", Decimal{session.target, kDigits}},
           {"reasons", session.reasons}}};
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

std::optional<Verdict> verdict_named(std::string_view name) noexcept {
  for (const auto& [value, known] : kVerdicts) {
    if (known == name) return value;
  }
  return std::nullopt;
}

Node registration_node(const Registration& registration, const SessionStatus& session) {
  Node node{"", {"Registration"}, {}};
  node.properties.emplace_back("version", static_cast<std::int64_t>(registration.version));
  node.properties.emplace_back("verdict", std::string(name_of(registration.verdict)));
  node.properties.emplace_back("reasons", registration.reasons);
  if (!registration.sensors.empty()) {
    node.properties.emplace_back("master", registration.master.str());
    node.properties.emplace_back("solved", registration.solved);
  }
  node.properties.emplace_back("session", session_node(session));
  std::vector<Node> sensors;
  for (const auto& [id, place] : registration.sensors) sensors.push_back(sensor_node(id, place));
  node.properties.emplace_back("sensors", std::move(sensors));
  std::vector<Node> edges;
  for (const PairwiseRegistration& edge : registration.edges) edges.push_back(edge_node(edge));
  node.properties.emplace_back("edges", std::move(edges));
  return node;
}

}  // namespace chorus::wire
