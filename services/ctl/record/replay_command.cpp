// chorus replay: starts one chorus-sensor process for each recorded sensor, so that the same
// programs run as with hardware.
//
// All processes begin to play at the same instant, about a second after the start, so that the
// recordings of one set stay synchronised.
#include <algorithm>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/asked_program.h"
#include "common/net/listen.h"
#include "common/record/cell_outline.h"
#include "common/record/cell_reader.h"
#include "common/time/clock.h"
#include "services/ctl/convert/sniffed.h"
#include "services/ctl/line/child_processes.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/text_file.h"
#include "services/ctl/record/replay_round.h"

namespace chorus::ctl {
namespace {

constexpr Duration kHeadStart = std::chrono::seconds(1);  // Time in which every process gets ready.
constexpr int kLastPort = 65535;

struct ReplayArguments {
  std::vector<std::string> inputs;
  int port = 8081;
  bool loop = false;
  double speed = 1.0;
  std::string save_registration;
};

/// The recording that one process plays.
struct Part {
  SensorId sensor;
  std::filesystem::path from;  ///< A file, or the folder of a recording in several files.
};

Result<std::vector<Part>> parts_of(const std::vector<record::SensorStay>& stays) {
  std::vector<Part> parts;
  for (const auto& stay : stays) {
    const auto& files = stay.files;
    const auto folder = files.front().parent_path();
    const bool together = std::all_of(
        files.begin(), files.end(), [&](const auto& file) { return file.parent_path() == folder; });
    if (!together) {
      return fail(ErrorCode::InvalidArgument, files.back().string(),
                  "is a part of a recording whose other files are in another folder.");
    }
    parts.push_back({stay.about.sensor, files.size() == 1 ? files.front() : folder});
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

/// Names the sensors that the files name but of which nothing can be played.
void tell_absent(const std::vector<record::CellLine>& lines,
                 const std::vector<record::SensorStay>& stays) {
  for (const auto& line : lines) {
    for (const SensorId& sensor : line.sensors) {
      const auto same = [&](const auto& stay) { return stay.about.sensor == sensor; };
      if (std::ranges::none_of(stays, same))
        std::cerr << "note: " << sensor.str() << " delivered no frame while this was recorded\n";
    }
  }
}

/// The streams to play; after an error, such as a sensor that occurs twice, nothing may be started.
Result<std::vector<record::SensorStay>> stays_of(const std::vector<record::CellLine>& lines) {
  for (const auto& line : lines) {
    for (const std::string& damage : line.damage) std::cerr << "note: " << damage << '\n';
  }
  auto stays = record::sensor_stays(lines);
  if (stays && stays->empty())
    return fail(ErrorCode::NotFound, "recordings", "hold no frames of a sensor");
  if (stays) tell_absent(lines, *stays);
  return stays;
}

/// Saves the recorded registration, so that nobody has to register the sensors again.
Result<void> hand_on_registration(const std::vector<record::CellLine>& lines,
                                  const std::string& file) {
  const auto recorded = record::last_registration(lines);
  if (!recorded) return pass(recorded);
  if (!*recorded) {
    if (!file.empty())
      std::cerr << "note: no registration was recorded to write to " << file << '\n';
    return {};
  }
  if (file.empty()) {
    std::cerr << "note: where the sensors stood was recorded too; --save-registration FILE, then "
                 "chorus-fusion --set registration.file=FILE\n";
    return {};
  }
  return write_text(file, **recorded);
}

/// Refuses ports that are taken, before any sensor starts: a sensor's own error would name a key of
/// its configuration, which `chorus replay` does not have.
Result<void> check_ports(int first, std::size_t count) {
  for (int port = first; port < first + static_cast<int>(count); ++port) {
    asio::io_context io{1};
    net::Acceptor acceptor(io.get_executor());
    const auto unused =
        net::listen_on(acceptor, {"127.0.0.1", static_cast<std::uint16_t>(port), "--port"});
    if (!unused) return unused;
  }
  return {};
}

Result<int> play(const std::vector<Part>& parts, const std::optional<Round>& round,
                 const ReplayArguments& arguments) {
  const Timestamp epoch = std::chrono::ceil<std::chrono::seconds>(SystemClock().now() + kHeadStart);
  std::vector<Child> children;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const int port = arguments.port + static_cast<int>(i);
    children.push_back(sensor_process(parts[i], port, arguments, epoch));
    if (round) share(*round, children.back());
    std::cout << fmt::format("{} at http://127.0.0.1:{}/ from {}\n", parts[i].sensor.str(), port,
                             parts[i].from.string())
              << std::flush;
  }
  std::cout << fmt::format("playing {} {} until Ctrl-C{}\n", parts.size(),
                           parts.size() == 1 ? "sensor" : "sensors",
                           arguments.loop ? "" : "; the last frames stay when the recording ends")
            << std::flush;
  const auto done = run_children(children);
  if (!done) return pass(done);
  return kExitOk;
}

Result<int> run_replay(const ReplayArguments& arguments) {
  const auto files = record::find_recordings({arguments.inputs.begin(), arguments.inputs.end()});
  if (!files) return pass(files);
  if (auto ok = may_write(arguments.save_registration, *files); !ok) return pass(ok);
  const auto lines = record::cell_lines(*files);
  if (!lines) return pass(lines);
  const auto stays = stays_of(*lines);
  if (!stays) return pass(stays);
  const RoundPlan plan = plan_round(*stays);
  if (!plan.note.empty()) std::cerr << "note: " << plan.note << '\n';
  const auto parts = parts_of(*stays);
  if (!parts) return pass(parts);
  if (arguments.port + static_cast<int>(parts->size()) - 1 > kLastPort)
    return fail(ErrorCode::InvalidArgument, "--port", "leaves too few ports above it.");
  if (auto ok = check_ports(arguments.port, parts->size()); !ok) return pass(ok);
  if (auto ok = hand_on_registration(*lines, arguments.save_registration); !ok) return pass(ok);
  return play(*parts, plan.round, arguments);
}

}  // namespace

Run add_replay(CLI::App& options) {
  const auto arguments = std::make_shared<ReplayArguments>();
  options.add_option("recordings", arguments->inputs, "Folders or .mcap files")->required();
  options.add_option("--port", arguments->port, "Port of the first; the others follow")
      ->check(CLI::Range(1, kLastPort))
      ->capture_default_str();
  options.add_option("--speed", arguments->speed, "2 is twice as fast")
      ->check(number_range(0.01, 100.0))
      ->capture_default_str();
  options.add_flag("--loop", arguments->loop, "Start over at the end");
  options.add_option(
      "--save-registration", arguments->save_registration,
      "Write the registration of the recording to this file, for chorus-fusion --set "
      "registration.file=FILE");
  return [arguments] { return sniffed(run_replay(*arguments), arguments->inputs); };
}

}  // namespace chorus::ctl
