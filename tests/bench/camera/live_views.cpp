#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/duration.h"
#include "common/body/bones.h"
#include "common/http/client.h"
#include "common/http/status.h"
#include "common/time/clock.h"
#include "tests/bench/camera/four_views.h"
#include "tests/bench/live/child_process.h"
#include "tests/judge/statistics.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

using std::chrono::milliseconds;
using Json = nlohmann::json;

constexpr double kTakeSeconds = 100.0 / kTruthHz;
// Time that is left out around the end of the take, where bodies jump to the take's beginning [s].
constexpr double kJoin = 0.3;
constexpr auto kPatience = std::chrono::seconds(120);
constexpr auto kSettling = std::chrono::seconds(6);
constexpr double kWatched = 30.0;  // [s]

struct Cell {
  std::vector<ChildProcess> processes;  ///< The fusion server last.
  std::uint16_t port = 0;
};

/// The runner that a sensor is configured to use.
struct Looking {
  std::string model;
  const Answers* answers = nullptr;  ///< Null: the runner as shipped.
};

std::string setting_of(const Looking& looking, const std::string& camera) {
  if (looking.answers == nullptr) return "device.camera.model=" + looking.model;
  return "device.camera.runner=" + Json(looking.answers->runner_of(looking.model, camera)).dump();
}

Result<Cell> start(const Looking& looking, int cameras) {
  Cell cell;
  std::string list;
  for (int i = 1; i <= cameras; ++i) {
    const std::uint16_t port = testing::free_port();
    const std::string id = fmt::format("cam0{}", i);
    std::vector<std::string> words{"--config", fmt::format("{}/{}.json", kFourVideos, id),
                                   "--set",    fmt::format("http.port={}", port),
                                   "--set",    "device.camera.max_rate_hz=30",
                                   "--set",    setting_of(looking, id)};
    if (looking.answers != nullptr) words.insert(words.end(), {"--set", "device.camera.model="});
    auto sensor = ChildProcess::start("chorus-sensor", words);
    if (!sensor) return pass(sensor);
    cell.processes.push_back(std::move(*sensor));
    list +=
        fmt::format(R"({}{{"id":"{}","url":"http://127.0.0.1:{}/"}})", i > 1 ? "," : "", id, port);
  }
  cell.port = testing::free_port();
  auto fusion = ChildProcess::start(
      "chorus-fusion",
      {"--config", "deploy/config/fusion.json", "--set", fmt::format("http.port={}", cell.port),
       "--set", "sensors=[" + list + "]", "--set", "viewer_dir=", "--set", "state_dir=", "--set",
       fmt::format("registration.file={}/registration.json", kFourVideos), "--set",
       "registration.auto=false"});
  if (!fusion) return pass(fusion);
  cell.processes.push_back(std::move(*fusion));
  return cell;
}

std::optional<Json> get(const Cell& cell, const char* path) {
  const auto answer = http::fetch({"127.0.0.1", cell.port, path},
                                  {"GET", path, {{"Accept", "application/json"}}, {}});
  if (!answer || answer->status != http::status::kOk) return std::nullopt;
  auto document = Json::parse(answer->body, nullptr, false);
  if (document.is_discarded()) return std::nullopt;
  return document;
}

Skeleton<WorldSpace> body_of(const Json& body) {
  Skeleton<WorldSpace> skeleton;
  for (const auto& [name, stated] : body.at("joints").items()) {
    const auto id = joint_named(name);
    if (!id || !stated.contains("x")) continue;
    Joint& joint = skeleton[*id];
    joint.position = Eigen::Vector3d(stated.at("x").get<double>(), stated.at("y").get<double>(),
                                     stated.at("z").get<double>());
    joint.state =
        stated.value("state", "") == "Tracked" ? JointState::Tracked : JointState::Inferred;
    if (stated.value("state", "") == "NotTracked") joint.state = JointState::NotTracked;
  }
  return skeleton;
}

struct Watched {
  Agreement agreement;
  std::vector<double> ages;  ///< Age of each frame at its receipt [s].
  double frames = 0.0;
  double with_body = 0.0;
};

void take(const Json& frame, const importers::ImportedSet& set, Watched& out) {
  const std::int64_t captured = std::stoll(frame.at("capturedNanoseconds").get<std::string>());
  out.frames += 1.0;
  out.ages.push_back(chorus::seconds(SystemClock().now() - from_unix_ns(captured)));
  const auto& bodies = frame.at("bodies");
  if (!bodies.empty()) out.with_body += 1.0;
  // Sensors begin their rounds at whole multiples of the take's length since 1970.  There have been
  // 1e9 rounds, so the length must be the same to the nanosecond: one less is a second's
  // difference.
  const double at =
      chorus::seconds(from_unix_ns(captured).time_since_epoch() % from_seconds(kTakeSeconds));
  if (at < kJoin || at > kTakeSeconds - kJoin) return;
  const auto& truth = set.truth.at(static_cast<std::size_t>(at * kTruthHz)).skeleton;
  if (bodies.empty()) return out.agreement.missed(truth);
  out.agreement.add(body_of(bodies.front()), truth);
}

Result<Watched> watch(const Cell& cell, const importers::ImportedSet& set) {
  const auto begun = std::chrono::steady_clock::now();
  const auto since = [&] { return std::chrono::steady_clock::now() - begun; };
  while (since() < kPatience) {
    const auto frame = get(cell, "/frame");
    if (frame && !frame->at("bodies").empty()) break;
    std::this_thread::sleep_for(milliseconds(100));
  }
  std::this_thread::sleep_for(kSettling);
  Watched out;
  std::int64_t last = 0;
  const auto end =
      std::chrono::steady_clock::now() + milliseconds(static_cast<std::int64_t>(1000 * kWatched));
  while (std::chrono::steady_clock::now() < end) {
    const auto frame = get(cell, "/frame");
    const std::int64_t sequence = frame ? frame->at("sequence").get<std::int64_t>() : last;
    if (sequence != last) take(*frame, set, out);
    last = sequence;
    std::this_thread::sleep_for(milliseconds(10));
  }
  if (out.frames > 0.0) return out;
  return fail(ErrorCode::Timeout, "chorus-fusion", "it answered nothing");
}

Result<void> measure(Report& report, const Looking& looking, int cameras,
                     const importers::ImportedSet& set) {
  const auto cell = start(looking, cameras);
  if (!cell) return pass(cell);
  const auto watched = watch(*cell, set);
  if (!watched) return pass(watched);
  const std::string name = fmt::format("four-views-live-{}-{}of-{}", looking.model,
                                       looking.answers != nullptr ? "recalled-" : "", cameras);
  watched->agreement.report(report, name);
  report.row(name, "frames_hz", watched->frames / kWatched, "Hz");
  report.row(name, "with_body_percent", 100.0 * watched->with_body / watched->frames, "%");
  report.row(name, "age_p50_ms", 1e3 * percentile(watched->ages, 0.5), "ms");
  report.row(name, "age_p90_ms", 1e3 * percentile(watched->ages, 0.9), "ms");
  double rate = 0.0;
  const Json listed = get(*cell, "/sensors/").value_or(Json::object());
  const Json sensors = listed.value("sensors", Json::object());
  for (const Json& sensor : sensors) rate += sensor.value("rateHz", 0.0) / cameras;
  report.row(name, "camera_hz", rate, "Hz");
  return {};
}

}  // namespace

Result<void> live_views(Report& report) {
  importers::ImportOptions options;
  options.rays = true;
  const auto set = importers::import_files(importers::FileFormat::Pose2Sim, {kFourViews}, options);
  if (!set) return pass(set);
  const Answers answers;
  for (const char* model : {"movenet", "blazepose-lite"}) {
    if (const auto learned = looked_at(model, *set, answers); !learned) return pass(learned);
    for (const int cameras : {2, 4}) {
      if (auto done = measure(report, {model, &answers}, cameras, *set); !done) return done;
      if (auto done = measure(report, {model}, cameras, *set); !done) return done;
    }
  }
  report.note(
      "four-views-live: chorus-sensor, runner and chorus-fusion as shipped, published places and "
      "lenses; all cameras share this computer.  recalled: the runner's answer to each picture was "
      "found "
      "beforehand and is given at once, as on a graphics card.  Instants within 0.3 s of where the "
      "take begins "
      "again are not compared: nobody jumps.");
  return {};
}

}  // namespace chorus::bench
