// Text logs of Xsens MT Manager (MTw, Awinda): one sensor a file, quaternions or rotation matrices.
//
// "//" lines, a line of names, then a line per sample.  PacketCounter counts samples in 16 bits and
// wraps; gaps in it are lost samples.  Quaternions are w x y z, matrices Mat[row][column]; both
// turn sensor axes to a world with +z up (docs of MT Manager; read here from logs of three
// firmwares).
#pragma once

#include "common/inertial/sensor_log.h"

namespace chorus::inertial {

/// `sensor` is the serial number, for example from the file's name (mtw_sensor_of).  Refuses logs
/// without orientation, without a counter, with counters that run backward, and non-unit
/// quaternions, by line.
[[nodiscard]] Result<SensorLog> parse_mtw_log(std::string_view text, std::string_view origin,
                                              const std::string& sensor);

/// "00B40B91" of "S02-Trial-Walk-1-000_00B40B91.txt"; the whole stem if there is no such ending.
[[nodiscard]] std::string mtw_sensor_of(std::string_view file_stem);

/// A counter of `bits` bits that wraps, made continuous.  Nothing for a step backward by less than
/// half of its range; a repeated value steps by 0.
class WrappedCounter {
 public:
  explicit WrappedCounter(unsigned bits) : range_(std::uint64_t{1} << bits) {}
  [[nodiscard]] std::optional<std::uint64_t> next(std::uint64_t value);

 private:
  std::uint64_t range_;
  std::optional<std::uint64_t> last_;
  std::uint64_t total_ = 0;
};

}  // namespace chorus::inertial
