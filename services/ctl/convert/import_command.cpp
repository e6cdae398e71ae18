// chorus import FORMAT INPUT... --out DIR: turns files of other programs into recordings.
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/base/unit_name.h"
#include "common/importers/captured.h"
#include "common/importers/doubts.h"
#include "common/importers/formats.h"
#include "services/ctl/convert/import_output.h"
#include "services/ctl/convert/inertial_import.h"
#include "services/ctl/convert/pose_import.h"
#include "services/ctl/convert/sniffed.h"
#include "services/ctl/convert/video_import.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/text_file.h"

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
  std::string unit;
  std::string up;
  std::string joints;
  std::string clocks;
  bool rays = false;
  bool json = false;
  std::vector<std::string> lenses;
  std::string model = "movenet";
  double rate_hz = 30.0;
  bool rate_given = false;
};

/// The formats that come from cameras: only these take the cameras' lenses (--intrinsics).
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kCameraFormats{
    {{"video", "what a runner finds in videos, one camera each, as rays"},
     {"openpose", "OpenPose's JSON, also that of RTMLib and Pose2Sim: a folder a camera, as rays"},
     {"mmpose", "MMPose's predictions in JSON: a file a video, or a folder of pictures, as rays"},
     {"alphapose", "AlphaPose's results in JSON, a file a video, as rays"},
     {"coco", "landmarks in COCO's form (results or annotations), a file a video, as rays"}}};
constexpr std::array<std::pair<std::string_view, importers::MotionFormat>, 4> kNamedPoints{
    {{"c3d", importers::MotionFormat::C3d},
     {"trc", importers::MotionFormat::Trc},
     {"bvh", importers::MotionFormat::Bvh},
     {"htr", importers::MotionFormat::Htr}}};
constexpr std::array<std::pair<std::string_view, importers::Clocks>, 3> kClocks{
    {{"one", importers::Clocks::One},
     {"own", importers::Clocks::Own},
     {"unknown", importers::Clocks::Unknown}}};

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
  if (is_of_cameras(name) || name == kInertialFormat || importers::format_named(name)) return {};
  std::string known;
  for (const auto& row : kCameraFormats) known += fmt::format(" {}", row.first);
  for (const auto& row : importers::kFormats) known += fmt::format(" {}", row.name);
  known += fmt::format(" {}", kInertialFormat);
  return fmt::format("there is no format \"{}\"; known are{}", name, known);
}

/// Reports damaged ends and inputs without content; everything else has been imported.
void tell_what_is_missing(const importers::ImportedSet& set) {
  for (const auto& recording : set.recordings) {
    for (const auto& [key, note] : recording.notes) {
      if (key.starts_with("damage."))
        std::cerr << fmt::format("note: {}: {}\n", recording.notes.at("origin"), note);
    }
  }
  for (const Error& error : set.empty)
    std::cerr << fmt::format("chorus: {}; the other files were imported\n", to_string(error));
}

std::vector<std::string> doubts_of(const ImportArguments& arguments,
                                   const importers::ImportOptions& options,
                                   const importers::ImportedSet& set) {
  std::vector<std::string> doubts = importers::doubts_about(set.recordings, set.spaces);
  if (arguments.format == "video" && arguments.lenses.empty())
    doubts.emplace_back(
        "no --intrinsics: a field of view of 65 +- 6 degrees is assumed for each camera "
        "(chorus calibrate camera measures it)");
  if (arguments.format == "video" || !is_of_cameras(arguments.format)) return doubts;
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
         {"time", "clocks", "gaps", "states", "repeated", "unfitted", "missing", "unseen", "absent",
          "unit", "joints", "labels", "sensors", "fingers"}) {
      const auto found = recording.notes.find(note);
      if (found == recording.notes.end()) continue;
      // "none in the file" and "one" need their subject
      const bool states = found->first == "states";
      const bool clocks = found->first == "clocks";
      std::cout << fmt::format("{}: {}{}\n", recording.sensor.str(),
                               states   ? "tracking states: "
                               : clocks ? "clocks: "
                                        : "",
                               found->second);
    }
  }
  for (const fs::path& file : written) std::cout << "wrote " << file.string() << '\n';
}

/// The joints in a file for --joints; empty without one.
Result<motion::JointChoice> joints_in(const std::string& file) {
  if (file.empty()) return motion::JointChoice{};
  constexpr std::uintmax_t kLargest = 1u << 20;
  const auto text = read_file(file, kLargest);
  if (!text) return pass(text);
  return motion::parse_joint_choice(*text, file);
}

Result<importers::ImportOptions> options_of(const ImportArguments& arguments) {
  importers::ImportOptions options;  // the texts were checked while parsing
  for (const std::string& floor : arguments.floors)
    options.floors.push_back(importers::parse_floor(floor).value());
  if (options.floors.size() == 1) options.floor = options.floors.front();
  if (options.floors.size() == 1) options.floors.clear();
  if (!arguments.start.empty()) options.start = parse_iso8601(arguments.start).value();
  if (!arguments.sensor.empty()) options.sensor = SensorId::parse(arguments.sensor).value();
  options.rays = arguments.rays;
  if (!arguments.unit.empty()) options.metres_per_unit = unit_or_factor(arguments.unit);
  if (!arguments.up.empty()) options.up = importers::parse_up(arguments.up).value();
  for (const auto& [name, clocks] : kClocks) {
    if (name == arguments.clocks) options.clocks = clocks;
  }
  auto joints = joints_in(arguments.joints);
  if (!joints) return pass(joints);
  options.joints = std::move(*joints);
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

/// The format as one of points with names; none for others.
std::optional<importers::MotionFormat> named_points(std::string_view format) {
  for (const auto& [name, points] : kNamedPoints) {
    if (name == format) return points;
  }
  return std::nullopt;
}

/// Refuses options that the format has no use for, because whoever gives one expects an effect.
Result<void> check_options(const ImportArguments& arguments) {
  if (auto ok = check_inputs(arguments.inputs); !ok) return ok;
  const bool cameras = is_of_cameras(arguments.format);
  const bool calibrated = arguments.format == "pose2sim";
  if (!arguments.unit.empty() && (cameras || calibrated))
    return fail(ErrorCode::InvalidArgument, "--unit",
                "is for points; pictures of cameras have no lengths: leave it out");
  if (!arguments.up.empty() && calibrated)
    return fail(ErrorCode::InvalidArgument, "--up",
                "is not for pose2sim, whose cameras.json says it; leave it out");
  if (!arguments.joints.empty() && !named_points(arguments.format))
    return fail(ErrorCode::InvalidArgument, "--joints", "is for c3d, trc and bvh; leave it out");
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

/// Writes a template for --joints beside the output, where joints were not found by name; returns
/// its name, "" if there is none to write.
std::string write_joint_template(const ImportArguments& arguments) {
  const auto format = named_points(arguments.format);
  if (!format || !arguments.joints.empty()) return {};
  const fs::path input = arguments.inputs.front();
  const auto text = importers::joint_template(input, *format);
  if (!text) return {};
  std::error_code failed;
  fs::create_directories(arguments.out, failed);
  const fs::path file = fs::path(arguments.out) / (input.stem().string() + ".joints.txt");
  return write_text(file.string(), *text) ? file.string() : std::string();
}

/// Says where the template for --joints is.
void tell_template(const ImportArguments& arguments) {
  const std::string file = write_joint_template(arguments);
  if (!file.empty())
    std::cerr << fmt::format(
        "note: {} lists the names in the file; fill it in, and import again with --joints {}\n",
        file, file);
}

bool has_few_joints(const std::vector<std::string>& doubts) {
  return std::ranges::any_of(
      doubts, [](const std::string& doubt) { return doubt.find(": only ") != std::string::npos; });
}

/// Logs of worn sensors: one recording of all files.
Result<int> run_inertial(const ImportArguments& given, const importers::ImportOptions& options) {
  if (!given.floors.empty() || !given.unit.empty() || !given.up.empty() || !given.clocks.empty())
    return fail(ErrorCode::InvalidArgument, "inertial",
                "takes --sensor and --start only: worn sensors have no floor and no lengths");
  InertialImport how;
  if (options.sensor) how.source = *options.sensor;
  if (!given.start.empty()) how.start = options.start;
  const auto suit = import_inertial(given.inputs, given.out, how);
  if (suit) print_imported(*suit, given.json);
  return suit.map([](const ImportedSuit&) { return kExitOk; });
}

Result<int> run_import(const ImportArguments& arguments) {
  if (auto ok = check_options(arguments); !ok) return pass(ok);
  const auto options = options_of(arguments);
  if (!options) return pass(options);
  if (arguments.format == kInertialFormat) return run_inertial(arguments, *options);
  const auto set = read_set(arguments, *options);
  if (!set && set.error().code == ErrorCode::Unsupported) tell_template(arguments);
  if (!set) return pass(set);
  const auto written = write_set(arguments.out, *set);
  if (!written) return pass(written);
  warn_of_strangers(arguments.out, *written);
  tell_what_is_missing(*set);
  const auto doubts = doubts_of(arguments, *options, *set);
  for (const std::string& doubt : doubts) std::cerr << "note: " << doubt << '\n';
  if (has_few_joints(doubts)) tell_template(arguments);
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

std::string check_unit(const std::string& text) {
  if (unit_or_factor(text)) return {};
  return "must be mm, cm, m, in, another unit of length, or its number of metres, such as 0.0564";
}

void add_space_options(CLI::App& options, ImportArguments& arguments) {
  options
      .add_option("--unit", arguments.unit,
                  "Of lengths, instead of what the file says: mm, cm, m, in, or metres as a number")
      ->check(check_unit);
  options
      .add_option("--up", arguments.up,
                  "Axis of the file that points up: x, y or z, with - if it points down")
      ->check(readable_by(importers::parse_up));
  options
      .add_option("--joints", arguments.joints,
                  "File of lines JOINT = NAME for c3d, trc and bvh, where the names are not known")
      ->check(CLI::ExistingFile);
  options
      .add_option(
          "--clocks", arguments.clocks,
          "Of several files: one (synchronised), own (each right to about 0.1 s), or unknown")
      ->check(CLI::IsMember({"one", "own", "unknown"}));
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
  formats += fmt::format("\n{}: {}", kInertialFormat, kInertialReads);
  options.add_option("format", arguments->format, formats)->required()->check(check_format);
  options
      .add_option("input", arguments->inputs, "Files of one take, one sensor each; or the folder")
      ->required();
  options.add_option("--out", arguments->out, "Folder for the recordings; made if absent")
      ->required();
  add_input_options(options, *arguments);
  add_space_options(options, *arguments);
  const auto* rate = add_picture_options(options, *arguments);
  options.add_flag("--rays", arguments->rays,
                   "Of camera landmarks only their directions, without the depth of a fit");
  options.add_flag("--json", arguments->json, "Report as JSON");
  return [arguments, rate] {
    arguments->rate_given = rate->count() > 0;
    const bool cameras = arguments->format != "video" && is_of_cameras(arguments->format);
    return sniffed(run_import(*arguments), arguments->inputs,
                   cameras && arguments->format != "mmpose" ? "openpose" : arguments->format);
  };
}

}  // namespace chorus::ctl
