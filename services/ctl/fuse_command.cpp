// chorus fuse DIR --out FILE.ndjson: recordings through the pipeline, without clocks or sockets.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/resource/frame_resource.h"
#include "fusion-server/pipeline/offline.h"
#include "fusion-server/publish/registration_file.h"
#include "fusion-server/publish/snapshot_resource.h"
#include "services/ctl/command.h"
#include "services/ctl/console.h"
#include "services/ctl/offline_options.h"
#include "services/ctl/recordings.h"
#include "services/ctl/registration_report.h"
#include "services/ctl/text_file.h"

namespace chorus::ctl {
namespace {

struct FuseArguments {
  std::vector<std::string> inputs;
  std::string out;
  std::string registration;
  std::string save_registration;
  OfflineOptions options;
  bool json = false;
};

Result<std::vector<registration::WalkTrack>> read_tracks(const std::vector<std::string>& inputs) {
  const auto files = find_recordings({inputs.begin(), inputs.end()});
  if (!files) return pass(files);
  auto recordings = read_recordings(*files);
  if (!recordings) return pass(recordings);
  std::vector<registration::WalkTrack> tracks;
  for (auto& recording : *recordings)
    tracks.push_back({recording.sensor, std::move(recording.frames)});
  return tracks;
}

Result<std::optional<Registration>> read_extrinsics(const std::string& file) {
  if (file.empty()) return std::nullopt;
  const auto text = read_text(file);
  if (!text) return pass(text);
  auto registration = publish::read_registration(*text);
  if (!registration) return fail(registration.error().code, file, to_string(registration.error()));
  return std::optional(std::move(*registration));
}

/// One /frame document a line.
std::string ndjson_of(const std::vector<Snapshot>& snapshots) {
  std::string text;
  for (const Snapshot& snapshot : snapshots) {
    std::string line = resource::write(publish::to_resource(snapshot), resource::Format::Json);
    while (line.ends_with('\n')) line.pop_back();
    text += line + "\n";
  }
  return text;
}

nlohmann::json summary_of(const pipeline::OfflineResult& result, std::size_t sensors) {
  const auto with_bodies = std::count_if(result.snapshots.begin(), result.snapshots.end(),
                                         [](const Snapshot& s) { return !s.bodies.empty(); });
  return {
      {"sensors", sensors},
      {"frames", result.snapshots.size()},
      {"framesWithBodies", with_bodies},
      {"registration", nlohmann::json::parse(publish::write_registration(result.registration))}};
}

void print_summary(const nlohmann::json& summary, const FuseArguments& arguments) {
  if (arguments.json) {
    std::cerr << summary.dump(2) << '\n';
    return;
  }
  std::cerr << registration_report(summary["registration"])
            << fmt::format("{} sensors, {} fused frames, {} with somebody in them\n",
                           summary["sensors"].get<std::size_t>(),
                           summary["frames"].get<std::size_t>(),
                           summary["framesWithBodies"].get<std::size_t>());
}

Result<int> run_fuse(const FuseArguments& arguments) {
  const auto config = offline_config(arguments.options);
  if (!config) return pass(config);
  const auto extrinsics = read_extrinsics(arguments.registration);
  if (!extrinsics) return pass(extrinsics);
  const auto tracks = read_tracks(arguments.inputs);
  if (!tracks) return pass(tracks);
  const auto result = pipeline::fuse_offline(*tracks, *extrinsics, *config);
  if (!result) return pass(result);
  const auto written = write_text(arguments.out, ndjson_of(result->snapshots));
  if (!written) return pass(written);
  if (!arguments.save_registration.empty()) {
    const auto saved =
        write_text(arguments.save_registration, publish::write_registration(result->registration));
    if (!saved) return pass(saved);
  }
  const nlohmann::json summary = summary_of(*result, tracks->size());
  print_summary(summary, arguments);
  // A file of empty frames is not what anybody asked for; the report says why.
  return summary["framesWithBodies"].get<std::size_t>() > 0 ? kExitOk : kExitFailed;
}

}  // namespace

Run add_fuse(CLI::App& options) {
  const auto arguments = std::make_shared<FuseArguments>();
  options.add_option("recordings", arguments->inputs, "Folders or .mcap files, one per sensor")
      ->required();
  options.add_option("--out", arguments->out, "NDJSON file to write; - is standard output")
      ->required();
  options.add_option("--registration", arguments->registration,
                     "Extrinsics as JSON; without it the sensors are registered from the person");
  options.add_option("--save-registration", arguments->save_registration,
                     "Write the extrinsics used to this file");
  add_offline_options(options, arguments->options);
  options.add_flag("--json", arguments->json, "Summary as JSON");
  return [arguments] { return run_fuse(*arguments); };
}

}  // namespace chorus::ctl
