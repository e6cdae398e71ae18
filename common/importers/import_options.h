// What every importer needs beside the file: whose recording it is, where the floor is, and when it
// began.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::importers {

/// 2020-01-01T00:00:00Z: the first frame of recordings that do not say when they were made, so that
/// importing the same file twice gives the same bytes.
inline constexpr Timestamp kDefaultStart = from_unix_ns(1'577'836'800'000'000'000);

/// Memory stays below about four times max_text_bytes: the densest format spends 24 bytes a joint,
/// we 64.
struct ImportLimits {
  std::uintmax_t max_text_bytes = 256u << 20;
  std::uintmax_t max_json_bytes = 32u << 20;  ///< A JSON tree is some twenty times its text.
  std::size_t max_frames = 1'000'000;         ///< Nine hours at 30 Hz.
};

/// Farther than this from the sensor is a unit mistake (millimetres) or noise, not a person [m].
/// Tighter than kMaxCoordinate, because a foreign file does not say its unit.
inline constexpr double kMaxImported = 100.0;

struct ImportOptions {
  std::optional<SensorId> sensor;   ///< Default: named after the file.
  std::optional<FloorPlane> floor;  ///< In sensor space, put into every frame.
  /// Instead of `floor`, one for each of several inputs.
  std::vector<FloorPlane> floors = {};
  Timestamp start = kDefaultStart;  ///< First frame, where the file has no UTC of its own.
  bool rays = false;  ///< Of camera landmarks: their pixels' rays, without the depth of a fit.
  double metres_per_unit = 0.01;  ///< Of BVH, which does not say: centimetres by custom.
  ImportLimits limits;
};

/// "data/Ges01_wavehand.csv" -> Ges01_wavehand; other characters than [A-Za-z0-9_-] become '-'.
[[nodiscard]] Result<SensorId> sensor_named_after(const std::filesystem::path& file);

/// The sensor of the options, else sensor_named_after(file).
[[nodiscard]] Result<SensorId> sensor_for(const std::filesystem::path& file,
                                          const ImportOptions& options);

/// Reads "a,b,c,d" as the plane a x + b y + c z + d = 0 in sensor space, normal up.
[[nodiscard]] Result<FloorPlane> parse_floor(std::string_view text);

}  // namespace chorus::importers
