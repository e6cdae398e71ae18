// What it costs chorus-fusion to record the streams of six sensors and its own: its processor time
// while it records, compared with that just before, and with writing the same frames as plain JSON
// lines.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/http/client.h"
#include "common/http/status.h"
#include "common/record/cell_reader.h"
#include "tests/bench/live/child_process.h"
#include "tests/bench/live/scratch_folder.h"
#include "tests/bench/report/report.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

constexpr int kSensors = 6;
constexpr int kStreams = kSensors + 1;
constexpr double kRate = 30.0;      // [Hz]
constexpr double kLongRun = 60.0;   // [s]; the claim is for CHORUS_RECORD_SECONDS=600
constexpr double kQuickRun = 5.0;   // [s]
constexpr double kMaxCores = 0.10;  // the claim
constexpr auto kPatience = std::chrono::seconds(60);

double run_seconds(const Report& report) {
  const char* wanted = std::getenv("CHORUS_RECORD_SECONDS");
  if (wanted != nullptr) return std::clamp(std::atof(wanted), kQuickRun, 3600.0);
  return report.quick() ? kQuickRun : kLongRun;
}

struct Rig {
  std::vector<ChildProcess> sensors;
  std::vector<ChildProcess> fusion;  ///< One process.
  std::uint16_t port = 0;

  [[nodiscard]] Result<nlohmann::json> ask(const std::string& method, const std::string& target,
                                           const std::string& body = {}) const {
    const auto answer = http::fetch({"127.0.0.1", port, target},
                                    {method, target, {{"Accept", "application/json"}}, body});
    if (!answer) return pass(answer);
    auto json = nlohmann::json::parse(answer->body, nullptr, false);
    if (answer->status >= http::status::kBadRequest || json.is_discarded())
      return fail(ErrorCode::Internal, target, answer->body);
    return json;
  }
};

Result<Rig> start_rig(const fs::path& folder) {
  Rig rig;
  nlohmann::json list = nlohmann::json::array();
  for (int i = 0; i < kSensors; ++i) {
    const std::uint16_t port = testing::free_port();
    const std::string id = "s" + std::to_string(i + 1);
    auto sensor = ChildProcess::start("chorus-sensor",
                                      {"--id", id, "--port", std::to_string(port), "--set",
                                       "device.simulated.ring.index=" + std::to_string(i), "--set",
                                       "device.simulated.ring.count=" + std::to_string(kSensors)});
    if (!sensor) return pass(sensor);
    rig.sensors.push_back(std::move(*sensor));
    list.push_back({{"id", id}, {"url", "http://127.0.0.1:" + std::to_string(port) + "/"}});
  }
  rig.port = testing::free_port();
  auto fusion = ChildProcess::start(
      "chorus-fusion",
      {"--config", "deploy/config/fusion.json", "--set", "http.port=" + std::to_string(rig.port),
       "--set", "sensors=" + list.dump(), "--set", "viewer_dir=", "--set", "state_dir=", "--set",
       "registration.seconds=8", "--set", "recording.folder=" + folder.string()});
  if (!fusion) return pass(fusion);
  rig.fusion.push_back(std::move(*fusion));
  return rig;
}

/// Waits until a person is fused and the session is over, so that the load is steady.
Result<void> wait_until_steady(const Rig& rig) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < deadline) {
    const auto frame = rig.ask("GET", "/frame");
    const auto registration = rig.ask("GET", "/registration");
    if (frame && registration && !frame->value("bodies", nlohmann::json::array()).empty() &&
        (*registration)["session"]["state"] == "idle")
      return {};
    std::this_thread::sleep_for(milliseconds(100));
  }
  return fail(ErrorCode::Timeout, "registration", "nobody was fused within a minute");
}

void sleep_for(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Mean number of cores that a process uses during `seconds`.
double cores_of(const ChildProcess& process, double seconds) {
  const auto begun = std::chrono::steady_clock::now();
  const double before = process.cpu_seconds();
  sleep_for(seconds);
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return (process.cpu_seconds() - before) / elapsed;
}

/// What a recording contains.  `lost`: frames missing according to the sequence numbers in each
/// stream.
struct Contents {
  std::size_t frames = 0;
  std::uint64_t lost = 0;
  std::size_t streams = 0;
  std::uintmax_t json_bytes = 0;  ///< Size of the frames as JSON lines.
};

Result<Contents> contents_of(const fs::path& path) {
  record::ReadLimits limits;
  limits.wanted = [](std::string_view topic) { return topic.ends_with("/frame"); };
  const auto files = record::recording_files(path);
  if (!files) return pass(files);
  Contents contents;
  std::map<std::string, std::uint32_t> last;
  for (const fs::path& file : *files) {
    const auto recording = record::read_recording(file, limits);
    if (!recording) return pass(recording);
    for (const record::Message& message : recording->messages) {
      const auto [seen, fresh] = last.try_emplace(message.topic, message.sequence);
      if (!fresh && message.sequence > seen->second + 1)
        contents.lost += message.sequence - seen->second - 1;
      seen->second = message.sequence;
      ++contents.frames;
      contents.json_bytes += message.data.size();
    }
  }
  contents.streams = last.size();
  return contents;
}

/// Writes the recorded frames as JSON lines, uncompressed, without an index; returns the cores
/// needed to do this at the pace of the recording.
double json_lines_cores(const fs::path& recording, const fs::path& out, double seconds) {
  const auto session = record::read_cell(recording, {.fused = true});
  if (!session) return kNoRatio;
  std::ofstream file(out, std::ios::binary);
  const std::clock_t before = std::clock();
  for (const auto& sensor : session->sensors) {
    for (const SensorFrame& frame : sensor.frames)
      file << resource::write(resource::to_resource(frame), resource::Format::Json);
  }
  for (const auto& frame : session->fused) file << resource::write(frame, resource::Format::Json);
  file.flush();
  return static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / seconds;
}

struct Measured {
  double idle_cores = 0.0;  ///< Cores of chorus-fusion while it does not record.
  double busy_cores = 0.0;  ///< Cores of chorus-fusion while it records.
  double json_lines_cores = kNoRatio;
  nlohmann::json report;
};

Result<Measured> measure(const Rig& rig, double seconds) {
  Measured measured;
  measured.idle_cores = cores_of(rig.fusion.front(), seconds);
  const auto started = rig.ask("POST", "/recordings/", R"({"name":"bench"})");
  if (!started) return pass(started);
  measured.busy_cores = cores_of(rig.fusion.front(), seconds);
  if (const auto stopped = rig.ask("DELETE", "/recordings/bench"); !stopped) return pass(stopped);
  sleep_for(1.0);
  const auto report = rig.ask("GET", "/recordings/bench");
  if (!report) return pass(report);
  measured.report = *report;
  return measured;
}

void report_recording(Report& report, const Measured& measured, const Contents& contents,
                      double seconds) {
  const std::string c = "six-plus-fused";
  const double cost = measured.busy_cores - measured.idle_cores;
  const auto bytes = measured.report.value("bytes", 0.0);
  const double lost = static_cast<double>(contents.lost) + measured.report.value("dropped", 0.0);
  report.row(c, "run_s", seconds, "s");
  report.row(c, "cpu_cores", cost, "cores", "json-lines", cost / measured.json_lines_cores);
  report.row(c, "cpu_cores_fusion_idle", measured.idle_cores, "cores");
  report.row(c, "cpu_cores_fusion_recording", measured.busy_cores, "cores");
  report.row(c, "lost_frames", lost, "frames");
  report.row(c, "frames", static_cast<double>(contents.frames), "frames", "expected",
             static_cast<double>(contents.frames) / (kStreams * kRate * seconds));
  constexpr double kMegabyte = 1e6;
  report.row(c, "file_mb_per_min", bytes / kMegabyte * 60.0 / seconds, "MB/min", "json-lines",
             bytes / static_cast<double>(contents.json_bytes));
  report.condition("seven streams are in the file", contents.streams == kStreams);
  report.condition("nothing is lost", lost == 0.0);
  report.condition("recording costs less than 10 % of a core", cost < kMaxCores);
  report.note(
      "cpu_cores: what chorus-fusion uses more while it records than just before, same cell, same "
      "length.  json-lines writes the same frames as uncompressed text: no scenes for viewers, no "
      "index, no checksums, no compression.  CHORUS_RECORD_SECONDS=600 for the claim's ten "
      "minutes.");
}

}  // namespace

Result<void> run_record(Report& report) {
  report.profile("gauss");
  const auto scratch = ScratchFolder::make();
  if (!scratch) return pass(scratch);
  const double seconds = run_seconds(report);
  const auto rig = start_rig(scratch->path() / "rec");
  if (!rig) return pass(rig);
  if (auto ok = wait_until_steady(*rig); !ok) return ok;
  auto measured = measure(*rig, seconds);
  if (!measured) return pass(measured);
  const fs::path recorded = scratch->path() / "rec/bench";
  const auto contents = contents_of(recorded);
  if (!contents) return pass(contents);
  measured->json_lines_cores = json_lines_cores(recorded, scratch->path() / "lines", seconds);
  report_recording(report, *measured, *contents, seconds);
  return {};
}

}  // namespace chorus::bench
