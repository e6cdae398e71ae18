#include "services/ctl/evaluate/inertial_files.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/base/file.h"
#include "common/inertial/dot_csv.h"
#include "common/inertial/mtw_log.h"
#include "common/inertial/orientation_table.h"
#include "common/motion/mvnx.h"
#include "common/record/cell_reader.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using inertial::InertialReading;
using inertial::SensorLog;
using Logs = std::vector<SensorLog>;

/// Of MVNX the segments that are limbs, as if each wore a sensor.
Result<Logs> logs_of_mvnx(std::string_view text, std::string_view origin) {
  const auto mvnx = motion::parse_mvnx(text, origin);
  if (!mvnx) return pass(mvnx);
  Logs out;
  for (std::size_t i = 0; i < mvnx->segments.size(); ++i) {
    SensorLog log{mvnx->segments[i].label, mvnx->rate_hz, {}};
    const auto limb = inertial::limb_meant_by(log.sensor);
    if (!limb) continue;
    for (const motion::MvnxFrame& frame : mvnx->frames) {
      if (i >= frame.orientations.size()) continue;
      InertialReading reading;
      reading.sensor = log.sensor;
      reading.limb = limb;
      reading.captured = from_unix_ns(std::llround(1e9 * frame.time));
      reading.inertial_from_sensor =
          (inertial::y_up_from_z_up() * frame.orientations[i]).normalized();
      log.readings.push_back(std::move(reading));
    }
    out.push_back(std::move(log));
  }
  if (!out.empty()) return out;
  return fail(ErrorCode::NotFound, std::string(origin), "has no segment that is a limb");
}

/// The sensors of one source; `prefix` keeps those of several sources apart.
void add_recorded(const std::vector<inertial::InertialFrame>& instants, const std::string& prefix,
                  Logs& out) {
  std::map<std::string, SensorLog> logs;
  for (const inertial::InertialFrame& instant : instants) {
    for (const InertialReading& reading : instant.readings) {
      SensorLog& log = logs[reading.sensor];
      if (!log.readings.empty() && reading.captured <= log.readings.back().captured) continue;
      log.readings.push_back(reading);
      InertialReading& kept = log.readings.back();
      kept.sensor = prefix + kept.sensor;
      if (!kept.limb) kept.limb = inertial::limb_meant_by(reading.sensor);
    }
  }
  for (auto& [name, log] : logs) {
    log.sensor = prefix + name;
    const double span = seconds(log.readings.back().captured - log.readings.front().captured);
    if (span > 0.0) log.rate_hz = static_cast<double>(log.readings.size() - 1) / span;
    out.push_back(std::move(log));
  }
}

/// What a recording has on /inertial/{id}/orientations, by the recorder's clock.
Result<Logs> logs_of_recording(const fs::path& file) {
  record::CellQuery query;
  query.inertial = true;
  query.raw = false;
  const auto cell = record::read_cell(file, query);
  if (!cell) return pass(cell);
  Logs out;
  for (const auto& [source, recorded] : cell->inertial)
    add_recorded(recorded.instants, cell->inertial.size() > 1 ? source.str() + "/" : "", out);
  if (!out.empty()) return out;
  return fail(ErrorCode::NotFound, file.string(),
              "has no topic /inertial/{id}/orientations: nothing that worn sensors said was "
              "recorded");
}

Result<Logs> one(Result<SensorLog> log) {
  if (!log) return pass(log);
  return Logs{std::move(*log)};
}

Result<Logs> logs_in(const fs::path& file) {
  if (file.extension() == ".mcap" || fs::is_directory(file)) return logs_of_recording(file);
  const auto text = read_file(file, inertial::kMaxLogBytes);
  if (!text) return pass(text);
  const std::string origin = file.filename().string();
  const std::string ending = file.extension().string();
  if (ending == ".sto") return inertial::parse_orientation_table(*text, origin);
  if (ending == ".mvnx") return logs_of_mvnx(*text, origin);
  if (ending == ".csv") return one(inertial::parse_dot_csv(*text, origin));
  if (ending == ".txt")
    return one(
        inertial::parse_mtw_log(*text, origin, inertial::mtw_sensor_of(file.stem().string())));
  return fail(
      ErrorCode::Unsupported, file.string(),
      "is no file of inertial sensors that we read: .sto, .mvnx, .csv (DOT), .txt (MT Manager), "
      ".mcap (a recording)");
}

Result<std::map<std::string, inertial::Limb>> stated_limbs(const std::vector<std::string>& limbs) {
  std::map<std::string, inertial::Limb> out;
  for (const std::string& each : limbs) {
    const std::size_t at = each.find('=');
    const auto limb =
        at == std::string::npos ? std::nullopt : inertial::limb_meant_by(each.substr(at + 1));
    if (!limb)
      return fail(ErrorCode::InvalidArgument, "--limb " + each,
                  "is not SENSOR=LIMB with a limb such as ShankLeft, ForearmRight, Pelvis");
    out[each.substr(0, at)] = *limb;
  }
  return out;
}

}  // namespace

Result<std::vector<SensorLog>> read_inertial_files(const std::vector<std::string>& files,
                                                   const std::vector<std::string>& limbs) {
  auto stated = stated_limbs(limbs);
  if (!stated) return pass(stated);
  Logs out;
  for (const std::string& file : files) {
    auto logs = logs_in(file);
    if (!logs) return pass(logs);
    std::move(logs->begin(), logs->end(), std::back_inserter(out));
  }
  for (SensorLog& log : out) {
    const auto limb = stated->find(log.sensor);
    if (limb == stated->end()) continue;
    for (InertialReading& reading : log.readings) reading.limb = limb->second;
    stated->erase(limb);
  }
  if (stated->empty()) return out;
  std::string known;
  for (const SensorLog& log : out) known += (known.empty() ? "" : ", ") + log.sensor;
  return fail(ErrorCode::NotFound, "--limb " + stated->begin()->first,
              "is no sensor of these files; there are: " + (known.empty() ? "none" : known));
}

}  // namespace chorus::ctl
