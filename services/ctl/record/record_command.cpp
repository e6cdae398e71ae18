// chorus record URL --out FILE: records a running sensor or fusion server into a file on this
// machine.
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "common/client/service_client.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/line/text_file.h"
#include "services/ctl/record/live_recording.h"

namespace chorus::ctl {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr milliseconds kLook{200};
constexpr auto kGoneAfter = std::chrono::seconds(10);

struct RecordArguments {
  std::string url = client::default_server();
  std::string out;
  double seconds = 0.0;
  bool raw = false;
  bool fused = false;
  bool site = false;
  bool json = false;
};

/// How the recording ended.
enum class End { Asked, TimeIsUp, Gone };

/// Checks a few times a second whether the recording is over, while the sensors are polled.
class RecordingWatch {
 public:
  RecordingWatch(asio::io_context& io, const LiveRecording& live, const RecordArguments& arguments)
      : io_(io),
        live_(live),
        arguments_(arguments),
        timer_(io),
        signals_(io, SIGINT, SIGTERM),
        progress_(std::cerr, on_terminal(), "recording") {}

  End run() {
    signals_.async_wait([this](const net::error_code& error, int) {
      if (!error) finish(End::Asked);
    });
    look();
    io_.run();
    progress_.finish();
    return end_;
  }

 private:
  void look() {
    timer_.expires_after(kLook);
    timer_.async_wait([this](const net::error_code& error) {
      if (error) return;
      const double elapsed = std::chrono::duration<double>(SteadyClock::now() - begun_).count();
      if (arguments_.seconds > 0.0) {
        progress_.show(elapsed / arguments_.seconds, "");
        if (elapsed >= arguments_.seconds) return finish(End::TimeIsUp);
      }
      if (live_.silence() > kGoneAfter) return finish(End::Gone);
      look();
    });
  }

  void finish(End how) {
    end_ = how;
    signals_.cancel();
    io_.stop();
  }

  asio::io_context& io_;
  const LiveRecording& live_;
  const RecordArguments& arguments_;
  net::Timer timer_;
  asio::signal_set signals_;
  Progress progress_;
  SteadyClock::time_point begun_ = SteadyClock::now();
  End end_ = End::Asked;
};

nlohmann::json stream_json(const client::StreamCount& count) {
  nlohmann::json json{{"frames", count.frames},
                      {"missed", count.missed},
                      {"failed", count.failed},
                      {"unreadable", count.unreadable}};
  if (!count.error.empty()) json["lastError"] = count.error;
  return json;
}

nlohmann::json summary_of(const LiveRecording& live, const record::RecordingReport& report,
                          const std::string& file) {
  nlohmann::json streams = nlohmann::json::object();
  for (const auto& [topic, count] : live.counts()) streams[topic] = stream_json(count);
  return {{"file", file},
          {"seconds", chorus::seconds(report.stopped.value_or(report.started) - report.started)},
          {"bytes", report.bytes()},
          {"frames", report.frames},
          {"dropped", report.dropped},
          {"streams", streams},
          {"troubles", live.troubles()}};
}

void print_summary(const nlohmann::json& summary, bool json) {
  if (json) {
    std::cout << summary.dump(2) << '\n';
    return;
  }
  std::vector<std::vector<std::string>> rows{
      {"stream", "frames", "missed", "failed", "unreadable"}};
  for (const auto& [topic, count] : summary["streams"].items())
    rows.push_back({topic, count["frames"].dump(), count["missed"].dump(), count["failed"].dump(),
                    count["unreadable"].dump()});
  constexpr double kMegabyte = 1e6;
  std::cout << table(rows)
            << fmt::format("{}: {:.1f} s, {:.2f} MB\n", summary["file"].get<std::string>(),
                           summary["seconds"].get<double>(),
                           summary["bytes"].get<double>() / kMegabyte);
  for (const auto& [topic, count] : summary["streams"].items()) {
    if (count.contains("lastError"))
      std::cerr << fmt::format("{}: the last error: {}\n", topic,
                               count["lastError"].get<std::string>());
  }
  for (const auto& [path, trouble] : summary["troubles"].items())
    std::cerr << fmt::format("{}: the last error: {}\n", path, trouble.get<std::string>());
}

/// The streams that the service announced but that never delivered a frame.
std::vector<std::string> silent_streams(const LiveRecording& live) {
  std::vector<std::string> silent;
  for (const auto& [topic, count] : live.counts()) {
    if (count.frames == 0) silent.push_back(topic);
  }
  return silent;
}

Result<int> judge(const LiveRecording& live, const record::RecordingReport& report, End end,
                  const RecordArguments& arguments) {
  if (report.state != record::RecordingState::Finished) {
    return fail(ErrorCode::Io, arguments.out,
                report.reason.empty() ? "the file could not be finished in time" : report.reason);
  }
  if (report.frames == 0) {
    // Only our own empty file: the recorder never opens one that was there before.
    std::error_code ignored;
    std::filesystem::remove(arguments.out, ignored);
    return fail(ErrorCode::Unavailable, arguments.url,
                "delivered no frame in this time; no file is left behind");
  }
  if (end == End::Gone) {
    return fail(ErrorCode::Unavailable, arguments.url,
                "has not answered for ten seconds; what came before is in " + arguments.out);
  }
  if (const auto silent = silent_streams(live); !silent.empty()) {
    return fail(ErrorCode::Unavailable, arguments.url,
                fmt::format("delivered no frame of {}; the others are in {}",
                            fmt::join(silent, ", "), arguments.out));
  }
  return kExitOk;
}

Result<int> run_record(const RecordArguments& arguments) {
  const auto url = http::parse_url(arguments.url);
  if (!url) return pass(url);
  if (auto ok = may_write(arguments.out, {}); !ok) return pass(ok);
  if (!arguments.out.ends_with(".mcap"))
    return fail(ErrorCode::InvalidArgument, "--out",
                "a recording is an .mcap file, and is found in a folder by that ending; name it " +
                    arguments.out + ".mcap");
  LiveRecordingOptions options;
  options.service = *url;
  options.file = arguments.out;
  options.site = arguments.site;
  options.raw = !arguments.site && (arguments.raw || !arguments.fused);  // with neither: both
  options.fused = arguments.site || arguments.fused || !arguments.raw;
  asio::io_context io{1};
  const auto live = LiveRecording::start(io, options);
  if (!live) return pass(live);
  const End end = RecordingWatch(io, **live, arguments).run();
  const auto report = (*live)->stop();
  print_summary(summary_of(**live, report, arguments.out), arguments.json);
  return judge(**live, report, end, arguments);
}

}  // namespace

Run add_record(CLI::App& options) {
  const auto arguments = std::make_shared<RecordArguments>();
  add_server_option(options, arguments->url, "A sensor or a fusion server", "url,--url");
  options.add_option("--out", arguments->out, "The .mcap file to write; never one that exists")
      ->required();
  constexpr double kLongest = 7 * 24 * 3600.0;
  options.add_option("--seconds", arguments->seconds, "How long; without it until Ctrl-C")
      ->check(number_range(1.0, kLongest));
  options.add_flag("--raw", arguments->raw, "Only what the sensors say");
  options.add_flag("--fused", arguments->fused, "Only what the fusion server makes of it");
  options
      .add_flag("--site", arguments->site,
                "Everybody in the hall, as /site/frame of a cell has them (docs/guide/hall.md)")
      ->excludes("--raw");
  options.add_flag("--json", arguments->json, "Summary as JSON");
  return [arguments] { return run_record(*arguments); };
}

}  // namespace chorus::ctl
