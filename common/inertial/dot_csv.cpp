#include "common/inertial/dot_csv.h"

#include <array>
#include <cmath>

#include "common/base/parse.h"
#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/inertial/mtw_log.h"
#include "common/inertial/text_columns.h"

namespace chorus::inertial {
namespace {

constexpr unsigned kClockBits = 32;
constexpr double kUnitQuaternion = 0.02;  // tolerance
constexpr double kMostDegrees = 360.0;

std::string said_in(const std::vector<std::string>& preamble, std::string_view name) {
  for (const std::string& line : preamble) {
    if (!line.starts_with(name)) continue;
    std::string_view value = std::string_view(line).substr(name.size());
    while (!value.empty() &&
           std::string_view(":, \t\"").find(value.front()) != std::string_view::npos)
      value.remove_prefix(1);
    return std::string(value.substr(0, value.find_first_of(",\t\"")));
  }
  return {};
}

using Names = std::array<std::string_view, 3>;

std::optional<Eigen::Vector3d> three(const TextColumns& text, const Names& names) {
  Eigen::Vector3d out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = text.number(text.column(names[i]));
    if (!value) return std::nullopt;
    out(static_cast<Eigen::Index>(i)) = *value;
  }
  return out;
}

/// Identity's norm for a fine one; another where the line is damaged.
std::optional<Eigen::Quaterniond> orientation_of(const TextColumns& text) {
  const auto w = text.number(text.column("Quat_W"));
  const auto xyz = three(text, {"Quat_X", "Quat_Y", "Quat_Z"});
  if (w && xyz) return Eigen::Quaterniond(*w, xyz->x(), xyz->y(), xyz->z());
  const auto euler = three(text, {"Euler_X", "Euler_Y", "Euler_Z"});
  if (!euler) return std::nullopt;
  if (euler->cwiseAbs().maxCoeff() > kMostDegrees) return Eigen::Quaterniond(0, 0, 0, 0);
  return Eigen::AngleAxisd(deg(euler->z()), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(deg(euler->y()), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(deg(euler->x()), Eigen::Vector3d::UnitX());
}

Result<InertialReading> dot_reading(const TextColumns& text) {
  const auto orientation = orientation_of(text);
  if (!orientation)
    return fail(ErrorCode::Malformed, text.where(),
                "has no orientation; export Quat_ or Euler_ columns");
  if (std::abs(orientation->norm() - 1.0) > kUnitQuaternion)
    return fail(ErrorCode::Malformed, text.where(), "its orientation is no rotation");
  InertialReading out;
  out.inertial_from_sensor = normalised_or_identity(y_up_from_z_up() * *orientation);
  out.acceleration = three(text, {"Acc_X", "Acc_Y", "Acc_Z"});
  if (const auto free = three(text, {"FreeAcc_X", "FreeAcc_Y", "FreeAcc_Z"}))
    out.free_acceleration = y_up_from_z_up() * *free;
  if (const auto rate = three(text, {"Gyr_X", "Gyr_Y", "Gyr_Z"})) out.rate = *rate * deg(1.0);
  out.field = three(text, {"Mag_X", "Mag_Y", "Mag_Z"});
  return out;
}

}  // namespace

Result<SensorLog> parse_dot_csv(std::string_view text, std::string_view origin) {
  if (text.size() > kMaxLogBytes)
    return fail(ErrorCode::TooLarge, std::string(origin), "is too large");
  auto lines = TextColumns::of(text, origin, {"PacketCounter", "SampleTimeFine"});
  if (!lines) return pass(lines);
  const auto clock = lines->column("SampleTimeFine");
  if (!clock)
    return fail(ErrorCode::Malformed, std::string(origin),
                "has no column SampleTimeFine; export it");
  SensorLog log;
  log.sensor = said_in(lines->preamble(), "DeviceTag");
  if (log.sensor.empty()) log.sensor = said_in(lines->preamble(), "DeviceId");
  if (log.sensor.empty()) log.sensor = origin;
  WrappedCounter counter(kClockBits);
  std::size_t repeated = 0;
  std::uint64_t last = 0;
  while (lines->next()) {
    const auto count = parse_number<std::uint64_t>(lines->cell(*clock));
    const auto us = count ? counter.next(*count) : std::nullopt;
    if (!us)
      return fail(ErrorCode::Malformed, lines->where(), "its clock is no number or runs backward");
    const bool again = !log.readings.empty() && *us == last;
    repeated += again ? 1 : 0;
    last = *us;
    if (again) continue;
    auto reading = dot_reading(*lines);
    if (!reading) return pass(reading);
    reading->sensor = log.sensor;
    reading->captured = from_unix_ns(static_cast<std::int64_t>(*us) * 1000);
    log.readings.push_back(std::move(*reading));
  }
  if (log.readings.size() < 2)
    return fail(ErrorCode::Malformed, std::string(origin), "holds no samples");
  log.rate_hz = static_cast<double>(log.readings.size() - 1) * 1e6 / static_cast<double>(last);
  if (repeated > 0) log.notes.push_back(std::to_string(repeated) + " samples repeat the clock");
  return log;
}

}  // namespace chorus::inertial
