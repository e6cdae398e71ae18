// chorus fuse REC --out FILE: runs recordings through the pipeline, without clocks or sockets.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/geometry/error_radius.h"
#include "common/record/cell_reader.h"
#include "fusion-server/fusion/methods.h"
#include "fusion-server/pipeline/offline.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/calibrate/recorded_places.h"
#include "services/ctl/convert/fused_file.h"
#include "services/ctl/convert/sniffed.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/offline_options.h"
#include "services/ctl/line/text_file.h"
#include "services/ctl/operate/registration_report.h"
#include "services/ctl/record/recorded_cell.h"

namespace chorus::ctl {
namespace {

struct FuseArguments {
  std::vector<std::string> inputs;
  std::string out;
  PlaceOptions places;
  std::string save_registration;
  OfflineOptions options;
  std::vector<std::string> inertial;  ///< Recordings of worn sensors.
  double inertial_later = 0.0;        ///< Added to their times [s].
  bool as_live = false;               ///< No first pass that finds how worn sensors sit.
  bool smooth = false;
  bool json = false;
};

/// Refuses to write to any of the input files, which would destroy it.
Result<void> check_outputs(const FuseArguments& arguments,
                           std::vector<std::filesystem::path> read) {
  if (const auto beside = registration_beside(read);
      beside && *beside && !arguments.places.from_walk)
    read.push_back(**beside);
  read.emplace_back(arguments.places.registration);
  read.emplace_back(arguments.options.config);
  read.insert(read.end(), arguments.inertial.begin(), arguments.inertial.end());
  if (auto ok = may_write(arguments.out, read); !ok) return ok;
  if (auto ok = may_write(arguments.save_registration, read); !ok) return ok;
  if (!same_file(arguments.out, arguments.save_registration)) return {};
  return fail(ErrorCode::InvalidArgument, "--save-registration",
              "names the file of --out, which would lose what is fused; name another");
}

/// Says so if the places were given, but options for solving them were, too.
void note_unused(const FuseArguments& arguments, Places& places) {
  const OfflineOptions& options = arguments.options;
  if (places.solved) return;
  if (options.distance.empty() && options.stature.empty() && options.joints.empty()) return;
  places.note +=
      (places.note.empty() ? "" : "; ") +
      std::string("--distance, --stature and --joints change nothing without --from-walk");
}

/// What came of the distance that was measured: refused if a sensor is unknown, noted if the walk
/// contradicts it.
Result<void> check_distances(const registration::RegistrationConfig& config, Places& places) {
  if (!places.solved) return {};
  const Registration& found = *places.registration;
  constexpr double kClose = 0.02;  // of the length
  for (const registration::KnownDistance& known : config.known_distances) {
    for (const SensorId& id : {known.first, known.second}) {
      if (!found.sensors.contains(id) && !found.verdicts.contains(id))
        return fail(ErrorCode::InvalidArgument, "--distance",
                    "the recordings have no sensor " + id.str());
    }
    const auto first = found.sensors.find(known.first);
    const auto second = found.sensors.find(known.second);
    if (first == found.sensors.end() || second == found.sensors.end()) continue;
    const double walked = (first->second.world_from_sensor.translation() -
                           second->second.world_from_sensor.translation())
                              .norm();
    if (std::abs(walked - known.length) < kClose * known.length) continue;
    places.note += fmt::format(
        "{}{} and {} are {:.2f} m apart by --distance and {:.2f} m by the walk; sensors that "
        "measure depth are not scaled by it",
        places.note.empty() ? "" : "; ", known.first.str(), known.second.str(), known.length,
        walked);
  }
  return {};
}

struct Fused {
  Registration registration;
  std::string method;
  double rate_hz = 0.0;
  bool smoothed = false;
  std::size_t frames = 0;
  std::size_t with_bodies = 0;
  RecordedCell::Told told;
  std::size_t carried_back = 0;  ///< Calibrations of worn sensors that served from the beginning.
};

Result<Fused> fuse_into(const std::string& out, RecordedCell& cell, Registration registration,
                        const pipeline::OfflineConfig& config) {
  Fused fused;
  for (const worn::Beginning& each : config.beginnings) fused.carried_back += each.sensors.size();
  fused.registration = std::move(registration);
  fused.method = fusion::name_of(config.pipeline.fusion.method);
  fused.rate_hz = config.rate_hz;
  fused.smoothed = config.smooth;
  const auto file = create_fused_file(out, fused.registration);
  if (!file) return pass(file);
  const auto done = pipeline::fuse_recordings(cell.input(), fused.registration, config,
                                              [&](const Snapshot& snapshot) {
                                                ++fused.frames;
                                                if (!snapshot.bodies.empty()) ++fused.with_bodies;
                                                return (*file)->add(snapshot);
                                              });
  if (!done) return pass(done);
  if (auto ok = (*file)->finish(); !ok) return pass(ok);
  fused.told = cell.told();
  return fused;
}

nlohmann::json worn_summary(const std::vector<WornReport>& reports) {
  auto all = nlohmann::json::object();
  for (const WornReport& report : reports) {
    nlohmann::json& source = all[report.source.str()];
    source = {{"sensors", nlohmann::json::object()}};
    if (report.wearer) source["wearer"] = report.wearer->value;
    if (!report.reason.empty()) source["reason"] = report.reason;
    for (const WornSensorReport& one : report.sensors) {
      source["sensors"][one.sensor] = {{"limb", inertial::name_of(one.limb)},
                                       {"calibrated", one.calibrated}};
      if (!one.refusal.empty()) source["sensors"][one.sensor]["reason"] = one.refusal;
    }
  }
  return all;
}

std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// "suit: worn by person 1, 12 of 13 limbs known; left forearm: bend and stretch it"
std::string worn_line(const WornReport& report) {
  if (!report.wearer) return fmt::format("{}: {}", report.source.str(), report.reason);
  const auto known = std::ranges::count_if(report.sensors, &WornSensorReport::calibrated);
  std::string line = fmt::format("{}: worn by person {}, {} of {} limbs known", report.source.str(),
                                 report.wearer->value, known, report.sensors.size());
  for (const WornSensorReport& one : report.sensors) {
    if (!one.refusal.empty())
      line += fmt::format("; {}: {}", inertial::words_for(one.limb), one.refusal);
  }
  return line;
}

/// Says what became of worn sensors, or that there are some.
void note_worn(const RecordedCell& cell, bool enabled, Fused& fused) {
  RecordedCell::Told& told = fused.told;
  if (fused.carried_back > 0)
    told.notes.push_back(fmt::format(
        "{} of worn sensors found in a first pass serve{} from the beginning (--as-live: as a live "
        "server would have them)",
        counted(fused.carried_back, "calibration"), fused.carried_back == 1 ? "s" : ""));
  for (const WornReport& report : told.worn) told.notes.push_back(worn_line(report));
  if (!enabled && cell.holds_suits())
    told.notes.emplace_back(
        "the recordings hold worn inertial sensors; --set fusion.inertial.enabled=true lets them "
        "help");
  if (enabled && told.worn.empty())
    told.notes.emplace_back(
        "the recordings hold no worn inertial sensors; name a recording of them with --inertial");
}

nlohmann::json summary_of(const Fused& fused) {
  auto registration = nlohmann::json::parse(wire::write_registration(fused.registration));
  for (const auto& [sensor, place] : fused.registration.sensors) {
    const double radius = radius_on_floor(place.covariance);
    if (!place.covariance.isZero(0.0) && std::isfinite(radius))
      registration["sensors"][sensor.str()]["presentRadius"] = radius;
  }
  return {{"sensors", fused.told.sensors},
          {"frames", fused.frames},
          {"framesWithBodies", fused.with_bodies},
          {"method", fused.method},
          {"rateHz", fused.rate_hz},
          {"smoothed", fused.smoothed},
          {"notes", fused.told.notes},
          {"inertial", worn_summary(fused.told.worn)},
          {"calibrationsCarriedBack", fused.carried_back},
          {"registration", std::move(registration)}};
}

/// Lets the recordings of worn sensors beside the others help.
Result<void> wear(const FuseArguments& arguments, RecordedCell& cell) {
  if (arguments.inertial.empty()) return {};
  const auto files =
      record::find_recordings({arguments.inertial.begin(), arguments.inertial.end()});
  if (!files) return pass(files);
  return cell.wear(*files, from_seconds(arguments.inertial_later));
}

/// Reads once to find how worn sensors sit, unless a live server is to be followed.
Result<void> look_at_wearings(const FuseArguments& arguments, RecordedCell& cell,
                              const Registration& places, pipeline::OfflineConfig& config) {
  if (arguments.as_live) return {};
  auto found = pipeline::first_wearings(cell.input(), places, config);
  if (!found) return pass(found);
  config.beginnings = std::move(*found);
  return {};
}

/// The options; naming worn sensors switches them on.
Result<pipeline::OfflineConfig> fuse_config(const FuseArguments& arguments) {
  OfflineOptions options = arguments.options;
  if (!arguments.inertial.empty())
    options.overrides.insert(options.overrides.begin(), "fusion.inertial.enabled=true");
  auto config = offline_config(options);
  if (config) config->smooth = arguments.smooth;
  return config;
}

/// Only the body filter smooths where joints are; the other methods are given smoothed sides.
const char* smoothing_shown(const nlohmann::json& summary) {
  if (!summary["smoothed"].get<bool>()) return "";
  const bool whole = summary["method"] == fusion::name_of(fusion::Method::BodyFilter);
  return whole ? ", smoothed" : ", left and right smoothed, places as without --smooth";
}

void print_summary(const nlohmann::json& summary, const FuseArguments& arguments) {
  if (arguments.json) {
    std::cerr << summary.dump(2) << '\n';
    return;
  }
  for (const auto& note : summary["notes"])
    std::cerr << "note: " << note.get<std::string>() << '\n';
  std::cerr << registration_report(summary["registration"])
            << fmt::format("method {}{}, {:.6g} instants a second\n",
                           summary["method"].get<std::string>(), smoothing_shown(summary),
                           summary["rateHz"].get<double>())
            << fmt::format("{}, {}, {} with somebody in them\n",
                           counted(summary["sensors"].get<std::size_t>(), "sensor"),
                           counted(summary["frames"].get<std::size_t>(), "fused frame"),
                           summary["framesWithBodies"].get<std::size_t>());
}

Result<int> run_fuse(const FuseArguments& arguments) {
  auto config = fuse_config(arguments);
  if (!config) return pass(config);
  const auto files = record::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  if (auto ok = check_outputs(arguments, *files); !ok) return pass(ok);
  auto cell = RecordedCell::open(*files);
  if (!cell) return pass(cell);
  if (auto ok = wear(arguments, *cell); !ok) return pass(ok);
  auto places = places_of(arguments.places, *files, *cell, *config);
  if (!places) return pass(places);
  if (auto ok = check_distances(config->registration, *places); !ok) return pass(ok);
  if (auto ok = look_at_wearings(arguments, *cell, *places->registration, *config); !ok)
    return pass(ok);
  auto fused = fuse_into(arguments.out, *cell, std::move(*places->registration), *config);
  if (!fused) return pass(fused);
  note_unused(arguments, *places);
  note_worn(*cell, config->worn.enabled, *fused);
  auto& notes = fused->told.notes;
  if (!places->note.empty()) notes.insert(notes.begin(), places->note);
  if (!arguments.save_registration.empty()) {
    const auto saved =
        write_text(arguments.save_registration, wire::write_registration(fused->registration));
    if (!saved) return pass(saved);
  }
  print_summary(summary_of(*fused), arguments);
  // A file of empty frames is useless; the report says why there are no bodies.
  return fused->with_bodies > 0 ? kExitOk : kExitFailed;
}

}  // namespace

Run add_fuse(CLI::App& options) {
  const auto arguments = std::make_shared<FuseArguments>();
  options
      .add_option("recordings", arguments->inputs,
                  "Folders or .mcap files, of sensors or of whole cells")
      ->required();
  options
      .add_option("--out", arguments->out, "File to write: .mcap, or NDJSON; - is standard output")
      ->required();
  add_place_options(options, arguments->places);
  options.add_option("--save-registration", arguments->save_registration,
                     "Write the extrinsics used to this file");
  add_offline_options(options, arguments->options);
  options.add_option("--inertial", arguments->inertial,
                     "Recording of worn inertial sensors that help (fusion.inertial); may be "
                     "repeated");
  options.add_option("--inertial-later", arguments->inertial_later,
                     "Seconds to add to its times, if its clock was another");
  options.add_flag("--as-live", arguments->as_live,
                   "Worn sensors help from when a live server would have calibrated them, not from "
                   "the beginning");
  options.add_flag("--smooth", arguments->smooth,
                   "Fuse each instant knowing the seconds after it (fusion.smoothing)");
  options.add_flag("--json", arguments->json, "Summary as JSON");
  return [arguments] { return sniffed(run_fuse(*arguments), arguments->inputs); };
}

}  // namespace chorus::ctl
