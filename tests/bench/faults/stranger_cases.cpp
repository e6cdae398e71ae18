// What strangers found: pages in frames, guesses that lock others out, seats that are taken without
// a word, files that are none, signals that mean nothing, floods of requests.
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>

#include <fmt/format.h>

#include "tests/bench/faults/sockets.h"
#include "tests/bench/faults/trial.h"
#include "tests/support/free_port.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSecret = "0123456789abcdef0123456789abcdef";

std::string asking(std::string_view method, std::string_view path, std::string_view more = {}) {
  return fmt::format(
      "{} {} HTTP/1.1\r\nHost: 127.0.0.1\r\n{}Content-Length: 0\r\n"
      "Connection: close\r\n\r\n",
      method, path, more);
}

std::string with_token(std::string_view token) {
  return asking("POST", "/registration", fmt::format("Authorization: Bearer {}\r\n", token));
}

Result<void> framed_page(Trial& trial) {
  auto cell = Cell::start({.sensors = 2, .fusion = {"viewer_dir=services/viewer"}});
  if (!cell) return pass(cell);
  const End end{.port = cell->port()};
  for (const char* path : {"/", "/viewer/"}) {
    const auto head = head_of_answer(end, asking("GET", path, "Accept: text/html\r\n"));
    trial.check(status_of(head) == 200, fmt::format("{} is answered: {}", path, status_of(head)));
    trial.check(head.find("frame-ancestors 'none'") != std::string::npos,
                fmt::format("{} says that nobody may frame it", path));
  }
  return {};
}

Result<void> guesser_beside(Trial& trial) {
  CellPlan plan{.sensors = 2};
  plan.fusion = {fmt::format("http.bearer_token={}", kSecret)};
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const End end{.port = cell->port()};
  std::vector<RawSocket> guessers;
  for (int i = 0; i < 60; ++i) {
    guessers.push_back(connect_to(end));
    guessers.back().say(with_token(fmt::format("wrong {}", i)));
  }
  wait_for(0.3);
  const Timestamp asked = now();
  const int status = status_of(head_of_answer(end, with_token(kSecret)));
  trial.check((status / 100 == 2 || status == 409) && seconds(now() - asked) < 1.0,
              fmt::format("the right token from the same address is taken at once: {}", status));
  return {};
}

Settings vrpn_alone(std::uint16_t port) {
  return {"outputs.vrpn.enabled=true", fmt::format("outputs.vrpn.port={}", port)};
}

Result<void> vrpn_idle(Trial& trial) {
  const std::uint16_t port = testing::free_port();
  auto cell = Cell::start({.sensors = 2, .fusion = vrpn_alone(port)});
  if (!cell) return pass(cell);
  std::vector<RawSocket> idle;
  for (int i = 0; i < 64; ++i) idle.push_back(connect_to({.port = port}));
  wait_for(0.3);
  testing::VrpnClient client({"Body0"});
  const bool served =
      client.connect(port) &&
      client.next("vrpn_Tracker Pos_Quat", std::chrono::milliseconds(3000)).has_value();
  trial.check(served, "a client of the host with 64 idle connections gets poses");
  return {};
}

Result<void> dtrack_idle(Trial& trial) {
  const std::uint16_t port = testing::free_port();
  auto cell =
      Cell::start({.sensors = 2,
                   .fusion = {"outputs.dtrack.enabled=true", "outputs.dtrack.command.enabled=true",
                              fmt::format("outputs.dtrack.command.port={}", port)}});
  if (!cell) return pass(cell);
  std::vector<RawSocket> idle;
  for (int i = 0; i < 4; ++i) idle.push_back(connect_to({.port = port}));
  wait_for(0.3);
  const auto client = connect_to({.port = port});
  (void)client.say(std::string_view("dtrack2 get status active\0", 26));
  trial.check(client.hear(3.0).starts_with("dtrack2 set status"),
              "a client of the host with four idle connections is answered");
  return {};
}

/// A server whose state folder has `made` in the place of registration.json.
Result<void> strange_state(Trial& trial, const std::function<void(const fs::path&)>& make) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("chorus-faults-{}", ::getpid());
  fs::remove_all(folder);
  fs::create_directories(folder);
  make(folder / "registration.json");
  CellPlan plan{.sensors = 2};
  plan.placed = false;
  plan.fusion = {fmt::format("state_dir={}", folder.string())};
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const auto told = cell->json("/registration");
  const std::string problem =
      told.is_object() ? told.value("storeProblem", std::string()) : std::string();
  trial.check(problem.find("cannot be read") != std::string::npos,
              "the damage is told: " + (problem.empty() ? std::string("nothing") : problem));
  cell->fusion().send(SIGTERM);
  trial.check(cell->fusion().wait(5.0) == 0, "SIGTERM ends it with 0");
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return {};
}

Result<void> fifo_state(Trial& trial) {
  return strange_state(trial, [](const fs::path& path) { (void)::mkfifo(path.c_str(), 0600); });
}

Result<void> self_link(Trial& trial) {
  return strange_state(trial, [](const fs::path& path) { fs::create_symlink(path, path); });
}

Result<void> idle_signals(Trial& trial) {
  auto cell = Cell::start({.sensors = 2});
  if (!cell) return pass(cell);
  for (const int signal : {SIGUSR1, SIGUSR2}) {
    cell->fusion().send(signal);
    cell->sensor(0).send(signal);
  }
  wait_for(0.5);
  trial.check(cell->fusion().alive() && cell->sensor(0).alive(), "SIGUSR1 and SIGUSR2 end nothing");
  return {};
}

/// How long so many requests take one after another on one connection [s].
double seconds_for(const End& end, std::string_view path, int requests) {
  const auto client = connect_to(end);
  const std::string request = fmt::format("HEAD {} HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n", path);
  const Timestamp begun = now();
  for (int i = 0; i < requests; ++i) {
    client.say(request);
    if (client.hear(5.0).empty()) return INFINITY;
  }
  return seconds(now() - begun);
}

Result<void> described_often(Trial& trial) {
  auto cell = Cell::start({.sensors = 2});
  if (!cell) return pass(cell);
  const End end{.port = cell->port()};
  constexpr int kMany = 500;
  constexpr double kMost = 3.0;
  const double usual = seconds_for(end, "/openapi.json", kMany);
  const double described = seconds_for(end, "/.well-known/wot", kMany);
  trial.check(
      described < kMost * usual,
      fmt::format("/.well-known/wot is made once: {:.0f} us a request, /openapi.json {:.0f}",
                  1e6 * described / kMany, 1e6 * usual / kMany));
  return {};
}

Result<void> request_flood(Trial& trial) {
  const auto host = foreign_address();
  if (!host) return trial.leave_out("this host has no address beside loopback"), Result<void>{};
  CellPlan plan{.sensors = 2, .address = "0.0.0.0"};
  plan.fusion = {fmt::format("http.tokens=[{{\"token\":\"{}\",\"role\":\"control\"}}]", kSecret),
                 "http.max_requests_per_s=200"};
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(0.5);
  std::string many;
  for (int i = 0; i < 100; ++i)
    many += fmt::format("GET /frame HTTP/1.1\r\nHost: {}\r\nAuthorization: Bearer {}\r\n\r\n",
                        *host, kSecret);
  const Timestamp begun = now();
  std::vector<RawSocket> readers;
  for (int i = 0; i < 8; ++i) readers.push_back(connect_to({*host, cell->port()}, true));
  while (seconds(now() - begun) < 3.0) {
    for (const RawSocket& reader : readers) (void)reader.say(many);
    wait_for(0.05);
  }
  const auto metrics = cell->ask({"GET", "/metrics"}).body;
  trial.check(metrics.find("chorus_http_held_total 0\n") == std::string::npos,
              "requests beyond the allowance of their address wait");
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), cell->placed());
  return {};
}

}  // namespace

FaultCases stranger_cases() {
  return {
      {"framed-page", "a foreign page shows ours in a frame", framed_page, true},
      {"guesser-beside", "sixty guesses from the address of the right token", guesser_beside, true},
      {"vrpn-idle", "64 idle VRPN connections of one host, and a client of it", vrpn_idle},
      {"dtrack-idle", "four idle DTrack connections of one host, and a client of it", dtrack_idle},
      {"fifo-state", "registration.json is a pipe that nobody writes to", fifo_state, true},
      {"self-link", "registration.json is a link to itself", self_link, true},
      {"idle-signals", "SIGUSR1 and SIGUSR2", idle_signals, true},
      {"described-often", "the Thing Description is asked for again and again", described_often},
      {"request-flood", "one host pipelines requests and reads no answer", request_flood},
  };
}

}  // namespace chorus::bench
