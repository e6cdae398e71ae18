// What an importer needs in addition to the file: the sensor, the floor, the start time, limits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/importers/up_axis.h"
#include "common/motion/joint_names.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::importers {

/// 2020-01-01T00:00:00Z: time of the first frame in recordings that do not say when they were made.
/// It is fixed, so that importing a file twice gives the same bytes.
inline constexpr Timestamp kDefaultStart = from_unix_ns(1'577'836'800'000'000'000);

/// Limits of one import.  Memory stays below about five times max_text_bytes: the densest text
/// format has 24 bytes per joint, a Joint takes 96.
struct ImportLimits {
  std::uintmax_t max_text_bytes = 256u << 20;
  /// A parsed JSON tree needs about twenty times the memory of its text.
  std::uintmax_t max_json_bytes = 32u << 20;
  std::size_t max_frames = 1'000'000;  ///< Nine hours at 30 Hz.
};

/// Limit of a distance from the sensor [m]: a larger one is due to a wrong unit (millimetres) or to
/// noise.  Tighter than kMaxCoordinate, because these files do not state their unit.
inline constexpr double kMaxImported = 100.0;

/// Limit of the time from the first frame of a recording to its last: a week [s].
inline constexpr double kMaxSeconds = 7 * 24 * 3600.0;

/// What relates the capture times of the files of one import (--clocks).
enum class Clocks {
  One,     ///< All are times of one clock, or of clocks that are synchronised: fused as they are.
  Own,     ///< Each file has a clock of its own that is right to about half a second.
  Unknown  ///< The files begin at unknown times, or nothing is known.
};

/// The id of the person in formats that know only one.
inline constexpr BodyId kOnlyBody{1};

struct ImportOptions {
  std::optional<SensorId> sensor;   ///< For a single input only.  None: sensor_named_after(file).
  std::optional<FloorPlane> floor;  ///< In sensor space; put into every frame.
  /// If not empty, one for each input; `floor` is then ignored.
  std::vector<FloorPlane> floors = {};
  Timestamp start = kDefaultStart;  ///< Time of the first frame, if the file has no UTC.
  bool rays = false;  ///< Turns camera landmarks into rays instead of estimating their depth.
  /// Instead of the unit that the file states or its format has (--unit).  None for BVH, which does
  /// not state it: cm, or whatever makes people of a person's size.
  std::optional<double> metres_per_unit = {};
  std::optional<UpAxis> up = {};    ///< The file's axis that points up (--up), instead of its own.
  motion::JointChoice joints = {};  ///< For motion files: points of joints (--joints).
  /// What is known of the clocks of the files of one import; none: what is usual for the format.
  std::optional<Clocks> clocks = {};
  ImportLimits limits;
};

/// "data/Ges01_wavehand.csv" -> Ges01_wavehand.  Characters other than [A-Za-z0-9_-] become '-',
/// and what follows the first 64 characters is cut off.
[[nodiscard]] Result<SensorId> sensor_named_after(const std::filesystem::path& file);

/// The sensor in the options, if set; otherwise sensor_named_after(file).
[[nodiscard]] Result<SensorId> sensor_for(const std::filesystem::path& file,
                                          const ImportOptions& options);

/// Reads "a,b,c,d" as the plane a x + b y + c z + d = 0 in sensor space.  The normal
/// points to the side where the sensor is, which is up.
[[nodiscard]] Result<FloorPlane> parse_floor(std::string_view text);

}  // namespace chorus::importers
