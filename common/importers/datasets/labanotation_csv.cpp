#include "common/importers/datasets/labanotation_csv.h"

#include <array>
#include <limits>

#include <fmt/format.h>

#include "common/importers/text_recording.h"
#include "common/importers/text_rows.h"

namespace chorus::importers {
namespace {

constexpr std::size_t kFieldsPerJoint = 4;  // x y z state
constexpr std::size_t kFields = 1 + kFieldsPerJoint * kJointCount;
constexpr std::int64_t kNanosecondsPerTick = 100;

/// An epoch that ticks may count from; `unix_epoch` is the beginning of 1970 in its ticks.
struct TickEpoch {
  std::string_view name;
  std::int64_t unix_epoch;
};
constexpr std::array<TickEpoch, 3> kTickEpochs{{
    {"ticks since 1970", 0},
    {"ticks since 1601 (FILETIME)", 116'444'736'000'000'000},
    {"ticks since 0001 (.NET)", 621'355'968'000'000'000},
}};
constexpr std::int64_t kTicks2010 = 12'623'040'000'000'000;  // since 1970
constexpr std::int64_t kTicks2100 = 41'024'448'000'000'000;  // since 1970

const TickEpoch* plausible_epoch(std::int64_t ticks) {
  for (const TickEpoch& epoch : kTickEpochs) {
    if (ticks >= epoch.unix_epoch + kTicks2010 && ticks < epoch.unix_epoch + kTicks2100)
      return &epoch;
  }
  return nullptr;
}

/// Turns ticks into capture times; the first row decides how.
struct TickClock {
  std::int64_t origin_ticks = 0;
  Timestamp origin;

  /// The capture time; none for rows before the first or more than a week after it, where the sum
  /// could overflow.
  [[nodiscard]] std::optional<Timestamp> at(std::int64_t ticks) const {
    constexpr std::int64_t kMaxSpanTicks = 7 * 24 * 3600 * 10'000'000LL;
    if (ticks < origin_ticks || ticks - origin_ticks > kMaxSpanTicks) return std::nullopt;
    return origin + Duration((ticks - origin_ticks) * kNanosecondsPerTick);
  }
};

TickClock start_clock(std::int64_t first_ticks, const ImportOptions& options,
                      std::map<std::string, std::string>& notes) {
  if (const TickEpoch* epoch = plausible_epoch(first_ticks)) {
    notes["time"] = fmt::format("UTC as recorded, {}", epoch->name);
    return {first_ticks, from_unix_ns((first_ticks - epoch->unix_epoch) * kNanosecondsPerTick)};
  }
  notes[kBootTicksNote] = std::to_string(first_ticks);
  notes["time"] = fmt::format(
      "the file counts from the sensor's start (first row {} ticks of 100 ns), not UTC; moved to "
      "{}",
      first_ticks, to_iso8601(options.start));
  return {first_ticks, options.start};
}

Result<Skeleton<SensorSpace>> read_joints(const LineReader& at, const Row& row) {
  Skeleton<SensorSpace> skeleton;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const std::size_t first = 1 + kFieldsPerJoint * j;
    std::array<double, 3> position{};
    if (const auto read = row.numbers(first, position, kMaxImported); !read) return pass(read);
    const auto state = row.natural(first + 3);
    if (!state) return pass(state);
    if (*state > 2)
      return at.malformed(
          fmt::format("value {} is tracking state {}; 0, 1 and 2 exist.", first + 4, *state));
    skeleton.joints[j].position = {position[0], position[1], position[2]};
    skeleton.joints[j].state = static_cast<JointState>(*state);
  }
  return skeleton;
}

Result<void> read_rows(LineReader& lines, const ImportOptions& options,
                       record::FrameRecording& recording) {
  std::optional<TickClock> clock;
  std::size_t repeated = 0;
  while (const auto line = lines.next_filled()) {
    const auto row = Row::split(lines, *line, ',', kFields);
    if (!row) return pass(row);
    const auto ticks = row->integer(0);
    if (!ticks) return pass(ticks);
    auto joints = read_joints(lines, *row);
    if (!joints) return pass(joints);
    if (!clock) clock = start_clock(*ticks, options, recording.notes);
    const auto captured = clock->at(*ticks);
    auto& frames = recording.frames;
    if (!captured || (!frames.empty() && *captured < frames.back().captured))
      return lines.malformed(fmt::format(
          "time {} goes back, or jumps by more than a week; rows must be in capture order.",
          *ticks));
    if (!frames.empty() && *captured == frames.back().captured) {
      ++repeated;
      continue;
    }
    if (frames.size() == options.limits.max_frames)
      return lines.malformed(fmt::format("is beyond the {} frames read at most.", frames.size()));
    frames.push_back({recording.sensor,
                      frames.size() + 1,
                      *captured,
                      *captured,
                      {{kOnlyBody, *captured, *joints}},
                      options.floor});
  }
  if (repeated > 0)
    recording.notes["repeated"] =
        fmt::format("{} rows repeated a capture time and were dropped", repeated);
  return {};
}

}  // namespace

Result<record::FrameRecording> read_labanotation_csv(const std::filesystem::path& file,
                                                     const ImportOptions& options) {
  return read_text_recording(file, options,
                             {"Kinect v2 (LabanotationSuite csv)", {}, "row", read_rows});
}

}  // namespace chorus::importers
