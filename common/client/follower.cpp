#include "common/client/follower.h"

#include <time.h>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "common/base/log.h"
#include "common/base/shortened.h"
#include "common/http/status.h"

namespace chorus::client {
namespace {

constexpr std::size_t kMaxHeld = 10;
constexpr std::string_view kAcceptClock = "application/json";

Duration steady_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

/// CPU time of this thread, because the sensor is not to blame for a busy processor.
Duration cpu_now() {
  timespec spent{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &spent);
  return std::chrono::seconds(spent.tv_sec) + std::chrono::nanoseconds(spent.tv_nsec);
}

std::chrono::milliseconds at_least_1ms(Duration d) {
  return std::max(std::chrono::milliseconds(1), std::chrono::ceil<std::chrono::milliseconds>(d));
}

http::ClientLimits limits_of(const FollowOptions& options) {
  http::ClientLimits limits;
  limits.max_body_bytes = options.max_body_bytes;
  limits.connect_timeout = std::chrono::seconds(1);
  limits.answer_timeout = at_least_1ms(options.timings.answer_slack);
  return limits;
}

std::vector<http::Header> authorization_of(const FollowedService& service) {
  if (service.token.empty()) return {};
  return {{"Authorization", "Bearer " + service.token}};
}

/// What is asked for: the format that is read fastest, but others rather than none.
std::string accept_of(const DocumentKind& kind, bool stream) {
  const bool json = kind.preferred == resource::Format::Json;
  const std::string first = json ? "application/json" : "text/turtle";
  const std::string other = json ? "text/turtle" : "application/json";
  if (stream) return "text/event-stream, " + first + ";q=0.9, " + other + ";q=0.8";
  return first + ", " + other + ";q=0.9";
}

}  // namespace

Follower::Follower(asio::io_context& io, FollowedService service, http::Url url,
                   Following following)
    : following_(std::move(following)),
      service_(std::move(service)),
      url_(std::move(url)),
      client_(io, url_, limits_of(following_.options), service_.trust),
      stream_(io, url_, limits_of(following_.options), service_.trust),
      timer_(io),
      fsm_(following_.options.timings,
           {following_.kind.path, following_.kind.floor, !following_.kind.kept.empty()}),
      random_(std::random_device{}()) {
  if (url_.target.empty() || url_.target.back() != '/') url_.target += '/';
  report_.service = service_;
}

void Follower::start() {
  survive([this] { feed(Started{}); });
}

void Follower::stop() {
  stopped_ = true;
  client_.close();
  stream_.close();
  timer_.cancel();
}

FollowReport Follower::report(Timestamp now) const {
  const std::scoped_lock lock(mutex_);
  FollowReport copy = report_;
  copy.rate_hz = tally_.rate_hz(now);
  copy.newest = tally_.newest();
  copy.frames = tally_.frames();
  copy.missed = tally_.missed();
  return copy;
}

/// Runs `doing`.  Any exception (out of memory, an unforeseen frame) counts as a failed poll of
/// this sensor: the sensor is asked again after its back-off, and other sensors are not affected.
template <class Doing>
void Follower::survive(const Doing& doing) {
  try {
    doing();
  } catch (const std::exception& thrown) {
    answered_.reset();
    feed(Failed{{ErrorCode::Internal, service_.url, thrown.what()}});
  }
}

void Follower::feed(const Event& event) {
  const double jitter = std::uniform_real_distribution<double>(0.0, 1.0)(random_);
  const Step step = fsm_.resume(event, steady_now(), jitter);
  if (step.stream == StreamOrder::Close) stream_.close();
  if (step.stream == StreamOrder::Open) open_stream();
  if (auto arrival = std::exchange(answered_, std::nullopt); arrival && step.deliver) {
    arrival->late |= step.late;
    deliver(std::move(*arrival));
  }
  if (!held_.empty() && !in_doubt()) hand_on_held();
  if (step.notice) tell(*step.notice);
  publish_state();
  if (step.action) std::visit([this](const auto& action) { act(action); }, *step.action);
}

std::string Follower::target_of(const Send& send) const {
  switch (send.resource) {
    case Resource::FloorPlane:
      return url_.target + "floor-plane";
    case Resource::KeptFrame:
      return url_.target + std::string(following_.kind.kept) + std::to_string(send.sequence);
    case Resource::Clock:
      return url_.target + "clock";
    case Resource::Frame:
      break;
  }
  return url_.target + std::string(following_.kind.path);
}

void Follower::act(const Send& send) {
  timer_.cancel();
  http::ClientRequest request;
  request.target = target_of(send);
  request.headers = authorization_of(service_);
  request.headers.emplace_back("Accept", send.resource == Resource::Clock
                                             ? std::string(kAcceptClock)
                                             : accept_of(following_.kind, false));
  if (!send.etag.empty()) request.headers.emplace_back("If-None-Match", send.etag);
  if (send.wait > Duration{0}) {
    const auto wait = std::chrono::ceil<std::chrono::seconds>(send.wait);
    request.headers.emplace_back("Prefer", "wait=" + std::to_string(wait.count()));
  }
  client_.send(std::move(request), at_least_1ms(send.deadline),
               [weak = weak_from_this(), send](Result<http::ClientResponse> response) {
                 const auto self = weak.lock();
                 if (!self || self->stopped_) return;
                 self->survive([&] { self->take(std::move(response), send); });
               });
}

void Follower::act(const Sleep& sleep) {
  timer_.expires_after(sleep.duration);
  timer_.async_wait([weak = weak_from_this()](const net::error_code& error) {
    const auto self = weak.lock();
    if (!self || error || self->stopped_) return;
    // Ignored if the timer was set again, or replaced by a request, just when it expired.
    if (self->timer_.expiry() > std::chrono::steady_clock::now() || self->fsm_.asking()) return;
    self->survive([&] { self->feed(Woke{}); });
  });
}

void Follower::open_stream() {
  http::ClientRequest request;
  request.target = target_of({});
  request.headers = authorization_of(service_);
  request.headers.emplace_back("Accept", accept_of(following_.kind, true));
  const auto weak = weak_from_this();
  const auto guarded = [weak](const auto& doing) {
    const auto self = weak.lock();
    if (self && !self->stopped_) self->survive([&] { doing(*self); });
  };
  http::AsyncEventStream::Handlers handlers;
  handlers.on_head = [guarded](const http::ClientResponse& head) {
    guarded([&](Follower& self) { self.take_clock(head); });
  };
  handlers.on_events = [guarded](const std::vector<http::ServerEvent>& events) {
    guarded([&](Follower& self) { self.take_events(events); });
  };
  handlers.on_end = [guarded](const Error& error) {
    guarded([&](Follower& self) { self.feed(StreamEnded{error}); });
  };
  rested_ = false;
  stream_.open(request, std::move(handlers));
}

void Follower::take_clock(const http::ClientResponse& response) {
  if (const auto exchange = exchange_of(response)) clock_.add(*exchange);
  received_ = from_unix_ns(response.received_ns);
}

void Follower::take(Result<http::ClientResponse> response, const Send& asked) {
  if (!response) return feed(Failed{response.error()});
  take_clock(*response);
  switch (asked.resource) {
    case Resource::FloorPlane: {
      const auto floor = read_floor_answer(*response);
      floor_ = floor.value_or(std::nullopt);
      floor_error_ = floor ? "" : shortened(to_string(floor.error()), kMaxReason);
      return feed(FloorAnswered{response->status < http::status::kInternal});
    }
    case Resource::Clock: {
      const auto clock = clock_.at(received_);
      ClockAnswered answer;
      if (clock && exchange_of(*response)) answer.uncertainty = clock->uncertainty;
      answer.doubtful = clock_.doubtful();
      if (auto host = read_clock_answer(*response)) host_ = *host;
      return feed(answer);
    }
    case Resource::Frame:
    case Resource::KeptFrame:
      return take_document(*response, asked.resource);
  }
}

void Follower::take_document(const http::ClientResponse& response, Resource asked) {
  const Duration before = cpu_now();
  Answer answer = read_answer(response, following_.kind, service_.id);
  const Duration rest = budget_.spend(cpu_now() - before, steady_now());
  const bool kept = asked == Resource::KeptFrame;
  if (answer.document.value) answered_ = Arrival{std::move(answer.document), received_, kept};
  if (kept) return feed(KeptAnswered{answered_.has_value(), rest});
  if (answered_) {
    const Dated here = dated(*answered_);
    if (auto error = untimely_now(here)) {
      answer.event = Unreadable{std::move(*error)};
      note_untimely(here);
    }
  }
  if (auto* good = std::get_if<FrameAnswered>(&answer.event)) good->rest = rest;
  if (auto* bad = std::get_if<Unreadable>(&answer.event)) bad->rest = rest;
  feed(answer.event);
}

/// After a rest only the newest event is read; skipping the others is the purpose of the rest.
void Follower::take_events(const std::vector<http::ServerEvent>& events) {
  received_ = from_unix_ns(to_unix_ns(SystemClock().now()));
  const Duration before = cpu_now();
  const std::size_t first = std::exchange(rested_, false) ? events.size() - 1 : 0;
  for (std::size_t i = first; i < events.size() && !stopped_; ++i) take_event(events[i].data);
  const Duration rest = budget_.spend(cpu_now() - before, steady_now());
  if (rest == Duration{0}) return;
  rested_ = true;
  stream_.pause(at_least_1ms(rest));
}

void Follower::take_event(std::string_view text) {
  auto document = read_event(text, following_.kind, service_.id);
  if (!document) {
    stream_.close();
    return feed(StreamEnded{{ErrorCode::Unsupported, "event stream", to_string(document.error())}});
  }
  answered_ = Arrival{std::move(*document), received_, false};
  const Dated here = dated(*answered_);
  const bool odd = ages_.odd(here) && clock_.at(received_);
  if (const auto error = untimely_now(here); error && !odd) {
    answered_.reset();
    stream_.close();  // polling will find out what is wrong
    return feed(StreamEnded{{ErrorCode::Unsupported, "event stream", to_string(*error)}});
  }
  feed(StreamFrame{here.sequence, answered_->raw.captured, odd});
}

Dated Follower::dated(const Arrival& arrival) const {
  return {arrival.raw.sequence, arrival.raw.captured + correction(clock_.at(arrival.received)),
          arrival.received};
}

std::optional<Error> Follower::untimely_now(const Dated& document) const {
  if (clock_.doubtful()) return std::nullopt;  // decide once it is known which clock was set
  return untimely(document);
}

void Follower::note_untimely(const Dated& document) {
  ++(document.captured > document.received ? early_ : stale_);
}

void Follower::deliver(Arrival arrival) {
  if (!in_doubt()) return hand_on(arrival);
  held_.push_back(std::move(arrival));
  if (held_.size() > kMaxHeld) hand_on_held();
}

void Follower::hand_on_held() {
  for (const Arrival& arrival : std::exchange(held_, {})) {
    const Dated here = dated(arrival);
    untimely(here) ? note_untimely(here) : hand_on(arrival);
  }
}

void Follower::hand_on(const Arrival& arrival) {
  {
    const Dated here = dated(arrival);
    const std::scoped_lock lock(mutex_);
    arrival.late ? tally_.note_late(here) : tally_.note(here);
  }
  following_.deliver(
      {service_.id, arrival.raw.value, arrival.received, clock_.at(arrival.received), floor_});
}

void Follower::publish_state() {
  const std::scoped_lock lock(mutex_);
  report_.state = fsm_.state();
  report_.last_error = fsm_.last_error().empty() ? floor_error_ : fsm_.last_error();
  report_.failures = fsm_.failures();
  report_.early = early_;
  report_.stale = stale_;
  report_.streaming = fsm_.streaming();
  report_.clock = clock_.at(received_);
  report_.host = host_;
}

void Follower::tell(const Notice& notice) const {
  if (notice.reason.empty()) {
    log::info(notice.event, {{"sensor", service_.id.str()}, {"url", service_.url}});
    return;
  }
  log::event(notice.warning ? log::Level::Warn : log::Level::Info, notice.event,
             {{"sensor", service_.id.str()}, {"url", service_.url}, {"reason", notice.reason}});
}

}  // namespace chorus::client
