// chorus fuse REC --out FILE: recordings through the pipeline, without clocks or sockets.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/record/session_writer.h"
#include "common/resource/frame_resource.h"
#include "fusion-server/client/fused_frames.h"
#include "fusion-server/client/recordings.h"
#include "fusion-server/pipeline/offline.h"
#include "fusion-server/server/recording_tap.h"
#include "fusion-server/server/registration_store.h"
#include "fusion-server/wire/registration_file.h"
#include "fusion-server/wire/snapshot_resource.h"
#include "services/ctl/command.h"
#include "services/ctl/console.h"
#include "services/ctl/offline_options.h"
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

std::vector<registration::WalkTrack> tracks_of(record::Session session) {
  std::vector<registration::WalkTrack> tracks;
  for (auto& recording : session.sensors)
    tracks.push_back({recording.sensor, std::move(recording.frames)});
  return tracks;
}

/// The last one that a recording was made with.
Result<std::optional<Registration>> recorded_extrinsics(const std::vector<std::string>& recorded) {
  for (auto text = recorded.rbegin(); text != recorded.rend(); ++text) {
    auto registration = wire::read_registration(*text);
    if (!registration)
      return fail(registration.error().code, "/registration", to_string(registration.error()));
    if (!registration->sensors.empty()) return std::optional(std::move(*registration));
  }
  return std::nullopt;
}

Result<std::optional<Registration>> read_extrinsics(const FuseArguments& arguments,
                                                    const record::Session& session) {
  if (arguments.from_walk) return std::nullopt;
  const std::string& file = arguments.registration;
  if (file.empty()) return recorded_extrinsics(session.registrations);
  auto registration = server::load_registration_file(file);
  if (!registration) return pass(registration);
  return std::optional(std::move(*registration));
}

std::string ndjson_of(const std::vector<Snapshot>& snapshots) {
  std::string text;
  for (const Snapshot& snapshot : snapshots)
    text += client::frame_line(wire::to_resource(snapshot));
  return text;
}

/// A recording of the fused frames alone.  Nothing in it depends on when or where it is made.
Result<void> write_fused(const std::string& file, const pipeline::OfflineResult& result) {
  auto writer = record::SessionWriter::create(file, {{{"title", "chorus fuse"}}, false});
  if (!writer) return pass(writer);
  const Timestamp begin = result.snapshots.empty() ? Timestamp{} : result.snapshots.front().instant;
  if (auto ok = writer->write(wire::places_changed(begin, result.registration)); !ok) return ok;
  for (const Snapshot& snapshot : result.snapshots) {
    const auto ok = writer->write(record::FusedFrame{snapshot.instant, snapshot.instant,
                                                     [&] { return wire::to_resource(snapshot); }});
    if (!ok) return ok;
  }
  return writer->close();
}

/// What writing must not destroy: all that is read.
Result<void> check_outputs(const FuseArguments& arguments,
                           std::vector<std::filesystem::path> read) {
  read.emplace_back(arguments.registration);
  read.emplace_back(arguments.options.config);
  if (auto ok = may_write(arguments.out, read); !ok) return ok;
  return may_write(arguments.save_registration, read);
}

Result<void> write_result(const std::string& file, const pipeline::OfflineResult& result) {
  if (!file.ends_with(".mcap")) return write_text(file, ndjson_of(result.snapshots));
  const std::string partial = file + ".partial";
  std::error_code error;
  std::filesystem::remove(partial, error);
  auto ok = write_fused(partial, result);
  if (ok) ok = may_write(file, {});  // made by somebody else meanwhile
  if (ok) std::filesystem::rename(partial, file, error);
  if (ok && error) ok = fail(ErrorCode::Io, file, error.message());
  if (!ok) std::filesystem::remove(partial, error);
  return ok;
}

nlohmann::json summary_of(const pipeline::OfflineResult& result, std::size_t sensors,
                          const std::vector<std::string>& notes) {
  const auto with_bodies = std::count_if(result.snapshots.begin(), result.snapshots.end(),
                                         [](const Snapshot& s) { return !s.bodies.empty(); });
  return {{"sensors", sensors},
          {"frames", result.snapshots.size()},
          {"framesWithBodies", with_bodies},
          {"notes", notes},
          {"registration", nlohmann::json::parse(wire::write_registration(result.registration))}};
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
  const auto files = client::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  if (auto ok = check_outputs(arguments, *files); !ok) return pass(ok);
  auto session = client::read_recordings(*files, arguments.json ? nullptr : &std::cerr);
  if (!session) return pass(session);
  const auto notes = client::notes_of(*session);
  const auto extrinsics = read_extrinsics(arguments, *session);
  if (!extrinsics) return pass(extrinsics);
  const auto tracks = tracks_of(std::move(*session));
  const auto result = pipeline::fuse_offline(tracks, *extrinsics, *config);
  if (!result) return pass(result);
  const auto written = write_result(arguments.out, *result);
  if (!written) return pass(written);
  if (!arguments.save_registration.empty()) {
    const auto saved =
        write_text(arguments.save_registration, wire::write_registration(result->registration));
    if (!saved) return pass(saved);
  }
  const nlohmann::json summary = summary_of(*result, tracks.size(), notes);
  print_summary(summary, arguments);
  // A file of empty frames is not what anybody asked for; the report says why.
  return summary["framesWithBodies"].get<std::size_t>() > 0 ? kExitOk : kExitFailed;
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
