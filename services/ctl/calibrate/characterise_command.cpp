// chorus characterise REC: what a kind of sensor errs by, from a recording of somebody who stands
// and turns.
#include <filesystem>
#include <iostream>
#include <memory>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "common/record/cell_reader.h"
#include "fusion-server/pipeline/offline.h"
#include "services/ctl/calibrate/characterise_report.h"
#include "services/ctl/calibrate/recorded_places.h"
#include "services/ctl/convert/sniffed.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/new_file.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/offline_options.h"
#include "services/ctl/line/text_file.h"
#include "services/ctl/record/recorded_cell.h"

namespace chorus::ctl {
namespace {

using characteristics::Measured;
using Tracks = std::map<SensorId, std::vector<SensorFrame>>;

/// Of all sensors together: half an hour of one, a few minutes of eight.
constexpr std::size_t kMostFrames = 54'000;
/// What a walk is told of the depth bias before it says something itself: nothing within reach [m].
constexpr double kOpenBias = 0.03;

struct CharacteriseArguments {
  std::vector<std::string> inputs;
  std::string sensor;
  double distance = 0.0;
  double distance_sigma = 0.01;
  std::vector<std::string> turns;
  std::string out;
  OfflineOptions options;
  bool json = false;
};

struct Recorded {
  Tracks tracks;
  std::set<std::string> others;  ///< Sensors that were not asked for.
  std::vector<std::string> notes;
};

Result<Recorded> frames_of(RecordedCell& cell, const std::string& only) {
  Recorded recorded;
  std::size_t count = 0;
  auto input = cell.input();
  for (auto& lane : input.lanes) {
    for (auto frame = lane.next(); true; frame = lane.next()) {
      if (!frame) return pass(frame);
      if (!*frame) break;
      if (!only.empty() && (*frame)->sensor.str() != only) {
        recorded.others.insert((*frame)->sensor.str());
        continue;
      }
      if (++count > kMostFrames) {
        recorded.notes.push_back(fmt::format(
            "only the first {} frames were read; --sensor reads one sensor alone", kMostFrames));
        return recorded;
      }
      recorded.tracks[(*frame)->sensor].push_back(std::move(**frame));
    }
  }
  return recorded;
}

/// "4,28" as seconds.
Result<characteristics::KnownTurn> known_turn(const std::string& text) {
  characteristics::KnownTurn turn;
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos || !CLI::detail::lexical_cast(text.substr(0, comma), turn.from) ||
      !CLI::detail::lexical_cast(text.substr(comma + 1), turn.to) || !(turn.to > turn.from))
    return fail(ErrorCode::InvalidArgument, "--turn",
                "write it as 4,28: seconds from the first frame at which one whole turn began and "
                "ended");
  return turn;
}

Result<characteristics::Known> known_of(const CharacteriseArguments& arguments) {
  characteristics::Known known;
  if (arguments.distance > 0.0)
    known.mark = characteristics::Mark{arguments.distance, arguments.distance_sigma};
  for (const std::string& text : arguments.turns) {
    const auto turn = known_turn(text);
    if (!turn) return pass(turn);
    known.turns.push_back(*turn);
  }
  return known;
}

/// Each sensor by itself; those that cannot be measured become notes.
void measure_each(const Recorded& recorded, const characteristics::Known& known,
                  SensorReport& report) {
  for (const auto& [sensor, frames] : recorded.tracks) {
    auto found = characteristics::characterise(frames, known);
    if (found) {
      report.measured.sensors.push_back(std::move(*found));
    } else {
      report.notes.push_back(to_string(found.error()));
    }
  }
}

/// The tracks of the registered sensors by a common clock.
Tracks in_step(const Tracks& tracks, const Registration& registration) {
  Tracks placed;
  for (const auto& [sensor, frames] : tracks) {
    if (!registration.sensors.contains(sensor)) continue;
    auto& own = placed[sensor] = frames;
    for (SensorFrame& frame : own)
      move_in_time(frame, walked_correction(registration, sensor, frame.clock_sigma));
  }
  return placed;
}

/// All sensors together: the depth bias from their walk; how they differ in the places that are
/// given, else in those of the walk.
void measure_together(RecordedCell& cell, const Recorded& recorded, pipeline::OfflineConfig config,
                      const std::optional<Registration>& given, SensorReport& report) {
  if (config.registration.depth_bias_sigma == 0.0) config.registration.depth_bias_sigma = kOpenBias;
  const auto walked = pipeline::register_recordings(cell.input(), config);
  if (!walked) {
    report.notes.push_back("depth bias: " + to_string(walked.error()) +
                           "; it takes a walk, or a tape and one sensor (--sensor, --distance)");
    if (!given) return;
  }
  const Registration& registration = given ? *given : *walked;
  const Tracks placed = in_step(recorded.tracks, registration);
  std::vector<characteristics::PlacedTrack> tracks;
  for (const auto& [sensor, frames] : placed)
    tracks.push_back({registration.sensors.at(sensor).world_from_sensor, &frames});
  report.measured.agreement = characteristics::agreement_of(tracks);
  if (walked && walked->depth_bias)
    report.measured.walked_bias =
        characteristics::MeasuredDepthBias{walked->depth_bias->bias, walked->depth_bias->sigma};
}

Result<void> check_frames(const Recorded& recorded, const CharacteriseArguments& arguments) {
  if (!recorded.tracks.empty()) return {};
  if (arguments.sensor.empty())
    return fail(ErrorCode::NotFound, "the recording", "has no frames of a sensor");
  return fail(ErrorCode::NotFound, "--sensor",
              fmt::format("the recording has no frames of {}, but of {}", arguments.sensor,
                          fmt::join(recorded.others, ", ")));
}

/// Whole turns that end after the recording, which would be searched in vain.
Result<void> check_turns(const Recorded& recorded, const characteristics::Known& known) {
  double longest = 0.0;
  for (const auto& [sensor, frames] : recorded.tracks)
    longest = std::max(longest, seconds(frames.back().captured - frames.front().captured));
  for (const characteristics::KnownTurn& turn : known.turns) {
    if (turn.to > longest)
      return fail(ErrorCode::InvalidArgument, "--turn",
                  fmt::format("{:g},{:g} ends after the recording, which is {:.1f} s long",
                              turn.from, turn.to, longest));
  }
  return {};
}

Result<void> check_distance(const Recorded& recorded, const CharacteriseArguments& arguments) {
  if (arguments.distance <= 0.0 || recorded.tracks.size() == 1) return {};
  return fail(ErrorCode::InvalidArgument, "--distance",
              "is that of one sensor; name which with --sensor");
}

constexpr std::array<const char*, 4> kFiles{"report.txt", "report.json", "fusion-profile.json",
                                            "sensor-profile.json"};

std::string in_folder(const std::string& folder, const char* file) {
  return (std::filesystem::path(folder) / file).string();
}

Result<void> may_fill(const std::string& folder) {
  if (folder.empty()) return {};
  for (const char* file : kFiles) {
    if (auto ok = may_create(in_folder(folder, file)); !ok) return ok;
  }
  return {};
}

Result<void> fill(const std::string& folder, const SensorReport& report) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return fail(ErrorCode::Io, folder, failed.message());
  const std::array<std::string, kFiles.size()> texts{
      characterise_text(report), json_text(characterise_json(report)), fusion_profile(report),
      simulation_profile(report)};
  for (std::size_t i = 0; i < kFiles.size(); ++i) {
    const std::string file = in_folder(folder, kFiles.at(i));
    if (auto ok = write_text(file, texts.at(i)); !ok) return ok;
    std::cerr << "wrote " << file << '\n';
  }
  return {};
}

Result<SensorReport> measured(const CharacteriseArguments& arguments,
                              const pipeline::OfflineConfig& config) {
  const auto known = known_of(arguments);
  if (!known) return pass(known);
  const auto files = record::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  auto cell = RecordedCell::open(*files);
  if (!cell) return pass(cell);
  auto recorded = frames_of(*cell, arguments.sensor);
  if (!recorded) return pass(recorded);
  if (auto ok = check_frames(*recorded, arguments); !ok) return pass(ok);
  if (auto ok = check_turns(*recorded, *known); !ok) return pass(ok);
  if (auto ok = check_distance(*recorded, arguments); !ok) return pass(ok);
  SensorReport report;
  report.source = arguments.inputs.front();
  report.notes = std::move(recorded->notes);
  measure_each(*recorded, *known, report);
  if (recorded->tracks.size() > 1) {
    const auto given = given_places({}, *files, *cell);
    if (!given) return pass(given);
    // Where they are used, the note tells of an option that this command does not have.
    if (!given->registration && !given->note.empty()) report.notes.push_back(given->note);
    measure_together(*cell, *recorded, config, given->registration, report);
  }
  const Measured& all = report.measured;
  if (all.sensors.empty() && !all.agreement && !all.walked_bias)
    return fail(ErrorCode::InvalidArgument, report.source,
                fmt::format("cannot be measured: {}", fmt::join(report.notes, "; ")));
  const auto& noise = config.pipeline.fusion.noise;
  report.kind = characteristics::kind_of(all, std::max(noise.along, noise.across));
  return report;
}

Result<int> run_characterise(const CharacteriseArguments& arguments) {
  if (auto ok = may_fill(arguments.out); !ok) return pass(ok);
  const auto config = offline_config(arguments.options);
  if (!config) return pass(config);
  const auto report = measured(arguments, *config);
  if (!report) return pass(report);
  std::cout << (arguments.json ? json_text(characterise_json(*report))
                               : characterise_text(*report));
  if (!arguments.out.empty()) {
    if (auto ok = fill(arguments.out, *report); !ok) return pass(ok);
  }
  return kExitOk;
}

/// What was measured beside the recordings.
void add_measured_options(CLI::App& options, CharacteriseArguments& arguments) {
  options
      .add_option("--distance", arguments.distance,
                  "Measured along the floor from below the sensor to the mark on which the person "
                  "turns [m]: says how much too near joints are")
      ->check(number_range(0.3, 20.0));
  options
      .add_option("--distance-sigma", arguments.distance_sigma,
                  "How well that was measured, as a standard deviation [m]")
      ->check(number_range(0.0005, 0.5))
      ->capture_default_str();
  options
      .add_option("--turn", arguments.turns,
                  "When one whole, even turn began and ended, in seconds from the first frame, as "
                  "in 4,28; may be repeated. Without it the shoulders are followed")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const auto turn = known_turn(text);
            return turn ? std::string() : turn.error().message;
          },
          "FROM,TO"))
      ->take_all()
      ->allow_extra_args(false);
}

}  // namespace

Run add_characterise(CLI::App& options) {
  const auto arguments = std::make_shared<CharacteriseArguments>();
  options
      .add_option("recordings", arguments->inputs,
                  "Folders or .mcap files of one person who stands and turns; of several sensors "
                  "also of a walk")
      ->required();
  options.add_option("--sensor", arguments->sensor, "Only this sensor of the recordings");
  add_measured_options(options, *arguments);
  options.add_option("--out", arguments->out,
                     "Folder to write: report.txt, report.json, fusion-profile.json, "
                     "sensor-profile.json");
  options.add_option("--config", arguments->options.config,
                     "The fusion server's configuration (its defaults), for registering a walk");
  options
      .add_option("--set", arguments->options.overrides,
                  "Override one key of it: path=value; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  options.add_flag("--json", arguments->json, "Report as JSON");
  return [arguments] { return sniffed(run_characterise(*arguments), arguments->inputs); };
}

}  // namespace chorus::ctl
