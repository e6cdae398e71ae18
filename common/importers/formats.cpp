#include "common/importers/formats.h"

#include <algorithm>
#include <set>
#include <string>

#include <fmt/format.h>

#include "common/base/fnv.h"
#include "common/base/median.h"
#include "common/importers/datasets/keraal_text.h"
#include "common/importers/datasets/labanotation_csv.h"
#include "common/importers/datasets/ntu_skeleton.h"
#include "common/importers/datasets/nw_ucla_json.h"
#include "common/importers/motion_file.h"
#include "common/importers/own_files.h"

namespace chorus::importers {
namespace {

using FileReader = Result<record::FrameRecording> (*)(const std::filesystem::path&,
                                                      const ImportOptions&);
using SetReader = Result<ImportedSet> (*)(const std::filesystem::path&, const ImportOptions&);

Result<ImportedSet> import_cameras(const std::filesystem::path& folder,
                                   const ImportOptions& options);

template <MotionFormat format>
Result<ImportedSet> import_motion(const std::filesystem::path& file, const ImportOptions& options) {
  auto motion = read_motion_file(file, format, options);
  if (!motion) return pass(motion);
  ImportedSet set;
  set.world_from_sensor.emplace(motion->recording.sensor, Eigen::Isometry3d::Identity());
  set.spaces.emplace(motion->recording.sensor, motion->space);
  set.recordings.push_back(std::move(motion->recording));
  set.truth = std::move(motion->truth);
  return set;
}

/// How a format is read: either one file is one sensor, or one input is the whole set.
struct ReaderRow {
  FileFormat format;
  FileReader file = nullptr;
  SetReader set = nullptr;
  /// Metres in its unit, for formats whose reader applies options.metres_per_unit itself.
  std::optional<double> metres = {};
};

constexpr std::array<ReaderRow, kFormats.size()> kReaders{{
    {FileFormat::Labanotation, &read_labanotation_csv},
    {FileFormat::Ntu, &read_ntu_skeleton},
    {FileFormat::NwUcla, &read_nw_ucla_json},
    {FileFormat::Keraal, &read_keraal_text},
    {FileFormat::Pose2Sim, nullptr, &import_cameras},
    {FileFormat::C3d, nullptr, &import_motion<MotionFormat::C3d>},
    {FileFormat::Trc, nullptr, &import_motion<MotionFormat::Trc>},
    {FileFormat::Bvh, nullptr, &import_motion<MotionFormat::Bvh>},
    {FileFormat::Htr, nullptr, &import_motion<MotionFormat::Htr>},
    {FileFormat::Mvnx, nullptr, &import_motion<MotionFormat::Mvnx>},
    {FileFormat::Csv, &read_joint_csv, nullptr, 1.0},
    {FileFormat::Ndjson, &read_frame_lines},
    {FileFormat::AzureKinect, &read_azure_kinect_csv, nullptr, 0.001},
}};

const ReaderRow& reader_of(FileFormat format) {
  return *std::find_if(kReaders.begin(), kReaders.end(),
                       [&](const ReaderRow& row) { return row.format == format; });
}

constexpr std::string_view kCamerasFile = "cameras.json";
constexpr std::string_view kTruthFile = "triangulated.json";

/// The landmark files of a folder: one per calibrated camera and named after it, in the order of
/// cameras.json.
Result<ImportedSet> import_cameras(const std::filesystem::path& folder,
                                   const ImportOptions& options) {
  std::error_code unknown;
  if (std::filesystem::is_regular_file(folder, unknown))
    return fail(ErrorCode::InvalidArgument, folder.string(),
                "is a file; name the folder with cameras.json and the landmarks of each camera.");
  const auto cameras = read_cameras(folder / kCamerasFile, options.limits);
  if (!cameras) return pass(cameras);
  ImportedSet set;
  for (const CalibratedCamera& camera : *cameras) {
    const auto view = read_camera_view(folder / (camera.sensor.str() + ".json"), *cameras, options);
    if (!view) return pass(view);
    set.recordings.push_back(*view);
    set.world_from_sensor.emplace(camera.sensor, camera.world_from_sensor);
  }
  std::error_code ignored;
  if (!std::filesystem::exists(folder / kTruthFile, ignored)) return set;
  auto truth = read_triangulation(folder / kTruthFile, options.limits);
  if (!truth) return pass(truth);
  set.truth = std::move(*truth);
  return set;
}

/// True if the input is an empty file or a folder without a usable file; the other inputs are then
/// imported without it.
bool is_empty(const std::filesystem::path& input, const Error& why) {
  std::error_code ignored;
  if (std::filesystem::is_directory(input, ignored)) return why.code == ErrorCode::NotFound;
  return std::filesystem::file_size(input, ignored) == 0;
}

Result<ImportedSet> import_each(const ReadRecording& read,
                                const std::vector<std::filesystem::path>& inputs,
                                const ImportOptions& options, double metres_per_unit) {
  ImportedSet set;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    ImportOptions own = options;
    if (!options.floors.empty()) own.floor = options.floors[i];
    auto recording = read(inputs[i], own, i);
    if (!recording && is_empty(inputs[i], recording.error())) {
      set.empty.push_back(recording.error());
      continue;
    }
    if (!recording) return pass(recording);
    FileSpace space{metres_per_unit};
    if (own.up) space.ours_from_file = ours_from_up(*own.up);
    drop_nowhere(*recording);
    convert(*recording, 1.0, space.ours_from_file);
    set.spaces.emplace(recording->sensor, space);
    set.recordings.push_back(std::move(*recording));
  }
  if (set.recordings.empty()) return tl::unexpected<Error>(set.empty.front());
  return set;
}

Duration boot_time_of(const record::FrameRecording& recording) {
  constexpr std::int64_t kNanosecondsPerTick = 100;
  return Duration(std::stoll(recording.notes.at(kBootTicksNote)) * kNanosecondsPerTick);
}

/// Keeps the time between files whose times count from the start of one sensor; that is assumed if
/// all of these times fit into one afternoon.  All other files stay unchanged.
void keep_common_counter(std::vector<record::FrameRecording>& recordings) {
  constexpr Duration kOneAfternoon = std::chrono::hours(6);
  std::vector<record::FrameRecording*> counted;
  for (auto& recording : recordings) {
    if (recording.notes.contains(kBootTicksNote)) counted.push_back(&recording);
  }
  if (counted.size() < 2) return;
  const auto [first, last] = std::ranges::minmax(
      counted, {}, [](const auto* recording) { return boot_time_of(*recording); });
  if (boot_time_of(*last) - boot_time_of(*first) > kOneAfternoon) return;
  for (record::FrameRecording* recording : counted) {
    const Duration later = boot_time_of(*recording) - boot_time_of(*first);
    for (SensorFrame& frame : recording->frames) {
      frame.captured += later;
      frame.received += later;
      for (BodyFrame& body : frame.bodies) body.captured += later;
    }
    recording->notes["time"] += fmt::format("; {:.3f} s after {}, taken for counts of one clock",
                                            seconds(later), first->sensor.str());
  }
}

Result<void> check_statures(const ImportedSet& set) {
  for (const auto& recording : set.recordings) {
    const auto space = set.spaces.find(recording.sensor);
    const auto ok =
        check_stature(recording, space == set.spaces.end() ? FileSpace{} : space->second);
    if (!ok) return pass(ok);
  }
  return {};
}

Result<void> refuse_repeated_sensors(const std::vector<record::FrameRecording>& recordings) {
  std::set<SensorId> seen;
  for (const auto& recording : recordings) {
    if (!seen.insert(recording.sensor).second)
      return fail(
          ErrorCode::InvalidArgument, recording.sensor.str(),
          "is the sensor of two inputs. Import one take at a time, each into its own folder.");
  }
  return {};
}

/// The median step between frames; one second if there is only one frame.
Duration median_step(const std::vector<SensorFrame>& frames) {
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < frames.size(); ++i)
    steps.push_back(frames[i].captured - frames[i - 1].captured);
  if (steps.empty()) return std::chrono::seconds(1);
  return median(std::move(steps));
}

void note_set_times(std::vector<record::FrameRecording>& recordings) {
  Timestamp origin = recordings.front().frames.front().captured;
  Timestamp end = origin;
  for (const auto& recording : recordings) {
    origin = std::min(origin, recording.frames.front().captured);
    end = std::max(end, recording.frames.back().captured + median_step(recording.frames));
  }
  for (auto& recording : recordings) {
    recording.notes["set_origin"] = to_iso8601(origin);
    recording.notes["set_period_ns"] = std::to_string((end - origin).count());
  }
}

/// Several files of these formats come from hosts of their own more often than not.
bool has_own_clocks(FileFormat format, std::size_t files) {
  return files > 1 && (format == FileFormat::Csv || format == FileFormat::Ndjson);
}

/// Notes what is known of the clocks, and which recordings were imported together: other imports
/// have other clocks.
void note_clocks(std::vector<record::FrameRecording>& recordings, Clocks clocks) {
  constexpr std::array<const char*, 3> kNames{"one", "own", "unknown"};
  std::string all;
  for (const auto& recording : recordings)
    all += recording.sensor.str() + ' ' + to_iso8601(recording.frames.front().captured) + ' ' +
           std::to_string(recording.frames.size()) + '\n';
  for (auto& recording : recordings) {
    recording.notes["clocks"] = kNames[static_cast<std::size_t>(clocks)];
    recording.notes["set"] = fmt::format("{:016x}", fnv1a(all));
  }
}

/// Finishes any imported set: refuses copies and repeated sensors, and makes the times of its files
/// consistent.
Result<ImportedSet> finished(Result<ImportedSet> set, Clocks clocks) {
  if (!set) return set;
  if (const auto distinct = refuse_copies(set->recordings); !distinct) return pass(distinct);
  if (const auto named = refuse_repeated_sensors(set->recordings); !named) return pass(named);
  if (const auto sizes = check_statures(*set); !sizes) return pass(sizes);
  keep_common_counter(set->recordings);
  note_set_times(set->recordings);
  note_clocks(set->recordings, clocks);
  return set;
}

}  // namespace

std::optional<FileFormat> format_named(std::string_view name) {
  for (const FormatRow& row : kFormats) {
    if (row.name == name) return row.format;
  }
  return std::nullopt;
}

Result<ImportedSet> import_recordings(const std::vector<std::filesystem::path>& inputs,
                                      const ImportOptions& options, const ReadRecording& read,
                                      double metres_per_unit) {
  if (inputs.empty())
    return fail(ErrorCode::InvalidArgument, "import", "needs at least one input.");
  if (options.sensor && inputs.size() != 1)
    return fail(ErrorCode::InvalidArgument, "import", "can name the sensor of one input only.");
  if (!options.floors.empty() && options.floors.size() != inputs.size())
    return fail(ErrorCode::InvalidArgument, "import",
                fmt::format("takes one floor for all, or one for each of the {} inputs, not {}.",
                            inputs.size(), options.floors.size()));
  return finished(import_each(read, inputs, options, metres_per_unit),
                  options.clocks.value_or(Clocks::One));
}

Result<ImportedSet> import_files(FileFormat format,
                                 const std::vector<std::filesystem::path>& inputs,
                                 const ImportOptions& options) {
  const ReaderRow& row = reader_of(format);
  if (row.set != nullptr && inputs.size() != 1)
    return fail(ErrorCode::InvalidArgument, "import",
                "takes one folder of camera views, or one file of motion, at a time.");
  if (row.set != nullptr && !options.floors.empty())
    return fail(ErrorCode::InvalidArgument, "import", "takes one floor of this format.");
  if (row.set != nullptr)
    return finished(row.set(inputs.front(), options), options.clocks.value_or(Clocks::One));
  const double metres = options.metres_per_unit.value_or(row.metres.value_or(1.0));
  ImportOptions asked = options;
  if (!asked.clocks && has_own_clocks(format, inputs.size())) asked.clocks = Clocks::Unknown;
  auto set = import_recordings(
      inputs, asked,
      [&](const std::filesystem::path& file, const ImportOptions& own, std::size_t) {
        auto recording = row.file(file, own);
        if (recording && !row.metres) convert(*recording, metres, Eigen::Matrix3d::Identity());
        return recording;
      },
      metres);
  const bool plain = format == FileFormat::Csv || format == FileFormat::Ndjson;
  if (set && plain && inputs.size() == 1 && !options.floor)
    set->world_from_sensor.emplace(set->recordings.front().sensor, Eigen::Isometry3d::Identity());
  return set;
}

}  // namespace chorus::importers
