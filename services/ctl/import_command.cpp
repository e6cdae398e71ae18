// chorus import FORMAT INPUT... --out DIR: turns files of other programs into recordings.
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/importers/doubts.h"
#include "common/importers/formats.h"
#include "common/record/frame_recording.h"
#include "common/record/frame_schema.h"
#include "common/record/fused_frames.h"
#include "common/record/recording_stream.h"
#include "common/resource/frame_resource.h"
#include "fusion-server/server/registration_store.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/command.h"
#include "services/ctl/console.h"
#include "services/ctl/number_range.h"
#include "services/ctl/pose_import.h"
#include "services/ctl/text_file.h"
#include "services/ctl/video_import.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

struct ImportArguments {
  std::string format;
  std::vector<std::string> inputs;
  std::string out;
  std::vector<std::string> floors;
  std::string start;
  std::string sensor;
  std::string unit = "cm";
  bool rays = false;
  bool json = false;
  std::vector<std::string> lenses;
  std::string model = "movenet";
  double rate_hz = 30.0;
  bool unit_given = false;
  bool rate_given = false;
};

/// The formats that come from cameras: only these take the cameras' lenses (--intrinsics).
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kCameraFormats{
    {{"video", "what a runner finds in videos, one camera each, as rays"},
     {"openpose", "OpenPose's JSON, also that of RTMLib and Pose2Sim: a folder a camera, as rays"},
     {"mmpose", "MMPose's predictions in JSON: a file a video, or a folder of pictures, as rays"}}};

bool is_of_cameras(std::string_view name) {
  return std::any_of(kCameraFormats.begin(), kCameraFormats.end(),
                     [&](const auto& row) { return row.first == name; });
}

/// A CLI11 check that says why a text is refused.
template <class Parse>
std::function<std::string(const std::string&)> readable_by(Parse parse) {
  return [parse](const std::string& text) {
    const auto value = parse(text);
    return value ? std::string() : to_string(value.error());
  };
}

std::string check_format(const std::string& name) {
  if (is_of_cameras(name) || importers::format_named(name)) return {};
  std::string known;
  for (const auto& row : kCameraFormats) known += fmt::format(" {}", row.first);
  for (const auto& row : importers::kFormats) known += fmt::format(" {}", row.name);
  return fmt::format("there is no format \"{}\"; known are{}", name, known);
}

/// Published extrinsics as a registration that is valid: the first sensor is the master.
Registration registration_of(const importers::ImportedSet& set) {
  Registration registration;
  registration.version = 1;
  registration.verdict = Verdict::Good;
  registration.solved = set.recordings.front().frames.front().captured;
  registration.master = set.recordings.front().sensor;
  for (const auto& [sensor, world_from_sensor] : set.world_from_sensor) {
    Extrinsics& place = registration.sensors[sensor];
    place.world_from_sensor = world_from_sensor;
    place.chain = {sensor};
  }
  return registration;
}

resource::BodyResource truth_body(const importers::TruthFrame& truth, Timestamp captured) {
  resource::BodyResource body;
  body.id = truth.person;
  body.captured = captured;
  for (std::size_t j = 0; j < kJointCount; ++j)
    body.joints[j] = {truth.skeleton.joints[j], std::nullopt, 0};
  return body;
}

/// Writes the true poses at the capture times of the first recording.
Result<void> write_truth(const fs::path& file, const importers::ImportedSet& set) {
  const auto& frames = set.recordings.front().frames;
  std::string text;
  for (auto truth = set.truth.begin(); truth != set.truth.end();) {
    if (truth->index >= frames.size()) break;
    resource::FrameResource frame;
    frame.sequence = truth->index + 1;
    frame.captured = frames[truth->index].captured;
    frame.source = "truth";
    frame.space = resource::SpaceKind::World;
    for (; truth != set.truth.end() && truth->index + 1 == frame.sequence; ++truth)
      frame.bodies.push_back(truth_body(*truth, frame.captured));
    text += record::frame_line(frame);
  }
  return write_text(file.string(), text);
}

/// True unless the file is known to be an import: one that cannot be read may be a recording whose
/// head is damaged, and can perhaps be salvaged.
bool may_be_recorded(const fs::path& file) {
  std::error_code unknown;
  if (!fs::exists(file, unknown)) return false;
  const auto recording = record::RecordingStream::open(file);
  if (!recording) return true;
  const auto& metadata = recording->metadata();
  const auto found = metadata.find(std::string(record::kMetadataName));
  return found != metadata.end() && found->second.contains("recording");
}

/// Refuses to overwrite a recording; an import may be replaced, because it can be repeated.
Result<void> spare_recordings(const fs::path& folder, const importers::ImportedSet& set) {
  for (const auto& recording : set.recordings) {
    const fs::path file = folder / (recording.sensor.str() + ".mcap");
    if (may_be_recorded(file))
      return fail(ErrorCode::Conflict, file.string(),
                  "was recorded, not imported, or cannot be read, and is never overwritten. Name "
                  "another --out or --sensor.");
  }
  return {};
}

/// Refuses to replace extrinsics that also place sensors which are not imported here: these would
/// have no place any more.
Result<void> spare_places(const fs::path& file, const importers::ImportedSet& set) {
  std::error_code unknown;
  if (set.world_from_sensor.empty() || !fs::exists(file, unknown)) return {};
  const auto there = server::load_registration_file(file.string());
  std::string others;
  for (const auto& [sensor, place] : there ? there->sensors : decltype(there->sensors){}) {
    if (!set.world_from_sensor.contains(sensor))
      others += (others.empty() ? "" : ", ") + sensor.str();
  }
  if (there && others.empty()) return {};
  return fail(ErrorCode::Conflict, file.string(),
              there ? "says where " + others + " stand, and would be replaced. Name another --out."
                    : "is there, and is no registration. Name another --out.");
}

Result<std::vector<fs::path>> write_set(const fs::path& folder, const importers::ImportedSet& set) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return fail(ErrorCode::Io, folder.string(), failed.message());
  if (auto ok = spare_recordings(folder, set); !ok) return pass(ok);
  if (auto ok = spare_places(folder / "registration.json", set); !ok) return pass(ok);
  std::vector<fs::path> written;
  for (const auto& recording : set.recordings) {
    written.push_back(folder / (recording.sensor.str() + ".mcap"));
    const auto done = record::write_frame_recording(written.back(), recording);
    if (!done) return pass(done);
  }
  if (!set.world_from_sensor.empty()) {
    written.push_back(folder / "registration.json");
    const auto done =
        write_text(written.back().string(), wire::write_registration(registration_of(set)));
    if (!done) return pass(done);
  }
  if (!set.truth.empty()) {
    written.push_back(folder / "truth.ndjson");
    if (const auto done = write_truth(written.back(), set); !done) return pass(done);
  }
  return written;
}

/// Warns of other recordings in the folder, because they would be fused along with this import.
void warn_of_strangers(const fs::path& folder, const std::vector<fs::path>& written) {
  const std::set<fs::path> ours(written.begin(), written.end());
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".mcap" && ours.count(entry.path()) == 0)
      std::cerr << fmt::format("note: {} was there before and is not part of this import.\n",
                               entry.path().string());
  }
}

/// Reports damaged ends and inputs without content; everything else has been imported.
void tell_what_is_missing(const importers::ImportedSet& set) {
  for (const auto& recording : set.recordings) {
    const auto damage = recording.notes.find("damage.1");
    if (damage != recording.notes.end())
      std::cerr << fmt::format("note: {}: {}\n", recording.notes.at("origin"), damage->second);
  }
  for (const Error& error : set.empty)
    std::cerr << fmt::format("chorus: {}; the other files were imported\n", to_string(error));
}

std::vector<std::string> doubts_of(const ImportArguments& arguments,
                                   const importers::ImportOptions& options,
                                   const importers::ImportedSet& set) {
  std::vector<std::string> doubts = importers::doubts_about(set.recordings);
  if (arguments.format == "video" && arguments.lenses.empty())
    doubts.emplace_back(
        "no --intrinsics: a field of view of 65 +- 6 degrees is assumed for each camera "
        "(chorus calibrate camera measures it)");
  if (arguments.format != "openpose" && arguments.format != "mmpose") return doubts;
  const auto more = importers::numbering_doubts(set.recordings, options.start, arguments.rate_hz);
  doubts.insert(doubts.end(), more.begin(), more.end());
  return doubts;
}

nlohmann::json summary_json(const importers::ImportedSet& set,
                            const std::vector<fs::path>& written) {
  nlohmann::json out{{"files", nlohmann::json::array()}, {"recordings", nlohmann::json::array()}};
  for (const fs::path& file : written) out["files"].push_back(file.string());
  for (const auto& recording : set.recordings) {
    out["recordings"].push_back({{"sensor", recording.sensor.str()},
                                 {"device", recording.device},
                                 {"frames", recording.frames.size()},
                                 {"first", to_iso8601(recording.frames.front().captured)},
                                 {"last", to_iso8601(recording.frames.back().captured)},
                                 {"notes", recording.notes}});
  }
  return out;
}

void print_summary(const importers::ImportedSet& set, const std::vector<fs::path>& written) {
  std::vector<std::vector<std::string>> rows{
      {"sensor", "frames", "seconds", "first capture", "device"}};
  for (const auto& recording : set.recordings) {
    const auto& frames = recording.frames;
    rows.push_back({recording.sensor.str(), std::to_string(frames.size()),
                    shown(seconds(frames.back().captured - frames.front().captured), 2),
                    to_iso8601(frames.front().captured), recording.device});
  }
  std::cout << table(rows);
  for (const auto& recording : set.recordings) {
    for (const char* note :
         {"time", "states", "repeated", "unfitted", "joints", "labels", "sensors"}) {
      const auto found = recording.notes.find(note);
      if (found == recording.notes.end()) continue;
      const bool states = found->first == "states";  // "none in the file", which needs its subject
      std::cout << fmt::format("{}: {}{}\n", recording.sensor.str(),
                               states ? "tracking states: " : "", found->second);
    }
  }
  for (const fs::path& file : written) std::cout << "wrote " << file.string() << '\n';
}

importers::ImportOptions options_of(const ImportArguments& arguments) {
  importers::ImportOptions options;  // the texts were checked while parsing
  for (const std::string& floor : arguments.floors)
    options.floors.push_back(importers::parse_floor(floor).value());
  if (options.floors.size() == 1) options.floor = options.floors.front();
  if (options.floors.size() == 1) options.floors.clear();
  if (!arguments.start.empty()) options.start = parse_iso8601(arguments.start).value();
  if (!arguments.sensor.empty()) options.sensor = SensorId::parse(arguments.sensor).value();
  options.rays = arguments.rays;
  options.metres_per_unit = arguments.unit == "m" ? 1.0 : 0.01;
  return options;
}

/// Refuses an input that reads as a floor plane and is no file: the second of `--floor A B`.
Result<void> check_inputs(const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code ignored;
    if (importers::parse_floor(input) && !fs::exists(input, ignored))
      return fail(ErrorCode::InvalidArgument, "--floor",
                  "takes one plane; say --floor before each: --floor " + input);
  }
  return {};
}

/// Refuses options that the format has no use for, because whoever gives one expects an effect.
Result<void> check_options(const ImportArguments& arguments) {
  if (auto ok = check_inputs(arguments.inputs); !ok) return ok;
  const bool cameras = is_of_cameras(arguments.format);
  if (arguments.unit_given && arguments.format != "bvh")
    return fail(ErrorCode::InvalidArgument, "--unit", "is for bvh only; leave it out");
  if (arguments.rate_given && !cameras)
    return fail(ErrorCode::InvalidArgument, "--rate",
                "is for pictures of cameras only; leave it out");
  if (!cameras && !arguments.lenses.empty())
    return fail(ErrorCode::InvalidArgument, "--intrinsics", "is for cameras; leave it out");
  if (arguments.rays && arguments.format != "pose2sim")
    return fail(ErrorCode::InvalidArgument, "--rays",
                "only pose2sim has landmarks of cameras; leave it out");
  return {};
}

Result<importers::ImportedSet> read_set(const ImportArguments& arguments,
                                        const importers::ImportOptions& options) {
  const std::vector<fs::path> inputs(arguments.inputs.begin(), arguments.inputs.end());
  if (arguments.format == "video")
    return import_videos(inputs, options, {arguments.lenses, arguments.model, arguments.rate_hz});
  if (is_of_cameras(arguments.format))
    return import_poses(inputs, options, {arguments.lenses, arguments.rate_hz});
  return importers::import_files(*importers::format_named(arguments.format), inputs, options);
}

Result<int> run_import(const ImportArguments& arguments) {
  if (auto ok = check_options(arguments); !ok) return pass(ok);
  const importers::ImportOptions options = options_of(arguments);
  const auto set = read_set(arguments, options);
  if (!set) return pass(set);
  const auto written = write_set(arguments.out, *set);
  if (!written) return pass(written);
  warn_of_strangers(arguments.out, *written);
  tell_what_is_missing(*set);
  const auto doubts = doubts_of(arguments, options, *set);
  for (const std::string& doubt : doubts) std::cerr << "note: " << doubt << '\n';
  if (arguments.json) {
    auto summary = summary_json(*set, *written);
    summary["doubts"] = doubts;
    std::cout << summary.dump(2) << '\n';
  } else {
    print_summary(*set, *written);
  }
  return set->empty.empty() ? kExitOk : kExitFailed;
}

void add_input_options(CLI::App& options, ImportArguments& arguments) {
  options
      .add_option("--floor", arguments.floors,
                  "Floor plane a,b,c,d in sensor space [m]: a x + b y + c z + d = 0; for several "
                  "files once for all, or once for each in their order")
      ->take_all()
      ->allow_extra_args(false)
      ->check(readable_by(importers::parse_floor));
  options
      .add_option("--start", arguments.start,
                  "UTC of the first frame where the files have none (2020-01-01T00:00:00Z)")
      ->check(readable_by(parse_iso8601));
  options.add_option("--sensor", arguments.sensor, "Name of the sensor, for a single input")
      ->check(readable_by(SensorId::parse));
}

/// Returns the option --rate.
CLI::Option* add_picture_options(CLI::App& options, ImportArguments& arguments) {
  options
      .add_option("--intrinsics", arguments.lenses,
                  "Lens of a camera, for video, openpose and mmpose: a file with the keys of "
                  "device.camera.intrinsics, or a "
                  "sensor's configuration; once for all, or once for each in their order")
      ->take_all()
      ->allow_extra_args(false);
  options.add_option("--model", arguments.model, "That the runner finds people in videos with")
      ->capture_default_str();
  return options
      .add_option(
          "--rate", arguments.rate_hz,
          "Pictures a second: of a video, those that are looked at; of openpose and mmpose, "
          "those there are")
      ->check(number_range(0.1, 1000.0))
      ->capture_default_str();
}

}  // namespace

Run add_import(CLI::App& options) {
  const auto arguments = std::make_shared<ImportArguments>();
  std::string formats = "One of:";
  for (const auto& [name, reads] : kCameraFormats) formats += fmt::format("\n{}: {}", name, reads);
  for (const auto& row : importers::kFormats)
    formats += fmt::format("\n{}: {}", row.name, row.reads);
  options.add_option("format", arguments->format, formats)->required()->check(check_format);
  options
      .add_option("input", arguments->inputs, "Files of one take, one sensor each; or the folder")
      ->required();
  options.add_option("--out", arguments->out, "Folder for the recordings; made if absent")
      ->required();
  add_input_options(options, *arguments);
  const auto* unit =
      options.add_option("--unit", arguments->unit, "Of lengths in BVH, which does not say")
          ->check(CLI::IsMember({"cm", "m"}))
          ->capture_default_str();
  const auto* rate = add_picture_options(options, *arguments);
  options.add_flag("--rays", arguments->rays,
                   "Of camera landmarks only their directions, without the depth of a fit");
  options.add_flag("--json", arguments->json, "Report as JSON");
  return [arguments, unit, rate] {
    arguments->unit_given = unit->count() > 0;
    arguments->rate_given = rate->count() > 0;
    return run_import(*arguments);
  };
}

}  // namespace chorus::ctl
