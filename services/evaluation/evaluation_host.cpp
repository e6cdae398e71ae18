#include "services/evaluation/evaluation_host.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/base/file.h"
#include "common/base/log.h"
#include "common/resource/inertial_calibration_resource.h"
#include "common/resource/link_lines.h"
#include "common/service/http_config.h"

namespace chorus::evaluation_service {
namespace {

constexpr std::uintmax_t kMostCalibrationBytes = 1'000'000;

service::Serving serving_of(const StartSettings& at_start) {
  service::Serving serving;
  serving.run = fmt::format("{:x}", to_unix_ns(SystemClock().now()) / 1'000'000);
  serving.root = service::root_of(at_start.http, at_start.secure, at_start.http.port);
  return serving;
}

http::ServerConfig server_config(const EvaluationSettings& settings) {
  http::ServerConfig config = settings.at_start.http;
  config.tokens = settings.live.tokens;
  config.identity = settings.live.identity;
  config.policy = resource::answer_policy();
  return config;
}

client::FollowOptions follow_options(const StartSettings& at_start) {
  client::FollowOptions options;
  options.timings = at_start.poll;
  return options;
}

Result<inertial::InertialCalibration> read_calibration(const EvaluationSettings& settings) {
  const std::string& file = settings.at_start.calibration;
  const auto text = read_file(file, kMostCalibrationBytes);
  if (!text) return pass(text);
  auto read = resource::read_inertial_calibration(*text, resource::Format::Json);
  if (!read) return fail(read.error().code, file, read.error().message);
  const bool followed = std::ranges::any_of(
      settings.live.inertial, [&](const auto& each) { return each.id.str() == read->source; });
  if (followed) return read;
  return fail(ErrorCode::InvalidArgument, file,
              "calibrates the source \"" + read->source +
                  "\", which is none of the section \"inertial\"; give one this id");
}

}  // namespace

Result<JudgeOptions> judge_options(const EvaluationSettings& settings) {
  JudgeOptions options;
  options.watch.detection.on = settings.at_start.tau;
  options.watch.own_tau = settings.at_start.own_tau;
  options.stated = settings.at_start.stated;
  options.limbs = settings.at_start.limbs;
  if (settings.at_start.calibration.empty()) return options;
  auto calibration = read_calibration(settings);
  if (!calibration) return pass(calibration);
  options.calibrations.push_back(std::move(*calibration));
  return options;
}

Result<std::unique_ptr<EvaluationHost>> EvaluationHost::make(const EvaluationSettings& settings) {
  auto options = judge_options(settings);
  if (!options) return pass(options);
  return std::make_unique<EvaluationHost>(settings, std::move(*options));
}

EvaluationHost::EvaluationHost(EvaluationSettings settings, JudgeOptions options)
    : settings_(std::move(settings)),
      service_(std::move(options), serving_of(settings_.at_start), settings_.at_start.title),
      followers_(follow_options(settings_.at_start)),
      server_(server_config(settings_), routes()) {}

EvaluationHost::~EvaluationHost() { stop(); }

void EvaluationHost::tell_of(std::shared_ptr<const service::Configuration> configuration) {
  configuration_ = std::move(configuration);
}

std::shared_ptr<http::Router> EvaluationHost::routes() {
  auto router = std::make_shared<http::Router>();
  service_.add_routes(*router);
  service::CommonResources common;
  common.health = [this] { return health(); };
  common.metrics = [this] { return metrics(); };
  common.self = [this] { return service_.description(); };
  common.configuration = [this] { return configuration_; };
  service::add_routes(*router, common);
  return router;
}

void EvaluationHost::follow(const LiveSettings& live) {
  service_.judges(live.trackers.front().url);
  followers_.follow<resource::FrameResource>(client::kFrames, live.trackers, [this](Frame frame) {
    inbox_.give(Heard(std::move(frame)));
  });
  followers_.follow<resource::OrientationsResource>(
      client::kOrientations, live.inertial,
      [this](Orientations orientations) { inbox_.give(Heard(std::move(orientations))); });
}

Result<void> EvaluationHost::start() {
  if (auto bound = server_.start(); !bound) return bound;
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  follow(settings_.live);
  log::info("evaluation serving",
            {{"url", service::root_of(settings_.at_start.http, settings_.at_start.secure, port())},
             {"tracker", settings_.live.trackers.front().url},
             {"sources", settings_.live.inertial.size()}});
  return {};
}

void EvaluationHost::run(const std::stop_token& stop) {
  constexpr auto kWait = std::chrono::milliseconds(200);
  while (!stop.stop_requested()) service_.take(inbox_.take(kWait));
}

service::Health EvaluationHost::health() const {
  for (const client::FollowReport& tracker : followers_.reports(client::kFrames)) {
    if (tracker.state != client::SensorState::Live)
      return {false, "the tracker delivers no frames: " + tracker.last_error};
  }
  const auto sources = followers_.reports(client::kOrientations);
  if (sources.empty())
    return {false, "no inertial source is followed; name one in the section \"inertial\""};
  std::string silent;
  for (const client::FollowReport& source : sources) {
    if (source.state == client::SensorState::Live) return {};
    silent = source.service.id.str() + ": " + source.last_error;
  }
  return {false, "none of the inertial sources says anything; " + silent};
}

std::string EvaluationHost::metrics() const {
  service::MetricsText text;
  service_.add_metrics(text);
  text.counter({"chorus_evaluation_dropped_total", "Documents that judging was too slow for."},
               static_cast<double>(inbox_.dropped()));
  service::add_server(text, server_.counters());
  return text.text();
}

service::Concerns EvaluationHost::concerns() const {
  return service::common_concerns(settings_.at_start.http, {});
}

void EvaluationHost::take(const LiveSettings& live) {
  settings_.live = live;
  follow(live);
  server_.set_tokens(live.tokens);
  if (live.identity) server_.set_identity(*live.identity);
}

void EvaluationHost::stop() {
  followers_.stop();
  thread_.request_stop();
  inbox_.close();
  if (thread_.joinable()) thread_.join();
  server_.stop();
}

service::About about_evaluation() {
  return {"chorus-evaluation",
          "chorus-evaluation: judges a tracker by what sensors on a person's limbs say.\n"
          "Judges http://127.0.0.1:8080/ unless told otherwise, on http://127.0.0.1:8092/.",
          "  chorus-evaluation --config deploy/config/evaluation.json\n"
          "  chorus-evaluation --tracker http://tracker.local:8080/ \\\n"
          "      --set 'inertial=[{\"id\": \"suit\", \"url\": \"http://127.0.0.1:8091/\"}]'\n"
          "  curl http://127.0.0.1:8092/evaluation\n",
          {{"--tracker", "tracker.url", "The tracker that is judged (tracker.url)"},
           {"--calibration", "calibration",
            "A file that GET /calibrations/{source} gave in another take (calibration)"}},
          "/etc/chorus/evaluation.json the configuration that the service of the package reads\n"
          "/usr/share/doc/chorus-evaluation/examples/evaluation.json every key with its default\n"};
}

}  // namespace chorus::evaluation_service
