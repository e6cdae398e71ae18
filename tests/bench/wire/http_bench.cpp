// chorus-bench http: compares serving /frame with nginx serving the same bytes, and measures the
// age of long-polled frames.
#include <chrono>
#include <cstdio>
#include <thread>

#include "common/http/server.h"
#include "common/resource/link_lines.h"
#include "tests/bench/report/report.h"
#include "tests/bench/wire/http_load.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using http::DocumentPtr;

constexpr int kConnections = 64;
constexpr double kMinRatio = 0.85;  // fraction of nginx's requests per second
constexpr double kMaxAgeMs = 5.0;   // 99 % of long-polled frames are younger
constexpr double kFramesPerSecond = 30;
constexpr int kJoints = 25;

/// One person in the compact Turtle of proto/README.md, after a comment with the time of
/// publication.
std::string frame_body(std::uint64_t sequence, std::int64_t steady_ns) {
  std::string text = "# " + std::to_string(steady_ns) +
                     "\n@prefix ch: <https://w3id.org/chorus-tracking/ns#> .\n<frame> a ch:Frame ; "
                     "ch:sequence " +
                     std::to_string(sequence) + " ; ch:source \"s1\" ; ch:body <skeletons/7> .\n";
  for (int joint = 0; joint < kJoints; ++joint) {
    char line[512];
    std::snprintf(line, sizeof line,
                  "<skeletons/7#Joint%02d> a ch:Joint ; ch:jointName \"Joint%02d\" ; ch:x %.4f ; "
                  "ch:y %.4f ; ch:z %.4f ; ch:qx 0.12345 ; ch:qy -0.23456 ; ch:qz 0.34567 ; ch:qw "
                  "0.90123 ; ch:state ch:Tracked .\n",
                  joint, joint, 0.01 * joint, 1.0 + 0.01 * joint, 2.0 - 0.01 * joint);
    text += line;
  }
  return text;
}

DocumentPtr frame_document(std::uint64_t sequence, std::int64_t steady_ns) {
  http::DocumentOptions options;
  options.version = std::to_string(sequence);
  options.content_location = "frames/" + options.version;
  options.captured = SystemClock().now();
  std::vector<http::Variant> variants;
  variants.push_back({"text/turtle", [=] { return frame_body(sequence, steady_ns); }});
  return std::make_shared<const http::Document>(std::move(variants), std::move(options));
}

/// Serves /frame; publishes a new version at `rate_hz`, unless that is zero.
ServingProcess::Serve serving(double rate_hz) {
  return [rate_hz](const auto& say_port, const auto& wait_for_end) {
    auto frame = std::make_shared<http::LiveDocument>();
    frame->publish(frame_document(1, 0));
    auto router = std::make_shared<http::Router>();
    router->live("/frame", frame);
    http::Server server({.policy = resource::answer_policy()}, router);
    if (!server.start()) return;
    std::jthread publisher;
    if (rate_hz > 0.0) {
      publisher = std::jthread([&](const std::stop_token& stop) {
        auto next = std::chrono::steady_clock::now();
        for (std::uint64_t sequence = 2; !stop.stop_requested(); ++sequence) {
          next += std::chrono::nanoseconds(from_seconds(1.0 / rate_hz));
          std::this_thread::sleep_until(next);
          const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
          frame->publish(frame_document(sequence, now));
        }
      });
    }
    say_port(server.port());
    wait_for_end();
  };
}

struct Load {
  std::vector<double> requests_per_s;
  std::vector<double> cpu_us;
};

Result<void> add_run(const ServingProcess& server, int run_seconds, Load& load) {
  const double before = server.cpu_seconds();
  const auto run = run_wrk(server.port(), kConnections, run_seconds);
  if (!run) return pass(run);
  constexpr double kUsPerSecond = 1e6;
  load.requests_per_s.push_back(run->requests_per_s);
  load.cpu_us.push_back((server.cpu_seconds() - before) / run->requests * kUsPerSecond);
  return {};
}

Result<void> frame_64(Report& report) {
  const std::string body = frame_body(1, 0);
  const auto ours = ServingProcess::fork(serving(0.0));
  if (!ours) return pass(ours);
  const auto nginx = ServingProcess::nginx(body);
  if (!nginx) return pass(nginx);
  Load our_load;
  Load nginx_load;
  std::vector<double> ratios;
  const int rounds = report.quick() ? 1 : 5;
  const int run_seconds = report.quick() ? 1 : 3;
  for (int round = 0; round < rounds;
       ++round) {  // Both run in turns and see the same machine load.
    if (auto run = add_run(*ours, run_seconds, our_load); !run) return run;
    if (auto run = add_run(*nginx, run_seconds, nginx_load); !run) return run;
    ratios.push_back(our_load.requests_per_s.back() / nginx_load.requests_per_s.back());
  }
  const double ratio = median(ratios);
  report.row("frame-64", "requests_per_s", median(our_load.requests_per_s), "1/s", "nginx", ratio);
  report.row("frame-64", "server_cpu_us", median(our_load.cpu_us), "us", "nginx",
             median(our_load.cpu_us) / median(nginx_load.cpu_us));
  report.row("frame-64", "body_bytes", static_cast<double>(body.size()), "B");
  report.condition("frame-64: at least 0.85 of nginx's requests per second", ratio >= kMinRatio);
  return {};
}

Result<void> longpoll_300(Report& report) {
  const auto server = ServingProcess::fork(serving(kFramesPerSecond));
  if (!server) return pass(server);
  LongPollLoad load;
  load.port = server->port();
  load.run_seconds = report.quick() ? 2.0 : 10.0;
  const double before = server->cpu_seconds();
  auto ages = run_long_polls(load);
  if (!ages) return pass(ages);
  constexpr double kMsPerSecond = 1000.0;
  const double p99 = percentile(ages->ages, 0.99) * kMsPerSecond;
  report.row("longpoll-300", "data_age_p50_ms", percentile(ages->ages, 0.5) * kMsPerSecond, "ms");
  report.row("longpoll-300", "data_age_p99_ms", p99, "ms");
  report.row("longpoll-300", "frames_repeated_or_missed",
             static_cast<double>(ages->repeated_or_missed), "frames");
  report.row("longpoll-300", "server_cpu_us",
             (server->cpu_seconds() - before) / static_cast<double>(ages->answers) * 1e6, "us");
  report.condition("longpoll-300: 99 % of the frames are younger than 5 ms", p99 < kMaxAgeMs);
  return {};
}

}  // namespace

Result<void> run_http(Report& report) {
  report.note(
      "frame-64: wrk -t1 -c64, ours and nginx (1 worker, open_file_cache) in turns, medians; "
      "ours sends about 0.7 kB more header fields (links, CORS, clock) with the same body.");
  report.note(
      "longpoll-300: 300 clients in one process, 30 frames/s; age on the steady clock from "
      "publish to complete receipt.");
  if (auto done = frame_64(report); !done) return done;
  return longpoll_300(report);
}

}  // namespace chorus::bench
