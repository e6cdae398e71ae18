// chorus fuse REC --out FILE: runs recordings through the pipeline, without clocks or sockets.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "fusion-server/client/recordings.h"
#include "fusion-server/fusion/methods.h"
#include "fusion-server/pipeline/offline.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/command.h"
#include "services/ctl/console.h"
#include "services/ctl/fused_file.h"
#include "services/ctl/offline_options.h"
#include "services/ctl/recorded_cell.h"
#include "services/ctl/recorded_places.h"
#include "services/ctl/registration_report.h"
#include "services/ctl/text_file.h"

namespace chorus::ctl {
namespace {

struct FuseArguments {
  std::vector<std::string> inputs;
  std::string out;
  PlaceOptions places;
  std::string save_registration;
  OfflineOptions options;
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

struct Fused {
  Registration registration;
  std::string method;
  double rate_hz = 0.0;
  bool smoothed = false;
  std::size_t frames = 0;
  std::size_t with_bodies = 0;
  RecordedCell::Told told;
};

Result<Fused> fuse_into(const std::string& out, RecordedCell& cell, Registration registration,
                        const pipeline::OfflineConfig& config) {
  Fused fused;
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

nlohmann::json summary_of(const Fused& fused) {
  return {{"sensors", fused.told.sensors},
          {"frames", fused.frames},
          {"framesWithBodies", fused.with_bodies},
          {"method", fused.method},
          {"rateHz", fused.rate_hz},
          {"smoothed", fused.smoothed},
          {"notes", fused.told.notes},
          {"registration", nlohmann::json::parse(wire::write_registration(fused.registration))}};
}

std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
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
                           summary["method"].get<std::string>(),
                           summary["smoothed"].get<bool>() ? ", smoothed" : "",
                           summary["rateHz"].get<double>())
            << fmt::format("{}, {}, {} with somebody in them\n",
                           counted(summary["sensors"].get<std::size_t>(), "sensor"),
                           counted(summary["frames"].get<std::size_t>(), "fused frame"),
                           summary["framesWithBodies"].get<std::size_t>());
}

Result<int> run_fuse(const FuseArguments& arguments) {
  auto config = offline_config(arguments.options);
  if (!config) return pass(config);
  config->smooth = arguments.smooth;
  const auto files = client::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  if (auto ok = check_outputs(arguments, *files); !ok) return pass(ok);
  auto cell = RecordedCell::open(*files);
  if (!cell) return pass(cell);
  auto places = places_of(arguments.places, *files, *cell, *config);
  if (!places) return pass(places);
  auto fused = fuse_into(arguments.out, *cell, std::move(*places->registration), *config);
  if (!fused) return pass(fused);
  note_unused(arguments, *places);
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
  options.add_flag("--smooth", arguments->smooth,
                   "Fuse each instant knowing the seconds after it (fusion.smoothing)");
  options.add_flag("--json", arguments->json, "Summary as JSON");
  return [arguments] { return run_fuse(*arguments); };
}

}  // namespace chorus::ctl
