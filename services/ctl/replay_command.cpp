// chorus replay: one chorus-sensor process per recorded sensor, so that what runs is what runs with
// hardware.
//
// All of them count from the same instant, a second from now, so that recordings of one set stay in
// step.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/time/clock.h"
#include "fusion-server/client/recordings.h"
#include "services/ctl/child_processes.h"
#include "services/ctl/command.h"
#include "services/ctl/replay_round.h"

namespace chorus::ctl {
namespace {

constexpr Duration kHeadStart = std::chrono::seconds(1);  // for every process to come up
constexpr int kLastPort = 65535;

struct ReplayArguments {
  std::vector<std::string> inputs;
  int port = 8081;
  bool loop = false;
  double speed = 1.0;
};

/// What one process plays.
struct Part {
  SensorId sensor;
  std::filesystem::path from;  ///< A file, or the folder of a recording with several.
};

Result<std::vector<Part>> parts_of(const record::Session& session) {
  std::vector<Part> parts;
  for (const auto& [sensor, files] : session.files) {
    if (files.empty()) continue;  // it saw nothing
    const auto folder = files.front().parent_path();
    const bool together = std::all_of(
        files.begin(), files.end(), [&](const auto& file) { return file.parent_path() == folder; });
    if (!together) {
      return fail(ErrorCode::InvalidArgument, files.back().string(),
                  "is a part of a recording whose other files are in another folder.");
    }
    parts.push_back({sensor, files.size() == 1 ? files.front() : folder});
  }
  return parts;
}

Child sensor_process(const Part& part, int port, const ReplayArguments& arguments,
                     Timestamp epoch) {
  Child child{fmt::format("replay of {}", part.from.string()),
              {sibling_program("chorus-sensor"), "--id", part.sensor.str(), "--port",
               std::to_string(port), "--recording", part.from.string(), "--set",
               fmt::format("device.replay.loop={}", arguments.loop), "--set",
               fmt::format("device.replay.speed={}", arguments.speed), "--set",
               fmt::format("device.replay.epoch_ns={}", to_unix_ns(epoch))}};
  return child;
}

void share(const Round& round, Child& child) {
  for (const auto& [key, value] : {std::pair("origin_ns", to_unix_ns(round.origin)),
                                   std::pair("period_ns", round.period.count())}) {
    child.command.insert(child.command.end(),
                         {"--set", fmt::format("device.replay.{}={}", key, value)});
  }
}

Result<int> run_replay(const ReplayArguments& arguments) {
  const auto files = client::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  // Read now: a broken recording, or two of one sensor, should not start half a cell.
  const auto session = client::read_recordings(*files, &std::cerr);
  if (!session) return pass(session);
  if (of_different_times(*session))
    std::cerr
        << "note: these recordings are of different times; each starts at its own beginning\n";
  const auto parts = parts_of(*session);
  if (!parts) return pass(parts);
  if (arguments.port + static_cast<int>(parts->size()) - 1 > kLastPort)
    return fail(ErrorCode::InvalidArgument, "--port", "leaves too few ports above it.");
  const Timestamp epoch = std::chrono::ceil<std::chrono::seconds>(SystemClock().now() + kHeadStart);
  std::vector<Child> children;
  const auto round = round_of(*session);
  for (std::size_t i = 0; i < parts->size(); ++i) {
    const int port = arguments.port + static_cast<int>(i);
    const Part& part = (*parts)[i];
    children.push_back(sensor_process(part, port, arguments, epoch));
    if (round) share(*round, children.back());
    std::cout << fmt::format("{} at http://127.0.0.1:{}/ from {}\n", part.sensor.str(), port,
                             part.from.string())
              << std::flush;
  }
  const auto done = run_children(children);
  if (!done) return pass(done);
  return kExitOk;
}

}  // namespace

Run add_replay(CLI::App& options) {
  const auto arguments = std::make_shared<ReplayArguments>();
  options.add_option("recordings", arguments->inputs, "Folders or .mcap files")->required();
  options.add_option("--port", arguments->port, "Port of the first; the others follow")
      ->check(CLI::Range(1, kLastPort))
      ->capture_default_str();
  options.add_option("--speed", arguments->speed, "2 is twice as fast")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  options.add_flag("--loop", arguments->loop, "Start over at the end");
  return [arguments] { return run_replay(*arguments); };
}

}  // namespace chorus::ctl
