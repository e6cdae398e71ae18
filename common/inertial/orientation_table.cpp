#include "common/inertial/orientation_table.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/base/parse.h"
#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/inertial/text_columns.h"

namespace chorus::inertial {
namespace {

constexpr double kNearUnit = 0.02;

std::optional<Eigen::Quaterniond> quaternion_in(std::string_view cell) {
  Eigen::Vector4d v;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const std::size_t end = std::min(cell.find(','), cell.size());
    std::string_view word = cell.substr(0, end);
    while (word.starts_with(' ')) word.remove_prefix(1);
    const auto number = parse_finite(word);
    if (!number || (i < 3) == (end == cell.size())) return std::nullopt;
    v(i) = *number;
    cell.remove_prefix(std::min(end + 1, cell.size()));
  }
  if (std::abs(v.norm() - 1.0) > kNearUnit) return std::nullopt;
  return Eigen::Quaterniond(v(0), v(1), v(2), v(3)).normalized();
}

double stated_rate(const std::vector<std::string>& preamble) {
  for (const std::string& line : preamble) {
    if (!line.starts_with("DataRate=")) continue;
    const auto rate = parse_finite(std::string_view(line).substr(9));
    if (rate && *rate > 0) return *rate;
  }
  return 0.0;
}

Result<void> read_line(const TextColumns& lines, double time, std::vector<SensorLog>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (lines.cell(i + 1).empty())
      return fail(ErrorCode::Malformed, lines.where(),
                  "has nothing for column " + out[i].sensor + ": the line is too short");
    const auto q = quaternion_in(lines.cell(i + 1));
    if (!q)
      return fail(ErrorCode::Malformed, lines.where(),
                  "column " + out[i].sensor + " is no unit quaternion w,x,y,z");
    InertialReading reading;
    reading.sensor = out[i].sensor;
    reading.limb = limb_meant_by(out[i].sensor);
    reading.captured = from_unix_ns(std::llround(1e9 * time));
    reading.inertial_from_sensor = (y_up_from_z_up() * *q).normalized();
    out[i].readings.push_back(std::move(reading));
  }
  return {};
}

/// Sample counts instead of seconds: whole numbers that rise by 1 at a stated rate of more than 1.
void mend_times(std::vector<SensorLog>& logs, double rate) {
  for (SensorLog& log : logs) {
    const auto& all = log.readings;
    const double step = seconds(all[1].captured - all[0].captured);
    log.rate_hz = 1.0 / step;
    if (!(rate > 1.0) || std::abs(step - 1.0) > 1e-6) continue;
    log.rate_hz = rate;
    for (InertialReading& each : log.readings)
      each.captured = from_unix_ns(
          static_cast<std::int64_t>(static_cast<double>(to_unix_ns(each.captured)) / rate));
    log.notes.push_back("its times count samples; divided by DataRate");
  }
}

}  // namespace

Result<std::vector<SensorLog>> parse_orientation_table(std::string_view text,
                                                       std::string_view origin) {
  if (text.size() > kMaxLogBytes)
    return fail(ErrorCode::TooLarge, std::string(origin), "is too large");
  auto lines = TextColumns::of(text, origin, {"time"});
  if (!lines) return pass(lines);
  std::vector<SensorLog> out;
  for (std::size_t i = 1; i < lines->names().size(); ++i)
    out.push_back({lines->names()[i], 0.0, {}});
  if (out.empty() || out.size() > kMaxInertialSensors)
    return fail(ErrorCode::Malformed, std::string(origin), "needs 1 to 64 columns of orientations");
  double last = -1.0;
  while (lines->next()) {
    const auto time = lines->number(0);
    if (!time || *time <= last || *time > 1e9)
      return fail(ErrorCode::Malformed, lines->where(), "its times do not rise");
    last = *time;
    if (auto ok = read_line(*lines, *time, out); !ok) return pass(ok);
  }
  if (out.front().readings.empty())
    return fail(ErrorCode::Malformed, std::string(origin), "holds no orientations");
  if (out.front().readings.size() > 1) mend_times(out, stated_rate(lines->preamble()));
  return out;
}

std::string write_orientation_table(const std::vector<InertialFrame>& frames) {
  std::map<std::string, std::string> last;
  for (const InertialFrame& frame : frames)
    for (const InertialReading& each : frame.readings)
      if (each.inertial_from_sensor) last[each.sensor];
  std::string out = "DataType=Quaternion\nversion=3\nendheader\ntime";
  for (const auto& [name, cell] : last) out += "\t" + name;
  out += "\n";
  for (const InertialFrame& frame : frames) {
    for (const InertialReading& each : frame.readings) {
      if (!each.inertial_from_sensor) continue;
      const Eigen::Quaterniond q = y_up_from_z_up().conjugate() * *each.inertial_from_sensor;
      std::string& cell = last[each.sensor];
      cell.clear();
      for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
        char text[32];
        std::snprintf(text, sizeof(text), "%s%.9f", cell.empty() ? "" : ",", part);
        cell += text;
      }
    }
    if (std::ranges::any_of(last, [](const auto& each) { return each.second.empty(); })) continue;
    char time[40];
    std::snprintf(time, sizeof(time), "%.6f", seconds(frame.captured - frames.front().captured));
    out += time;
    for (const auto& [name, cell] : last) out += "\t" + cell;
    out += "\n";
  }
  return out;
}

}  // namespace chorus::inertial
