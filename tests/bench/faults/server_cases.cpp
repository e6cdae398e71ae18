// Trouble on the server's own host: it is killed, its log is not read, its disk is full, its
// folders are missing.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "tests/bench/faults/trial.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;

/// The poses of all sensors as a string with all digits, for comparison; empty without
/// /registration.
std::string extrinsics(const Cell& cell) {
  nlohmann::json out;
  const auto told = cell.json("/registration");
  if (!told.is_object() || !told.contains("sensors")) return {};
  for (const auto& [name, place] : told["sensors"].items()) {
    for (const auto* key : {"x", "y", "z", "qx", "qy", "qz", "qw"}) out[name][key] = place[key];
  }
  return out.empty() ? std::string() : out.dump();
}

/// Kills the server by SIGKILL, restarts it at once, and checks that all is as before.
Result<void> kill_and_return(Trial& trial, Cell& cell) {
  constexpr double kFirstBody = 0.5;  // from the first answer to the first body [s]
  const Watch watch(cell.port());
  wait_for(1.0);
  const std::string before = extrinsics(cell);
  const FusedInstant last = watch.newest();
  trial.check(!before.empty() && !last.bodies.empty(), "there was a registration and a person");
  cell.fusion().kill();
  if (auto started = cell.start_fusion(); !started) return started;
  const Timestamp back = now();
  const auto first = [&]() -> std::optional<FusedInstant> {
    for (const FusedInstant& each : watch.seen()) {
      if (each.received > back && !each.bodies.empty()) return each;
    }
    return std::nullopt;
  };
  (void)wait_until(8.0, [&] { return first().has_value(); });
  const auto body = first();
  trial.recover_s = body ? seconds(body->received - back) : INFINITY;
  trial.check(trial.recover_s <= kFirstBody,
              fmt::format("first body within {} s: {:.2f}", kFirstBody, trial.recover_s));
  trial.check(extrinsics(cell) == before, "extrinsics are identical to the bit");
  const bool on = body && !last.bodies.empty() && body->bodies.front() > last.bodies.back();
  trial.check(on, fmt::format("ids go on: {} before, {} after",
                              last.bodies.empty() ? 0 : last.bodies.back(),
                              body ? body->bodies.front() : 0));
  trial.rss_mb = cell.fusion().resident_mb();
  return {};
}

Result<void> server_killed(Trial& trial) {
  CellPlan plan;
  plan.stored = true;
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  return kill_and_return(trial, *cell);
}

/// The shipped configuration keeps its state in a folder of the user who runs the server; here this
/// user's home is empty.  The server is killed after a walk and must come back registered.
Result<void> default_folders(Trial& trial) {
  auto home = ScratchFolder::make();
  if (!home) return pass(home);
  const std::string folder = home->path().string();
  CellPlan plan;
  plan.placed = false;
  plan.fusion = {"state_dir=auto", "registration.seconds=10", "registration.first_solve_s=4"};
  plan.surroundings.environment = {"HOME=" + folder, "XDG_STATE_HOME=" + folder + "/state",
                                   "STATE_DIRECTORY=" + folder + "/state"};
  for (int i = 0; i < 3; ++i) plan.of_sensor[i] = {"device.simulated.scene.reach_m=1.2"};
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const auto over = [&] {
    const auto told = cell->json("/registration");
    return told.is_object() && told.value("sensors", nlohmann::json::object()).size() == 3 &&
           told.value("session", nlohmann::json::object()).value("state", "") == "idle";
  };
  if (!wait_until(40.0, over))
    return fail(ErrorCode::Timeout, "/registration", "three sensors were not registered in 40 s");
  if (auto settled = cell->settle(); !settled) return settled;
  return kill_and_return(trial, *cell);
}

Result<void> folder_not_writable(Trial& trial) {
  constexpr int kMistaken = 2;
  CellPlan plan;
  plan.fusion = {"state_dir=/proc/chorus"};
  plan.start_all = false;
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  for (int i = 0; i < 3; ++i) {
    if (auto started = cell->start_sensor(i); !started) return started;
  }
  if (!cell->start_fusion()) {
    const int code = cell->fusion().wait(1.0);
    trial.check(code == kMistaken, fmt::format("it does not start, and says why: {}", code));
    return {};
  }
  std::string told;
  for (const auto* path : {"/healthz", "/registration", "/metrics"})
    told += cell->ask({"GET", path, {{"Accept", "*/*"}}, {}}).body;
  trial.check(
      told.find("/proc/chorus") != std::string::npos || told.find("state_dir") != std::string::npos,
      "/healthz, /registration or /metrics says that nothing can be stored");
  trial.rss_mb = cell->fusion().resident_mb();
  return {};
}

/// A pipe of one page whose reading end is never read.
struct UnreadPipe {
  UnreadPipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) == 0) ::fcntl(ends[1], F_SETPIPE_SZ, 4096);
  }
  ~UnreadPipe() {
    ::close(ends[0]);
    ::close(ends[1]);
  }
  UnreadPipe(const UnreadPipe&) = delete;
  UnreadPipe& operator=(const UnreadPipe&) = delete;
  /// Fills the pipe through another descriptor, because O_NONBLOCK must not apply to the program's
  /// own descriptor.
  void fill() const {
    const int end = ::open(fmt::format("/proc/self/fd/{}", ends[1]).c_str(), O_WRONLY | O_NONBLOCK);
    while (::write(end, "x", 1) == 1) {
    }
    ::close(end);
  }
  std::array<int, 2> ends{};
};

Result<void> unread_log(Trial& trial) {
  const UnreadPipe pipe;
  CellPlan plan;
  plan.surroundings.error_output = pipe.ends[1];
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  pipe.fill();
  const Timestamp begun = now();
  cell->sensor(1).kill();
  wait_for(6.0);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), {"s1", "s3"});
  return {};
}

Result<void> full_disk(Trial& trial) {
  if (::geteuid() != 0) return trial.leave_out("a small file system needs root"), Result<void>{};
  auto disk = ScratchFolder::make();
  if (!disk) return pass(disk);
  CellPlan plan;
  plan.fusion = {"recording.folder=" + (disk->path() / "recordings").string()};
  plan.surroundings.small_disk = disk->path().string();
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  const auto answer = cell->ask({"POST", "/recordings/"});
  trial.check(answer.status == 503, fmt::format("POST /recordings/: {}", answer.status));
  trial.check(answer.body.find(disk->path().string()) == std::string::npos,
              "the answer does not say where this host keeps its files");
  wait_for(2.0);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), cell->placed());
  return {};
}

/// How a program ended.
struct Ending {
  int code = 0;
  std::string said;
};
Result<std::optional<Ending>> start_with_memory(std::size_t bytes) {
  constexpr double kExitPatience = 3.0;
  constexpr int kRuns = -1;
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return fail(ErrorCode::Io, "pipe", "there is none");
  ChildSurroundings surroundings;
  surroundings.address_space = bytes;
  surroundings.error_output = ends[1];
  auto fusion = ChildProcess::start("chorus-fusion",
                                    {"--config", "deploy/config/fusion.json", "--set",
                                     "http.port=0", "--set", "state_dir=", "--set", "viewer_dir="},
                                    surroundings);
  ::close(ends[1]);
  if (!fusion) {
    ::close(ends[0]);
    return pass(fusion);
  }
  Ending ending{fusion->wait(kExitPatience), {}};
  std::array<char, 4096> text{};
  if (ending.code != kRuns) {
    const ssize_t got = ::read(ends[0], text.data(), text.size());
    ending.said.assign(text.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  }
  ::close(ends[0]);
  if (ending.code == kRuns) return std::optional<Ending>{};
  return std::optional(ending);
}

/// Whatever the amount of memory, the program either runs or says why it does not.
Result<void> little_memory(Trial& trial) {
  constexpr std::size_t kMegabyte = 1U << 20U;
  constexpr int kSignalled = 128;
  int refused = 0;
  bool runs = false;
  for (std::size_t mb = 24; mb <= 1024 && !runs; mb += mb / 6) {
    const auto ending = start_with_memory(mb * kMegabyte);
    if (!ending) return pass(ending);
    runs = !*ending;
    if (runs) break;
    ++refused;
    trial.check((*ending)->code < kSignalled && !(*ending)->said.empty(),
                fmt::format("with {} MB it ends with {} and says: {}", mb, (*ending)->code,
                            (*ending)->said));
  }
  trial.check(runs && refused > 0, fmt::format("{} starts were refused, then one runs", refused));
  return {};
}

}  // namespace

FaultCases server_cases() {
  return {
      {"server-killed", "SIGKILL of the server and start again, with a state folder",
       server_killed},
      {"default-folders", "the same with the shipped configuration, after a walk", default_folders},
      {"folder-not-writable", "the state folder cannot be made", folder_not_writable},
      {"unread-log", "stderr is a full pipe that nobody reads, and a sensor dies", unread_log},
      {"full-disk", "POST /recordings/ on a full disk", full_disk},
      {"little-memory", "started with too little memory, then with enough", little_memory},
  };
}

}  // namespace chorus::bench
