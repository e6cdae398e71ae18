// chorus fuse REC --out FILE: runs recordings through the pipeline, without clocks or sockets.
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "fusion-server/client/recordings.h"
#include "fusion-server/pipeline/offline.h"
#include "fusion-server/server/registration_store.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/command.h"
#include "services/ctl/console.h"
#include "services/ctl/fused_file.h"
#include "services/ctl/offline_options.h"
#include "services/ctl/recorded_cell.h"
#include "services/ctl/registration_report.h"
#include "services/ctl/text_file.h"

namespace chorus::ctl {
namespace {

struct FuseArguments {
  std::vector<std::string> inputs;
  std::string out;
  std::string registration;
  std::string save_registration;
  bool from_walk = false;
  OfflineOptions options;
  bool json = false;
};

/// The extrinsics from a file or from the recording; none when they are to be solved from the walk.
Result<std::optional<Registration>> given_extrinsics(const FuseArguments& arguments,
                                                     const RecordedCell& cell) {
  if (arguments.from_walk) return std::nullopt;
  const std::string& file = arguments.registration;
  if (file.empty()) return cell.registration();
  auto registration = server::load_registration_file(file);
  if (!registration) return pass(registration);
  return std::optional(std::move(*registration));
}

Result<Registration> extrinsics(const FuseArguments& arguments, RecordedCell& cell,
                                const pipeline::OfflineConfig& config) {
  auto given = given_extrinsics(arguments, cell);
  if (!given) return pass(given);
  if (*given) return std::move(**given);
  return pipeline::register_recordings(cell.input(), config);
}

/// Refuses to write to any of the input files, which would destroy it.
Result<void> check_outputs(const FuseArguments& arguments,
                           std::vector<std::filesystem::path> read) {
  read.emplace_back(arguments.registration);
  read.emplace_back(arguments.options.config);
  if (auto ok = may_write(arguments.out, read); !ok) return ok;
  return may_write(arguments.save_registration, read);
}

struct Fused {
  Registration registration;
  std::size_t frames = 0;
  std::size_t with_bodies = 0;
  RecordedCell::Told told;
};

Result<Fused> fuse_into(const std::string& out, RecordedCell& cell, Registration registration,
                        const pipeline::OfflineConfig& config) {
  Fused fused;
  fused.registration = std::move(registration);
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
          {"notes", fused.told.notes},
          {"registration", nlohmann::json::parse(wire::write_registration(fused.registration))}};
}

void print_summary(const nlohmann::json& summary, const FuseArguments& arguments) {
  if (arguments.json) {
    std::cerr << summary.dump(2) << '\n';
    return;
  }
  for (const auto& note : summary["notes"])
    std::cerr << "note: " << note.get<std::string>() << '\n';
  std::cerr << registration_report(summary["registration"])
            << fmt::format("{} sensors, {} fused frames, {} with somebody in them\n",
                           summary["sensors"].get<std::size_t>(),
                           summary["frames"].get<std::size_t>(),
                           summary["framesWithBodies"].get<std::size_t>());
}

Result<int> run_fuse(const FuseArguments& arguments) {
  const auto config = offline_config(arguments.options);
  if (!config) return pass(config);
  const auto files = client::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  if (auto ok = check_outputs(arguments, *files); !ok) return pass(ok);
  auto cell = RecordedCell::open(*files);
  if (!cell) return pass(cell);
  auto registration = extrinsics(arguments, *cell, *config);
  if (!registration) return pass(registration);
  const auto fused = fuse_into(arguments.out, *cell, std::move(*registration), *config);
  if (!fused) return pass(fused);
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
  options.add_option("--registration", arguments->registration,
                     "Extrinsics as JSON; without it those of the recording, else from the person");
  options.add_flag("--from-walk", arguments->from_walk,
                   "Register from the person, though the recording has a registration");
  options.add_option("--save-registration", arguments->save_registration,
                     "Write the extrinsics used to this file");
  add_offline_options(options, arguments->options);
  options.add_flag("--json", arguments->json, "Summary as JSON");
  return [arguments] { return run_fuse(*arguments); };
}

}  // namespace chorus::ctl
