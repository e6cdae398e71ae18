#include "fusion-server/server/fusion_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/client/orientations.h"
#include "common/resource/link_lines.h"
#include "common/service/common_resources.h"
#include "common/service/http_config.h"
#include "common/service/recording_views.h"
#include "fusion-server/foxglove/viewer_dialogue.h"
#include "fusion-server/outputs/output_bank.h"
#include "fusion-server/rest/evaluation_relay.h"
#include "fusion-server/rest/frame_sink.h"
#include "fusion-server/rest/inertial_resources.h"
#include "fusion-server/rest/metrics.h"
#include "fusion-server/rest/output_resources.h"
#include "fusion-server/rest/prop_resources.h"
#include "fusion-server/rest/sensor_resources.h"
#include "fusion-server/rest/site_resources.h"
#include "fusion-server/rest/tracker_description.h"
#include "fusion-server/server/cell_frame_desk.h"
#include "fusion-server/server/fusion_concerns.h"
#include "fusion-server/server/fusion_start.h"
#include "fusion-server/server/health.h"
#include "fusion-server/server/initial_registration.h"
#include "fusion-server/server/lookout.h"
#include "fusion-server/server/picture_desk.h"
#include "fusion-server/server/recording_tap.h"
#include "fusion-server/server/sensor_desk.h"
#include "fusion-server/server/site_member.h"
#include "fusion-server/server/start_report.h"
#include "fusion-server/server/state_folder.h"

namespace chorus::server {

struct FusionServer::Impl {
  Impl(FusionSettings c, std::shared_ptr<const Clock> k)
      : config(std::move(c)), clock(std::move(k)) {
    serving.run = fmt::format("{:x}", to_unix_ns(clock->now()) / 1'000'000);
    const StartSettings& at_start = config.at_start;
    serving.root = service::root_of(at_start.http, at_start.secure, at_start.http.port);
  }

  std::shared_ptr<http::Router> make_router();
  void make_resources();
  void add_site_routes(http::Router& router);
  void add_common_routes(http::Router& router, const service::Self& self);
  LoopOptions loop_options(InitialRegistration initial);
  void follow();
  [[nodiscard]] FusionSettings in_force() const;
  void sensors_changed();
  void follow_inertial(const std::vector<client::FollowedService>& sources);
  void take_status(const Status& next);
  void meet_the_site(const std::string& folder);
  [[nodiscard]] std::vector<OutputStatus> output_states() const {
    return with_site(outputs->states(), member ? &member->link() : nullptr);
  }
  LookoutOptions lookout_options();
  SensorDeskOptions sensor_desk_options(const std::string& folder);
  [[nodiscard]] std::optional<client::FollowedService> followed(const std::string& id) const;
  /// Reads what the mutex guards, whenever it is called.
  template <class Read>
  [[nodiscard]] auto guarded(Read read) const {
    return [this, read] {
      const std::scoped_lock lock(mutex);
      return read();
    };
  }
  [[nodiscard]] Status status_now() const {
    return guarded([this] { return status; })();
  }

  FusionSettings config;  ///< Its live part is guarded by mutex.
  std::shared_ptr<const Clock> clock;
  service::Serving serving;
  std::shared_ptr<workplace::PropBoard> board =
      std::make_shared<workplace::PropBoard>(config.at_start.props);
  std::optional<outputs::OutputBank> outputs;  ///< Set before the first request.
  std::mutex changing;                         ///< Held before `mutex`.
  mutable std::mutex mutex;
  Status status;  ///< Guarded by mutex.
  std::shared_ptr<const service::Configuration> configuration =
      std::make_shared<service::Configuration>();  ///< Guarded by mutex.
  std::atomic<std::chrono::steady_clock::time_point> status_at{};
  StateClaim state_claim;
  RegistrationStore store{""};
  std::string store_trouble;
  std::optional<service::FrameResources> frames;
  std::optional<rest::FrameSink> frame_sink;
  std::optional<rest::SensorResources> sensors;
  std::optional<rest::InertialResources> inertial;
  std::optional<rest::PropResources> props;
  std::optional<rest::EvaluationRelay> evaluation;  ///< Where one judges this tracker.
  std::optional<rest::RegistrationResources> registration;
  std::optional<rest::SiteResources> site;  ///< Only in a site.
  std::optional<service::Recordings> recordings;
  std::optional<service::RecordingViews> views;
  std::optional<RecordingTap> tap;
  std::optional<Lookout> lookout;
  std::optional<SensorDesk> desk_of_sensors;
  std::optional<PictureDesk> pictures;
  foxglove::Desk desk;
  std::unique_ptr<http::Server> http;
  std::optional<CellFrameDesk> cell_frames;  ///< Only in a site.
  std::unique_ptr<SiteMember> member;        ///< Null: there is no site.
  std::unique_ptr<PipelineLoop> loop;
  std::unique_ptr<client::Followers> followers;
};

/// Other cells are met last and left first: nothing here waits for them.
void FusionServer::Impl::meet_the_site(const std::string& folder) {
  SiteMemberOptions options{config.at_start.site, store_trouble.empty() ? folder : "", clock, {}};
  if (options.settings.link.site.empty()) return;
  options.on_view = [this, feed = options.settings.outputs_show](auto view) {
    if (feed && view->shown) outputs->publish(view->shown);
    site->show(std::move(view));
  };
  member = std::make_unique<SiteMember>(std::move(options), config.live.site_places);
}

LookoutOptions FusionServer::Impl::lookout_options() {
  LookoutOptions options;
  options.serving = serving;
  options.clock = clock;
  options.remember = config.live.pipeline.association.remember;
  options.recording = config.at_start.recording;
  options.forget = [this](PersonId person) { loop->ask(ForgetPerson{person}); };
  options.outputs = [this] { return output_states(); };
  options.newest_recording = [this] { return recordings->newest(); };
  return options;
}

SensorDeskOptions FusionServer::Impl::sensor_desk_options(const std::string& folder) {
  SensorDeskOptions options;
  options.folder = store_trouble.empty() ? folder : "";
  options.trust = guarded([this] { return config.live.trust; });
  options.configured = guarded([this] { return config.live.sensors; });
  options.changed = [this] { sensors_changed(); };
  options.run = serving.run;
  return options;
}

std::optional<client::FollowedService> FusionServer::Impl::followed(const std::string& id) const {
  for (client::FollowedService& service : in_force().live.sensors)
    if (service.id.str() == id) return std::move(service);
  return std::nullopt;
}

/// What answers requests, without its routes.
void FusionServer::Impl::make_resources() {
  rest::RegistrationControl control =
      registration_control([this](Command command) { loop->ask(std::move(command)); });
  control.defaults = guarded([this] {
    const core::SessionConfig& session = config.live.session;
    return rest::SessionRequest{session.target, session.adoption};
  });
  frames.emplace(serving, service::DocumentHistory{config.at_start.history});
  frame_sink.emplace(*frames);
  frames->predict_with([this] { return frame_sink->predicted(clock->now()); });
  sensors.emplace(serving, ids_of(in_force().live.sensors));
  pictures.emplace(serving.run, [this](const std::string& id) { return followed(id); });
  inertial.emplace(serving, ids_of(config.live.inertial));
  props.emplace(serving, board);
  registration.emplace(serving, std::move(control));
  recordings.emplace(recordings_options(config.at_start, serving, clock));
  tap.emplace(*recordings, clock);
  lookout.emplace(lookout_options());
  views.emplace(views_options(*recordings, config.at_start.recording, serving.run));
}

/// Of a hall, when the cell is part of one.
void FusionServer::Impl::add_site_routes(http::Router& router) {
  if (config.at_start.site.link.site.empty()) return;
  site.emplace(serving).add_routes(router);
  auto ask = [this](const auto& cell, const auto& at) {
    return member->link().ask_frame(cell, at);
  };
  auto lists = [this](const std::string& cell) { return site->lists(cell); };
  cell_frames.emplace(serving.run, std::move(ask), std::move(lists)).add_routes(router);
}

/// What every service answers: its clock, health, metrics and description.
void FusionServer::Impl::add_common_routes(http::Router& router, const service::Self& self) {
  service::CommonResources common;
  common.clock = clock;
  common.health = [this] { return with_outputs(health_of(status_now()), output_states()); };
  common.metrics = [this] {
    return rest::metrics_text(status_now(), output_states(), http->counters()) +
           recordings->metrics_text();
  };
  common.self = [self] { return self; };
  common.configuration = guarded([this] { return configuration; });
  service::add_routes(router, common);
}

std::shared_ptr<http::Router> FusionServer::Impl::make_router() {
  auto router = std::make_shared<http::Router>();
  make_resources();
  lookout->add_routes(*router);
  foxglove::add_route(*router, desk, config.at_start.title, serving.run);
  recordings->add_routes(*router);
  views->add_routes(*router);
  frames->add_routes(*router);
  sensors->add_routes(*router);
  pictures->add_routes(*router);
  rest::add_setup_routes(*router, serving, desk_of_sensors->control());
  inertial->add_routes(*router);
  props->add_routes(*router);
  if (!config.at_start.evaluation.empty()) evaluation.emplace(serving.run, *router);
  add_site_routes(*router);
  registration->add_routes(*router);
  const auto self = rest::self_of(config.at_start.title, !config.at_start.viewer_dir.empty(),
                                  evaluation.has_value());
  rest::add_description_routes(*router, serving, self, viewer_folder(config.at_start.viewer_dir));
  rest::add_output_routes(*router, serving, [this] { return output_states(); });
  add_common_routes(*router, self);
  return router;
}

void FusionServer::Impl::take_status(const Status& next) {
  if (member) member->follow(next.registration);
  status_at = std::chrono::steady_clock::now();
  sensors->publish(next.sensors);
  if (followers)
    inertial->publish(followers->reports(client::kOrientations), next.worn, clock->now());
  registration->publish(next.registration, next.progress);
  tap->places(next.registration);
  lookout->look(next);
  desk.places(next.registration, clock->now());
  const std::scoped_lock lock(mutex);
  status = next;
}

LoopOptions FusionServer::Impl::loop_options(InitialRegistration initial) {
  LoopOptions options;
  options.core = core_config(in_force());
  count_on(options.core, clock->now(), store);
  options.registration = std::move(initial.registration);
  options.store_damage = std::move(initial.damage);
  options.store = store;
  options.store_trouble = store_trouble;
  options.clock = clock;
  options.sinks.push_back(&*frame_sink);
  options.sinks.push_back(&*props);
  options.sinks.push_back(&*tap);
  if (member) options.sinks.push_back(&member->link());
  if (!member || !config.at_start.site.outputs_show) options.sinks.push_back(&*outputs);
  options.sinks.push_back(lookout->people());
  options.sinks.push_back(&desk);
  options.on_status = [this](const Status& next) { take_status(next); };
  options.complete = [this](Snapshot& snapshot) { props->held().put(snapshot); };
  options.on_amended = [this](auto& each) { frame_sink->amend(props->held().again(each)); };
  options.poll_reports = [this] {
    return followers ? followers->reports() : std::vector<client::FollowReport>{};
  };
  return options;
}

/// The settings, in which the sensors are those that are followed: what operators changed counts.
FusionSettings FusionServer::Impl::in_force() const {
  FusionSettings settings = guarded([this] { return config; })();
  settings.live.sensors = desk_of_sensors->followed(settings.live.sensors);
  return settings;
}

/// Runs where sensors are changed on the page and where the configuration is read again: whoever is
/// last must leave what both made of it.
void FusionServer::Impl::sensors_changed() {
  const std::scoped_lock one_at_a_time(changing);
  loop->ask(core_config(in_force()));
  follow();
}

void FusionServer::Impl::follow() {
  const LiveSettings live = in_force().live;
  follow_inertial(live.inertial);
  if (evaluation) evaluation->follow(*followers, config.at_start.evaluation);
  followers->follow<resource::FrameResource>(client::kFrames, live.sensors, [this](auto arrived) {
    SensorFrame frame = client::place_in_time(arrived);
    tap->raw(raw_frame(arrived, frame));
    sensors->floor(frame.sensor, frame.floor);
    desk.raw(frame.sensor, arrived.document, frame.received);
    sensors->relay(frame.sensor, std::move(arrived.document));
    loop->give(std::move(frame));
  });
}

void FusionServer::Impl::follow_inertial(const std::vector<client::FollowedService>& sources) {
  followers->follow<resource::OrientationsResource>(
      client::kOrientations, sources, [this](auto arrived) {
        tap->raw(record::RawOrientations{arrived.source, arrived.document, arrived.received,
                                         clock_model(arrived.clock)});
        for (auto& instant : client::place_in_time(arrived)) loop->give(std::move(instant));
        inertial->relay(arrived.source, std::move(arrived.document));
      });
}

Result<std::unique_ptr<FusionServer>> FusionServer::make(const FusionSettings& settings) {
  return std::make_unique<FusionServer>(settings, std::make_shared<SystemClock>());
}

FusionServer::FusionServer(FusionSettings settings, std::shared_ptr<const Clock> clock)
    : impl_(std::make_unique<Impl>(std::move(settings), std::move(clock))) {}

FusionServer::~FusionServer() { stop(); }

service::Concerns FusionServer::concerns() const {
  service::Concerns all = host_concerns(impl_->config);
  std::ranges::move(setting_concerns(impl_->config), std::back_inserter(all));
  return all;
}

Result<void> FusionServer::start() {
  Impl& s = *impl_;
  const std::string folder =
      state_folder(s.config.at_start.state_dir, s.config.at_start.http.port, own_environment());
  service::log_concerns(s.config.at_start.http, {});
  s.store = RegistrationStore(folder);
  s.store_trouble = probe_folders(s.config.at_start, folder);
  auto claim = StateClaim::take(folder);
  if (!claim) return pass(claim);
  s.state_claim = std::move(*claim);
  for (const std::string& concern : setting_concerns(s.config))
    log::warn("the configuration may not be what is meant", {{"what", concern}});
  s.desk_of_sensors.emplace(s.sensor_desk_options(folder));
  auto initial = initial_registration(s.in_force(), s.store);
  if (!initial) return pass(initial);
  s.outputs.emplace(outputs::OutputsContext{s.clock, s.board});
  if (auto opened = s.outputs->apply(s.config.live.outputs); !opened) return opened;
  http::ServerConfig http = s.config.at_start.http;
  http.tokens = s.config.live.tokens;
  http.identity = s.config.live.identity;
  http.clock = s.clock;
  http.policy = resource::answer_policy();
  s.http = std::make_unique<http::Server>(http, s.make_router());
  s.meet_the_site(folder);
  s.loop = std::make_unique<PipelineLoop>(s.loop_options(std::move(*initial)));
  s.followers = std::make_unique<client::Followers>(
      client::FollowOptions{.timings = s.config.at_start.poll, .clock = s.clock});
  if (auto bound = s.http->start(); !bound) return bound;
  s.follow();
  s.status_at = std::chrono::steady_clock::now();
  s.loop->start();
  report_start(s.in_force(), s.http->port());
  return {};
}

std::uint16_t FusionServer::port() const { return impl_->http ? impl_->http->port() : 0; }

void FusionServer::take(const LiveSettings& live) {
  Impl& s = *impl_;
  {
    const std::scoped_lock lock(s.mutex);
    s.config.live = live;
  }
  if (s.member) s.member->places(live.site_places);
  if (const auto opened = s.outputs->apply(live.outputs); !opened)
    log::error("an output could not be opened", {{"reason", to_string(opened.error())}});
  s.lookout->remember_for(live.pipeline.association.remember);
  s.sensors_changed();
  s.http->set_tokens(live.tokens);
  if (live.identity) s.http->set_identity(*live.identity);
}

bool FusionServer::alive() {
  constexpr auto kStill = std::chrono::seconds(5);  // The status comes several times a second.
  const auto since = std::chrono::steady_clock::now() - impl_->status_at.load();
  return impl_->http->alive() && since < kStill;
}

void FusionServer::stop() {
  Impl& s = *impl_;
  // Requests end first, then frames, then the pipeline.
  if (s.http) s.http->stop();
  if (s.followers) s.followers->stop();
  s.loop.reset();
  s.cell_frames.reset();
  s.member.reset();
  s.outputs.reset();
}

void FusionServer::tell_of(std::shared_ptr<const service::Configuration> configuration) {
  const std::scoped_lock lock(impl_->mutex);
  impl_->configuration = std::move(configuration);
}

}  // namespace chorus::server
