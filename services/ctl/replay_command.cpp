// chorus replay: one chorus-sensor process per recording, so that what runs is what runs with
// hardware.
//
// All of them count from the same instant, a second from now, so that recordings of one set stay in
// step.
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/time/clock.h"
#include "services/ctl/child_processes.h"
#include "services/ctl/command.h"
#include "services/ctl/recordings.h"

namespace chorus::ctl {
namespace {

constexpr Duration kHeadStart = std::chrono::seconds(1);  // for every process to come up
constexpr int kLastPort = 65535;

struct ReplayArguments {
  std::vector<std::string> inputs;
  int port = 8081;
  bool loop = false;
};

Child sensor_process(const std::filesystem::path& file, const SensorId& sensor, int port,
                     const ReplayArguments& arguments, Timestamp epoch) {
  Child child{
      fmt::format("replay of {}", file.string()),
      {sibling_program("chorus-sensor"), "--id", sensor.str(), "--port", std::to_string(port),
       "--recording", file.string(), "--set", fmt::format("device.replay.loop={}", arguments.loop),
       "--set", fmt::format("device.replay.epoch_ns={}", to_unix_ns(epoch))}};
  return child;
}

Result<int> run_replay(const ReplayArguments& arguments) {
  const auto files = find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  // Read now: a broken recording, or two of one sensor, should not start half a cell.
  const auto recordings = read_recordings(*files);
  if (!recordings) return pass(recordings);
  if (arguments.port + static_cast<int>(files->size()) - 1 > kLastPort)
    return fail(ErrorCode::InvalidArgument, "--port", "leaves too few ports above it.");
  const Timestamp epoch = std::chrono::ceil<std::chrono::seconds>(SystemClock().now() + kHeadStart);
  std::vector<Child> children;
  for (std::size_t i = 0; i < files->size(); ++i) {
    const int port = arguments.port + static_cast<int>(i);
    const SensorId& sensor = (*recordings)[i].sensor;
    children.push_back(sensor_process((*files)[i], sensor, port, arguments, epoch));
    std::cout << fmt::format("{} at http://127.0.0.1:{}/ from {}\n", sensor.str(), port,
                             (*files)[i].string())
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
  options.add_flag("--loop", arguments->loop, "Start over at the end");
  return [arguments] { return run_replay(*arguments); };
}

}  // namespace chorus::ctl
