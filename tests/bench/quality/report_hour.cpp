// `chorus report` of a recording of an hour of six sensors with fused frames.
#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "common/record/cell_writer.h"
#include "fusion-server/wire/registration_file.h"
#include "tests/bench/live/chorus_run.h"
#include "tests/bench/live/scratch_folder.h"
#include "tests/bench/quality/report_cases.h"
#include "tests/bench/quality/simulated_day.h"

namespace chorus::bench {
namespace {

constexpr double kMostSeconds = 30.0;  // the claim, for an hour
constexpr Duration kMinute = std::chrono::seconds(60);

int minutes(const Report& report) {
  const char* wanted = std::getenv("CHORUS_REPORT_MINUTES");
  if (wanted != nullptr) return std::clamp(std::atoi(wanted), 1, 600);
  return report.quick() ? 1 : 60;
}

struct Recorder {
  record::CellWriter& writer;
  Duration later;
  std::uint64_t sequences = 0;  ///< Frames of a sensor before this minute.

  Result<void> take(const SensorFrame& frame) {
    SensorFrame moved = frame;
    move_in_time(moved, later);
    moved.sequence += sequences;
    return writer.write(record::RawFrame{
        moved.sensor,
        std::make_shared<const resource::FrameResource>(resource::to_resource(moved)),
        moved.received + later,
        moved.floor,
        {}});
  }
  Result<void> take(resource::FrameResource fused) {
    fused.captured += later;
    for (auto& body : fused.bodies) body.captured += later;
    const Timestamp at = fused.captured;
    return writer.write(
        record::FusedFrame{at, at + std::chrono::milliseconds(120), [fused] { return fused; }});
  }
};

/// One minute of the day, in the order in which a recorder gets it.
Result<void> write_minute(const Day& day, const std::vector<const SensorFrame*>& frames,
                          Recorder recorder) {
  auto next = frames.begin();
  for (const resource::FrameResource& fused : day.fused) {
    for (; next != frames.end() &&
           (*next)->received <= fused.captured + std::chrono::milliseconds(120);
         ++next)
      if (auto ok = recorder.take(**next); !ok) return ok;
    if (auto ok = recorder.take(fused); !ok) return ok;
  }
  return {};
}

Result<void> write_hour(const std::filesystem::path& file, const Day& day, int length) {
  auto writer = record::CellWriter::create(file, {});
  if (!writer) return pass(writer);
  if (auto ok = writer->write(wire::places_changed(day.work.begin, day.registration)); !ok)
    return ok;
  std::vector<const SensorFrame*> frames;
  for (const auto& track : day.tracks)
    for (const SensorFrame& frame : track.frames) frames.push_back(&frame);
  std::ranges::stable_sort(frames, {}, [](const SensorFrame* frame) { return frame->received; });
  for (int minute = 0; minute < length; ++minute) {
    const auto sequences = static_cast<std::uint64_t>(minute) * 10'000;
    if (auto ok = write_minute(day, frames, {*writer, minute * kMinute, sequences}); !ok) return ok;
  }
  return writer->close();
}

}  // namespace

Result<void> report_hour(Report& report) {
  DaySetting setting;
  setting.work.seed = report.seed();
  setting.work.length = kMinute;
  const auto day = simulated_day(setting);
  if (!day) return pass(day);
  const auto scratch = ScratchFolder::make();
  if (!scratch) return pass(scratch);
  const std::filesystem::path file = scratch->path() / "hour.mcap";
  const int length = minutes(report);
  if (auto ok = write_hour(file, *day, length); !ok) return ok;
  const auto cost =
      run_chorus({"report", file.string(), "--out", (scratch->path() / "report.html").string()}, 1);
  if (!cost) return pass(cost);
  report.row("hour", "recording_min", length, "min");
  report.row("hour", "file_mb", static_cast<double>(std::filesystem::file_size(file)) / 1e6, "MB");
  report.row("hour", "run_s", cost->seconds, "s");
  report.row("hour", "rss_mb", cost->rss_mb, "MB");
  const double of_an_hour = cost->seconds * 60.0 / length;
  report.condition(
      fmt::format("hour: the report of an hour takes at most 30 s (is {:.1f})", of_an_hour),
      of_an_hour <= kMostSeconds);
  report.note(
      "hour: one simulated minute, written sixty times; CHORUS_REPORT_MINUTES sets the length");
  return {};
}

}  // namespace chorus::bench
