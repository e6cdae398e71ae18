#include "tests/bench/live/system_rig.h"

#include <chrono>
#include <cstdlib>
#include <deque>
#include <optional>
#include <thread>

#include "common/http/client.h"
#include "common/http/status.h"
#include "common/net/asio.h"
#include "common/time/clock.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

using std::chrono::milliseconds;

constexpr auto kRegistrationPatience = std::chrono::seconds(60);

/// The integer after `key` in a Turtle document; cheap, so that the watcher costs little.
std::int64_t number_after(const std::string& text, const std::string& key) {
  const auto at = text.find(key);
  return at == std::string::npos ? 0 : std::strtoll(text.c_str() + at + key.size(), nullptr, 10);
}

/// Long-polls one /frame until told to stop; records when each frame came.
class Watcher {
 public:
  Watcher(asio::io_context& io, std::uint16_t port) : client_(io, "127.0.0.1", port), timer_(io) {}

  void start() { ask(); }
  void stop() {
    stopped_ = true;
    client_.close();
    timer_.cancel();
  }
  [[nodiscard]] const std::vector<Seen>& seen() const { return seen_; }

 private:
  void ask() {
    http::ClientRequest request;
    request.target = "/frame";
    request.headers = {{"Accept", "text/turtle"}};
    if (!etag_.empty()) {
      request.headers.emplace_back("If-None-Match", etag_);
      request.headers.emplace_back("Prefer", "wait=5");
    }
    client_.send(std::move(request), std::chrono::seconds(10),
                 [this](Result<http::ClientResponse> answer) {
                   if (!stopped_) take(answer);
                 });
  }

  void take(const Result<http::ClientResponse>& answer) {
    if (!answer) {
      timer_.expires_after(milliseconds(100));
      timer_.async_wait([this](const net::error_code& error) {
        if (!error && !stopped_) ask();
      });
      return;
    }
    if (answer->status == http::status::kOk) {
      seen_.push_back({number_after(answer->body, "ch:sequence "),
                       from_unix_ns(number_after(answer->body, "ch:capturedNanoseconds ")),
                       from_unix_ns(answer->received_ns), answer->body});
      if (const auto etag = answer->headers.find("etag"); etag != answer->headers.end()) {
        etag_ = etag->second;
      }
    }
    ask();
  }

  http::AsyncClient client_;
  net::Timer timer_;
  std::string etag_;
  bool stopped_ = false;
  std::vector<Seen> seen_;
};

Result<ChildProcess> start_sensor(const SystemCase& asked, int index, std::uint16_t port) {
  const auto number = [](auto value) { return std::to_string(value); };
  const HostError& host = asked.hosts.at(static_cast<std::size_t>(index));
  std::vector<std::string> words{"--config", "deploy/config/sensor.json"};
  for (const std::string& setting :
       {"id=s" + number(index + 1), "http.port=" + number(port),
        std::string("device.kind=simulated"), "device.simulated.profile=" + asked.profile,
        "device.simulated.ring.index=" + number(index),
        "device.simulated.ring.count=" + number(kSystemSensors),
        "clock.offset_ms=" + number(host.offset_ms), "clock.drift_ppm=" + number(host.drift_ppm),
        "clock.step_ms=" + number(host.step_ms),
        "clock.step_after_s=" + number(kStepAfter.count())}) {
    words.insert(words.end(), {"--set", setting});
  }
  return ChildProcess::start("chorus-sensor", words);
}

/// The clock of a host whose service starts at `start`; that it starts a little later makes no
/// difference, because the drift in that time is negligible.
synthetic::HostClock clock_of(const HostError& error, Timestamp start) {
  constexpr double kMilli = 1e-3;
  constexpr double kMillionth = 1e-6;
  return {kMilli * error.offset_ms, kMillionth * error.drift_ppm, kMilli * error.step_ms, start,
          start + Duration(kStepAfter)};
}

Cpu cpu_of(const Rig& rig) {
  Cpu cpu;
  for (const ChildProcess& sensor : rig.sensors) cpu.sensors += sensor.cpu_seconds();
  cpu.fusion = rig.fusion.front().cpu_seconds();
  return cpu;
}

}  // namespace

Result<Rig> start_rig(const SystemCase& asked) {
  Rig rig;
  std::string list;
  for (int i = 0; i < kSystemSensors; ++i) {
    const std::uint16_t port = testing::free_port();
    const std::string id = "s" + std::to_string(i + 1);
    rig.clocks.push_back(
        clock_of(asked.hosts.at(static_cast<std::size_t>(i)), SystemClock().now()));
    auto sensor = start_sensor(asked, i, port);
    if (!sensor) return pass(sensor);
    rig.sensors.push_back(std::move(*sensor));
    rig.sensor_ports.push_back(port);
    list += (list.empty() ? "" : ",") + std::string(R"({"id":")") + id +
            R"(","url":"http://127.0.0.1:)" + std::to_string(port) + "/\"}";
  }
  rig.port = testing::free_port();
  auto fusion = ChildProcess::start(
      "chorus-fusion",
      {"--config", "deploy/config/fusion.json", "--set", "http.port=" + std::to_string(rig.port),
       "--set", "sensors=[" + list + "]", "--set", "viewer_dir=", "--set", "state_dir=", "--set",
       "registration.seconds=20"});
  if (!fusion) return pass(fusion);
  rig.fusion.push_back(std::move(*fusion));
  return rig;
}

std::string body_of(const Rig& rig, const char* path, const char* accept) {
  const auto answer =
      http::fetch({"127.0.0.1", rig.port, path}, {"GET", path, {{"Accept", accept}}, {}});
  return answer ? answer->body : std::string();
}

Result<double> wait_until_registered(const Rig& rig) {
  const auto begun = std::chrono::steady_clock::now();
  std::optional<double> first_body;
  const auto since = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  while (since() < static_cast<double>(kRegistrationPatience.count())) {
    if (!rig.fusion.front().alive()) return fail(ErrorCode::Internal, "chorus-fusion", "it ended");
    if (!first_body && body_of(rig, "/frame", "text/turtle").find("ch:body ") != std::string::npos)
      first_body = since();
    const std::string registration = body_of(rig, "/registration", "text/turtle");
    if (first_body && registration.find("\"idle\"") != std::string::npos) return *first_body;
    std::this_thread::sleep_for(milliseconds(50));
  }
  return fail(ErrorCode::Timeout, "registration", "nobody was registered within a minute");
}

Observed observe(const Rig& rig, double run_seconds) {
  asio::io_context io{1};
  std::deque<Watcher> watchers;
  watchers.emplace_back(io, rig.port);
  for (const std::uint16_t port : rig.sensor_ports) watchers.emplace_back(io, port);
  for (Watcher& watcher : watchers) watcher.start();
  const Cpu before = cpu_of(rig);
  const auto begun = std::chrono::steady_clock::now();
  net::Timer end(io);
  end.expires_after(
      std::chrono::duration_cast<milliseconds>(std::chrono::duration<double>(run_seconds)));
  Observed seen;
  end.async_wait([&](const net::error_code&) {
    const Cpu after = cpu_of(rig);
    seen.cpu = {after.sensors - before.sensors, after.fusion - before.fusion};
    seen.elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    for (Watcher& watcher : watchers) watcher.stop();
    io.stop();
  });
  io.run();
  seen.fused = watchers.front().seen();
  for (std::size_t i = 1; i < watchers.size(); ++i) seen.sensors.push_back(watchers[i].seen());
  return seen;
}

}  // namespace chorus::bench
