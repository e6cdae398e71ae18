// Recordings of inertial sensors from files that makers' programs write: one format a file
// (mtw_log.h, dot_csv.h, orientation_table.h).  Text in, values out; no files are opened here.
#pragma once

#include <string>
#include <vector>

#include "common/inertial/inertial_frame.h"

namespace chorus::inertial {

/// One sensor over time.  Times count from the log's own start (1970 where it states no date).
struct SensorLog {
  std::string sensor;
  double rate_hz = 0.0;  ///< As the file states it or as its clock shows.
  std::vector<InertialReading> readings;
  std::vector<std::string> notes = {};  ///< For people: gaps, repeated samples, what was left out.
};

/// A larger text is refused.
inline constexpr std::size_t kMaxLogBytes = 512u << 20;

/// Several logs of one take as frames: sensors whose times lie within half a sample are one frame.
/// Refuses two sensors of one name.
[[nodiscard]] Result<std::vector<InertialFrame>> frames_of(const std::vector<SensorLog>& logs,
                                                           const SensorId& source);

/// Names of logs that drift: sensors without a magnetometer, as a sentence each.
[[nodiscard]] std::vector<std::string> heading_notes(const std::vector<SensorLog>& logs);

}  // namespace chorus::inertial
