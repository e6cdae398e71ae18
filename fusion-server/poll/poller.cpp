#include "fusion-server/poll/poller.h"

#include <algorithm>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <random>
#include <thread>
#include <utility>

#include "common/base/log.h"
#include "common/http/asio.h"
#include "common/http/event_loop.h"
#include "fusion-server/poll/answer.h"

namespace chorus::poll {
namespace {

constexpr Duration kRateWindow = std::chrono::seconds(2);
constexpr Duration kRateStale = std::chrono::seconds(1);

Duration steady_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

std::chrono::milliseconds at_least_1ms(Duration d) {
  return std::max(std::chrono::milliseconds(1), std::chrono::ceil<std::chrono::milliseconds>(d));
}

http::ClientLimits limits_of(const PollerOptions& options) {
  http::ClientLimits limits;
  limits.max_body_bytes = options.max_body_bytes;
  return limits;
}

/// One sensor's connection and state machine.  Lives on the poll thread; only the report is shared.
class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(http::net::io_context& io, PolledSensor sensor, http::Url url,
          const PollerOptions& options)
      : options_(options),
        sensor_(std::move(sensor)),
        url_(std::move(url)),
        client_(io, url_.host, url_.port, limits_of(options)),
        timer_(io),
        fsm_(options.timings),
        random_(std::random_device{}()) {
    if (url_.target.empty() || url_.target.back() != '/') url_.target += '/';
    report_.sensor = sensor_;
  }

  void start() {
    survive([this] { feed(Started{}); });
  }

  void stop() {
    stopped_ = true;
    client_.close();
    timer_.cancel();
  }

  [[nodiscard]] PollReport report(Timestamp now) const {
    const std::scoped_lock lock(mutex_);
    PollReport copy = report_;
    if (!copy.newest || now - *copy.newest > kRateStale) copy.rate_hz = 0.0;
    return copy;
  }

 private:
  /// Whatever is thrown on the way (no memory, a frame nobody thought of) is a failed poll of this
  /// sensor: it is asked again after its back-off, and the others do not notice.
  template <class Doing>
  void survive(const Doing& doing) {
    try {
      doing();
    } catch (const std::exception& thrown) {
      answered_.reset();
      feed(Failed{{ErrorCode::Internal, sensor_.url, thrown.what()}});
    }
  }

  void feed(const Event& event) {
    const double jitter = std::uniform_real_distribution<double>(0.0, 1.0)(random_);
    const Step step = fsm_.resume(event, steady_now(), jitter);
    if (auto frame = std::exchange(answered_, nullptr); frame && step.deliver) deliver(frame);
    if (step.notice) tell(*step.notice);
    publish_state();
    std::visit([this](const auto& action) { act(action); }, step.action);
  }

  void act(const Send& send) {
    http::ClientRequest request;
    const bool frame = send.resource == Resource::Frame;
    request.target = url_.target + (frame ? "frame" : "floor-plane");
    request.headers.emplace_back("Accept", "text/turtle");
    if (!send.etag.empty()) request.headers.emplace_back("If-None-Match", send.etag);
    if (send.wait > Duration{0}) {
      const auto wait = std::chrono::ceil<std::chrono::seconds>(send.wait);
      request.headers.emplace_back("Prefer", "wait=" + std::to_string(wait.count()));
    }
    client_.send(std::move(request), at_least_1ms(send.deadline),
                 [weak = weak_from_this(), frame](Result<http::ClientResponse> response) {
                   const auto self = weak.lock();
                   if (!self || self->stopped_) return;
                   self->survive([&] { self->take(std::move(response), frame); });
                 });
  }

  void act(const Sleep& sleep) {
    timer_.expires_after(sleep.duration);
    timer_.async_wait([weak = weak_from_this()](const http::error_code& error) {
      const auto self = weak.lock();
      if (!self || error || self->stopped_) return;
      self->survive([&] { self->feed(Woke{}); });
    });
  }

  void take(Result<http::ClientResponse> response, bool frame) {
    if (!response) return feed(Failed{response.error()});
    if (const auto exchange = exchange_of(*response)) clock_.add(*exchange);
    received_ = from_unix_ns(response->received_ns);
    if (!frame) {
      floor_ = read_floor_answer(*response);
      return feed(FloorAnswered{});
    }
    FrameAnswer answer = read_frame_answer(*response, sensor_.id);
    answered_ = std::move(answer.frame);
    feed(answer.event);
  }

  void deliver(const std::shared_ptr<const resource::FrameResource>& frame) {
    const auto clock = clock_.at(received_);
    SensorFrame placed = place_in_time(*frame, sensor_.id, received_, correction(clock), floor_);
    note(placed);
    options_.deliver({std::move(placed), frame, clock});
  }

  void note(const SensorFrame& frame) {
    if (!recent_.empty() && frame.captured <= recent_.back()) recent_.clear();
    recent_.push_back(frame.captured);
    while (recent_.back() - recent_.front() > kRateWindow) recent_.pop_front();
    const double span = seconds(recent_.back() - recent_.front());
    const std::scoped_lock lock(mutex_);
    report_.rate_hz = span > 0.0 ? static_cast<double>(recent_.size() - 1) / span : 0.0;
    report_.newest = frame.captured;
    ++report_.frames;
    if (last_sequence_ && frame.sequence > *last_sequence_ + 1) {
      report_.missed += frame.sequence - *last_sequence_ - 1;
    }
    last_sequence_ = frame.sequence;
  }

  void publish_state() {
    const std::scoped_lock lock(mutex_);
    report_.state = fsm_.state();
    report_.last_error = fsm_.last_error();
    report_.failures = fsm_.failures();
    report_.clock = clock_.at(received_);
  }

  void tell(const Notice& notice) const {
    if (notice.reason.empty()) {
      log::info(notice.event, {{"sensor", sensor_.id.str()}, {"url", sensor_.url}});
      return;
    }
    log::event(notice.warning ? log::Level::Warn : log::Level::Info, notice.event,
               {{"sensor", sensor_.id.str()}, {"url", sensor_.url}, {"reason", notice.reason}});
  }

  const PollerOptions& options_;
  PolledSensor sensor_;
  http::Url url_;
  http::AsyncClient client_;
  http::Timer timer_;
  PollFsm fsm_;
  ClockFilter clock_;
  std::minstd_rand random_;
  bool stopped_ = false;
  Timestamp received_{};
  std::optional<FloorPlane> floor_;
  std::shared_ptr<const resource::FrameResource> answered_;
  std::optional<std::uint64_t> last_sequence_;
  std::deque<Timestamp> recent_;
  mutable std::mutex mutex_;
  PollReport report_;  ///< Guarded by mutex_.
};

}  // namespace

struct Poller::Impl {
  explicit Impl(PollerOptions o) : options(std::move(o)), work(http::net::make_work_guard(io)) {
    thread = std::thread([this] { http::run_events(io, "poll handler failed"); });
  }

  ~Impl() { stop(); }

  void stop() {
    if (!thread.joinable()) return;
    {
      const std::scoped_lock lock(mutex);
      for (auto& [id, session] : sessions) {
        http::net::post(io, [session = session] { session->stop(); });
      }
    }
    http::net::post(io, [this] { io.stop(); });  // after the sessions' own stops
    thread.join();
  }

  void add(PolledSensor sensor) {
    auto url = http::parse_url(sensor.url);
    if (!url) {  // the config reader has checked it
      log::error("sensor not polled",
                 {{"sensor", sensor.id.str()}, {"reason", url.error().message}});
      return;
    }
    const SensorId id = sensor.id;
    auto session = std::make_shared<Session>(io, std::move(sensor), std::move(*url), options);
    http::net::post(io, [session] { session->start(); });
    sessions.emplace(id, std::move(session));
  }

  const PollerOptions options;
  http::net::io_context io{1};
  http::net::executor_work_guard<http::Executor> work;
  mutable std::mutex mutex;
  std::map<SensorId, std::shared_ptr<Session>> sessions;
  std::thread thread;
};

Poller::Poller(PollerOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Poller::~Poller() = default;
void Poller::stop() { impl_->stop(); }

void Poller::poll(std::vector<PolledSensor> sensors) {
  const std::scoped_lock lock(impl_->mutex);
  for (auto it = impl_->sessions.begin(); it != impl_->sessions.end();) {
    const PolledSensor current = it->second->report({}).sensor;
    if (std::find(sensors.begin(), sensors.end(), current) != sensors.end()) {
      ++it;
      continue;
    }
    http::net::post(impl_->io, [session = it->second] { session->stop(); });
    it = impl_->sessions.erase(it);
  }
  for (PolledSensor& sensor : sensors) {
    if (!impl_->sessions.contains(sensor.id)) impl_->add(std::move(sensor));
  }
}

std::vector<PollReport> Poller::reports() const {
  const Timestamp now = impl_->options.clock->now();
  const std::scoped_lock lock(impl_->mutex);
  std::vector<PollReport> all;
  all.reserve(impl_->sessions.size());
  for (const auto& [id, session] : impl_->sessions) all.push_back(session->report(now));
  return all;
}

}  // namespace chorus::poll
