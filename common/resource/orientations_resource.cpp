#include "common/resource/orientations_resource.h"

#include <optional>
#include <utility>

#include "common/base/json.h"
#include "common/resource/inertial_members.h"
#include "common/resource/inertial_readings.h"
#include "common/resource/json_members.h"
#include "common/resource/orientations_scan.h"

namespace chorus::resource {
namespace {

using inertial::InertialFrame;
using inertial::InertialReading;

constexpr JsonLimits kOrientationsLimits{.bytes = 2'000'000, .nesting = 8};

constexpr int kAngleDigits = 6;
constexpr int kCovarianceDigits = 9;  ///< 1e-9 rad^2: 0.002 degrees.

using NodeProperties = std::vector<std::pair<std::string, Value>>;

void put_capture_time(NodeProperties& out, Timestamp captured) {
  out.emplace_back("captured", captured);
  out.emplace_back("capturedNanoseconds", to_unix_ns(captured));
}

Node reading_node(const InertialReading& each) {
  Node node{"_", {"InertialReading"}, {{"inertialSensor", each.sensor}}};
  NodeProperties& out = node.properties;
  put_capture_time(out, each.captured);
  if (each.limb) out.emplace_back("limb", std::string(name_of(*each.limb)));
  if (each.inertial_from_sensor) {
    const auto& q = each.inertial_from_sensor->coeffs();
    for (std::size_t i = 0; i < kQuaternion.size(); ++i)
      out.emplace_back(kQuaternion[i], Decimal{q[static_cast<Eigen::Index>(i)], kAngleDigits});
  }
  if (each.covariance) {
    for (std::size_t i = 0; i < kCovariance.size(); ++i) {
      const auto [row, column] = kTriangle[i];
      out.emplace_back(kCovariance[i], Decimal{(*each.covariance)(row, column), kCovarianceDigits});
    }
  }
  for (const VectorField& field : kVectors) {
    const auto& vector = each.*field.value;
    for (int axis = 0; vector && axis < 3; ++axis)
      out.emplace_back(field.keys[static_cast<std::size_t>(axis)],
                       Decimal{(*vector)[axis], field.digits});
  }
  if (each.magnetic != inertial::MagneticState::Unknown)
    out.emplace_back("magneticState", std::string(name_of(each.magnetic)));
  if (each.battery) out.emplace_back("battery", Decimal{*each.battery, 3});
  return node;
}

Node instant_node(const InertialFrame& frame) {
  Node node{"_", {"InertialInstant"}, {{"sequence", static_cast<std::int64_t>(frame.sequence)}}};
  put_capture_time(node.properties, frame.captured);
  std::vector<Node> readings;
  for (const InertialReading& each : frame.readings) readings.push_back(reading_node(each));
  node.properties.emplace_back("readings", std::move(readings));
  return node;
}

void read_rotation(JsonMembers& members, InertialReading& out) {
  if (const auto q = members.numbers(kQuaternion))
    out.inertial_from_sensor = Eigen::Quaterniond((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
  const auto triangle = members.numbers(kCovariance);
  if (!triangle) return;
  Eigen::Matrix3d covariance;
  for (std::size_t i = 0; i < kTriangle.size(); ++i) {
    const auto [row, column] = kTriangle[i];
    covariance(row, column) = covariance(column, row) = (*triangle)[i];
  }
  if (!(covariance.diagonal().minCoeff() >= 0.0))
    members.complain("rxx", "is of a covariance with a negative variance");
  out.covariance = covariance;
}

Result<InertialReading> read_reading(const std::string& sensor, const nlohmann::json& object,
                                     std::optional<Timestamp> captured) {
  if (!object.is_object()) return fail(ErrorCode::Malformed, sensor, "is no object");
  JsonMembers members(object, "sensor " + sensor);
  InertialReading out;
  out.sensor = sensor;
  const bool stamped = !captured || members.find("capturedNanoseconds") != nullptr;
  out.captured = stamped ? members.time() : *captured;
  if (const std::string limb = members.text("limb"); !limb.empty()) {
    out.limb = inertial::limb_named(limb);
    if (!out.limb) members.complain("limb", "names no limb; \"ForearmLeft\" would be one");
  }
  read_rotation(members, out);
  for (const VectorField& field : kVectors) {
    if (const auto v = members.numbers(field.keys))
      out.*field.value = Eigen::Vector3d((*v)[0], (*v)[1], (*v)[2]);
  }
  if (const std::string state = members.text("magneticState"); !state.empty()) {
    const auto known = inertial::magnetic_state_named(state);
    if (!known) members.complain("magneticState", "is none of undisturbed, disturbed, none");
    out.magnetic = known.value_or(inertial::MagneticState::Unknown);
  }
  out.battery = members.number("battery");
  if (members.error()) return tl::unexpected<Error>(*members.error());
  return out;
}

Result<std::vector<InertialReading>> readings_in(const nlohmann::json& readings,
                                                 std::optional<Timestamp> captured) {
  if (!readings.is_object())
    return fail(ErrorCode::Malformed, "readings", "is no object with a member for each sensor");
  std::vector<InertialReading> all;
  for (const auto& [sensor, reading] : readings.items()) {
    auto one = read_reading(sensor, reading, captured);
    if (!one) return pass(one);
    all.push_back(std::move(*one));
  }
  return all;
}

Result<InertialFrame> read_instant(const nlohmann::json& object, const SensorId& source) {
  if (!object.is_object()) return fail(ErrorCode::Malformed, "instants", "hold what is no object");
  JsonMembers members(object, "instant");
  InertialFrame frame;
  frame.source = source;
  frame.sequence = members.count("sequence");
  frame.captured = members.time();
  const nlohmann::json* readings = members.find("readings");
  if (readings == nullptr) members.complain("readings", "is missing");
  if (members.error()) return tl::unexpected<Error>(*members.error());
  auto read = readings_in(*readings, std::nullopt);
  if (!read) return pass(read);
  frame.readings = std::move(*read);
  return inertial::checked(std::move(frame));
}

Result<void> read_instants(const nlohmann::json* instants, const SensorId& source,
                           OrientationsResource& out) {
  const std::size_t count = instants != nullptr && instants->is_array() ? instants->size() : 0;
  if (count == 0 || count > kMaxInstants)
    return fail(ErrorCode::Malformed, "instants", "is not a list of 1 to 100 instants");
  for (const nlohmann::json& each : *instants) {
    auto frame = read_instant(each, source);
    if (!frame) return pass(frame);
    if (!out.instants.empty() && frame->captured <= out.instants.back().captured)
      return fail(ErrorCode::Malformed, "instants", "are not in the order of their times");
    out.instants.push_back(std::move(*frame));
  }
  if (out.instants.back().captured != out.captured)
    return fail(ErrorCode::Malformed, "capturedNanoseconds", "is not that of the newest instant");
  return {};
}

}  // namespace

Node orientations_node(const OrientationsResource& orientations) {
  Node node{"", {"Orientations"}, {{"sequence", static_cast<std::int64_t>(orientations.sequence)}}};
  put_capture_time(node.properties, orientations.captured);
  node.properties.emplace_back("source", orientations.source);
  std::vector<Node> instants;
  for (const InertialFrame& each : orientations.instants) instants.push_back(instant_node(each));
  node.properties.emplace_back("instants", std::move(instants));
  return node;
}

std::string write(const OrientationsResource& orientations, Format format, const Place& place) {
  return write(orientations_node(orientations), format, place);
}

http::DocumentPtr orientations_document(std::shared_ptr<const OrientationsResource> orientations,
                                        const Place& place, http::DocumentOptions options) {
  auto variants = variants_of([orientations = std::move(orientations), place](Format format) {
    return write(*orientations, format, place);
  });
  return std::make_shared<const http::Document>(linked(std::move(variants), Kind::Source),
                                                std::move(options));
}

Result<std::vector<InertialReading>> read_readings(const nlohmann::json& readings,
                                                   Timestamp captured) {
  return readings_in(readings, captured);
}

Result<OrientationsResource> read_orientations(std::string_view bytes, Format format) {
  if (format != Format::Json && format != Format::JsonLd)
    return fail(ErrorCode::Unsupported, "orientations", "are read in JSON only");
  if (auto scanned = scan_orientations(bytes)) return std::move(*scanned);
  return parse_orientations(bytes);
}

Result<OrientationsResource> parse_orientations(std::string_view json) {
  const auto document = parse_json(json, kOrientationsLimits);
  if (!document) return pass(document);
  if (!document->is_object())
    return fail(ErrorCode::Malformed, "orientations", "is no JSON object");
  JsonMembers members(*document, "orientations");
  if (members.text("@type") != "Orientations") members.complain("@type", "is not \"Orientations\"");
  OrientationsResource out;
  out.sequence = members.count("sequence");
  out.captured = members.time();
  out.source = members.text("source");
  const auto source = SensorId::parse(out.source);
  if (!source) members.complain("source", "is no sensor id");
  if (members.error()) return tl::unexpected<Error>(*members.error());
  if (auto ok = read_instants(members.find("instants"), *source, out); !ok) return pass(ok);
  return out;
}

}  // namespace chorus::resource
