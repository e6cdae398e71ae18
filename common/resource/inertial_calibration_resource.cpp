#include "common/resource/inertial_calibration_resource.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "common/base/json.h"
#include "common/resource/json_members.h"

namespace chorus::resource {
namespace {

using inertial::InertialCalibration;
using inertial::SensorCalibration;

constexpr JsonLimits kCalibrationLimits{.bytes = 500'000, .nesting = 6};
constexpr std::array<const char*, 4> kMount{"qx", "qy", "qz", "qw"};
constexpr int kAngle = 6;     ///< Decimals of angles [rad] and quaternions.
constexpr int kVariance = 9;  ///< Of variances [rad^2].
constexpr Eigen::Index kUnknowns = 4;
constexpr std::size_t kTriangleSize = 10;
constexpr double kUnitWithin = 0.05;  ///< As inertial::checked().

Node sensor_calibration_node(const SensorCalibration& each) {
  Node node{"_", {"SensorCalibration"}, {{"inertialSensor", each.sensor}}};
  auto& out = node.properties;
  out.emplace_back("limb", std::string(name_of(each.limb)));
  out.emplace_back("heading", Decimal{each.heading, kAngle});
  for (std::size_t i = 0; i < kMount.size(); ++i)
    out.emplace_back(kMount[i],
                     Decimal{each.limb_from_sensor.coeffs()[static_cast<Eigen::Index>(i)], kAngle});
  std::vector<Decimal> triangle;
  for (Eigen::Index row = 0; row < kUnknowns; ++row) {
    for (Eigen::Index column = row; column < kUnknowns; ++column)
      triangle.push_back({each.covariance(row, column), kVariance});
  }
  out.emplace_back("covariance", std::move(triangle));
  out.emplace_back("residual", Decimal{each.residual, kAngle});
  out.emplace_back("predictionSigma", Decimal{each.prediction_sigma, kAngle});
  return node;
}

/// The upper triangle, whose elements are numbers or, in JSON-LD, strings.
void read_triangle(const nlohmann::json& list, JsonMembers& members, SensorCalibration& out) {
  if (!list.is_array() || list.size() != kTriangleSize)
    return members.complain("covariance", "is not a list of 10 numbers");
  std::size_t i = 0;
  for (Eigen::Index row = 0; row < kUnknowns; ++row) {
    for (Eigen::Index column = row; column < kUnknowns; ++column, ++i) {
      const nlohmann::json element{{"covariance", list[i]}};
      JsonMembers one(element, "covariance");
      const auto value = one.number("covariance");
      if (!value || (row == column && *value < 0.0))
        return members.complain("covariance", "holds what is no number or a negative variance");
      out.covariance(row, column) = out.covariance(column, row) = *value;
    }
  }
}

Result<SensorCalibration> read_sensor_calibration(const std::string& sensor,
                                                  const nlohmann::json& object) {
  if (!object.is_object()) return fail(ErrorCode::Malformed, sensor, "is no object");
  JsonMembers members(object, "sensor " + sensor);
  SensorCalibration out;
  out.sensor = sensor;
  if (const auto limb = inertial::limb_named(members.text("limb"))) {
    out.limb = *limb;
  } else {
    members.complain("limb", "names no limb; \"ForearmLeft\" would be one");
  }
  out.heading = members.number("heading").value_or(0.0);
  const auto q = members.numbers(kMount).value_or(std::array<double, 4>{});
  out.limb_from_sensor = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  const double norm = out.limb_from_sensor.norm();
  if (!(std::abs(norm - 1.0) <= kUnitWithin))
    members.complain("qx", "is of a mount that is missing or not of unit length");
  out.limb_from_sensor.normalize();
  if (const auto* covariance = members.find("covariance")) read_triangle(*covariance, members, out);
  out.residual = members.number("residual").value_or(0.0);
  out.prediction_sigma = members.number("predictionSigma").value_or(0.0);
  if (members.error()) return tl::unexpected<Error>(*members.error());
  return out;
}

}  // namespace

Node inertial_calibration_node(const InertialCalibration& calibration) {
  std::vector<Node> sensors;
  for (const SensorCalibration& each : calibration.sensors)
    sensors.push_back(sensor_calibration_node(each));
  return {"",
          {"InertialCalibration"},
          {{"source", calibration.source},
           {"made", calibration.made},
           {"madeNanoseconds", to_unix_ns(calibration.made)},
           {"calibrations", std::move(sensors)}}};
}

std::string write(const InertialCalibration& calibration, Format format, const Place& place) {
  return write(inertial_calibration_node(calibration), format, place);
}

Result<InertialCalibration> read_inertial_calibration(std::string_view bytes, Format format) {
  if (format != Format::Json && format != Format::JsonLd)
    return fail(ErrorCode::Unsupported, "calibration", "is read in JSON only");
  const auto document = parse_json(bytes, kCalibrationLimits);
  if (!document) return pass(document);
  if (!document->is_object()) return fail(ErrorCode::Malformed, "calibration", "is no JSON object");
  JsonMembers members(*document, "calibration");
  if (members.text("@type") != "InertialCalibration")
    members.complain("@type", "is not \"InertialCalibration\"");
  InertialCalibration out;
  out.source = members.text("source");
  out.made = members.time("madeNanoseconds");
  const auto* sensors = members.find("calibrations");
  if (sensors == nullptr || !sensors->is_object() ||
      sensors->size() > inertial::kMaxInertialSensors)
    members.complain("calibrations", "is no object with a member for each of at most 64 sensors");
  if (members.error()) return tl::unexpected<Error>(*members.error());
  for (const auto& [sensor, one] : sensors->items()) {
    auto read = read_sensor_calibration(sensor, one);
    if (!read) return pass(read);
    out.sensors.push_back(std::move(*read));
  }
  return out;
}

}  // namespace chorus::resource
