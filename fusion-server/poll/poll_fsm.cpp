#include "fusion-server/poll/poll_fsm.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace chorus::poll {
namespace {

constexpr Duration kNoticeInterval = std::chrono::seconds(1);
constexpr int kMaxDoublings = 20;  // 0.1 s * 2^20 is far beyond any max_backoff

constexpr int kOk = 200;
constexpr int kNotModified = 304;
constexpr int kServiceUnavailable = 503;

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

Duration backoff(const PollTimings& timings, int failures_in_row, double jitter) {
  const int doublings = std::clamp(failures_in_row - 1, 0, kMaxDoublings);
  Duration whole = timings.first_backoff;
  for (int i = 0; i < doublings && whole < timings.max_backoff; ++i) whole *= 2;
  whole = std::min(whole, timings.max_backoff);
  const double fraction = jitter >= 0.0 && jitter < 1.0 ? jitter : 0.0;  // NaN too
  return whole / 2 + from_seconds(seconds(whole) * 0.5 * fraction);
}

}  // namespace

std::string_view name_of(SensorState state) noexcept {
  switch (state) {
    case SensorState::Connecting:
      return "connecting";
    case SensorState::Live:
      return "live";
    case SensorState::Lost:
      return "lost";
    case SensorState::Refused:
      return "refused";
  }
  return "connecting";
}

Step PollFsm::resume(const Event& event, Duration now, double jitter) {
  Step step =
      std::visit(Overloaded{
                     [&](const Started&) { return Step{next_request(now)}; },
                     [&](const Woke&) { return Step{next_request(now)}; },
                     [&](const FrameAnswered& answer) { return on_frame(answer, now, jitter); },
                     [&](const FloorAnswered&) { return Step{next_request(now)}; },
                     [&](const Unreadable& body) {
                       etag_.clear();  // ask for the next body, whatever its tag
                       return fail(SensorState::Refused, to_string(body.error), jitter);
                     },
                     [&](const Failed& failed) {
                       const bool was_here = last_captured_.has_value();
                       return fail(was_here ? SensorState::Lost : SensorState::Connecting,
                                   to_string(failed.error), jitter);
                     },
                 },
                 event);
  step.notice = due_notice(now);
  return step;
}

Step PollFsm::on_frame(const FrameAnswered& answer, Duration now, double jitter) {
  if (answer.status == kServiceUnavailable) {
    const bool was_here = last_captured_.has_value();
    return fail(was_here ? SensorState::Lost : SensorState::Connecting,
                "the sensor service answers 503: its device delivers no frames", jitter);
  }
  if (answer.status != kNotModified && (answer.status != kOk || !answer.captured)) {
    return fail(SensorState::Refused,
                "GET frame answers " + std::to_string(answer.status) +
                    "; check that the url is that of a sensor service",
                jitter);
  }
  failures_in_row_ = 0;
  const bool news = answer.captured && answer.captured != last_captured_;
  if (answer.status == kOk) etag_ = answer.etag;
  if (news) {
    last_captured_ = answer.captured;
    enter(SensorState::Live, {});
    return {after(timings_.min_interval, now), true};
  }
  const bool waited = now - sent_at_ >= asked_wait_ / 2;
  if (answer.status == kNotModified && waited) {
    enter(last_captured_ ? SensorState::Lost : SensorState::Connecting,
          "the sensor service answers, but has no new frame");
    return {after(timings_.min_interval, now)};
  }
  ++repeats_;  // a server that ignores Prefer, or sends the same frame again
  return {after(timings_.idle_interval, now)};
}

Step PollFsm::fail(SensorState state, std::string reason, double jitter) {
  ++failures_;
  ++failures_in_row_;
  enter(state, std::move(reason));
  return {Sleep{backoff(timings_, failures_in_row_, jitter)}};
}

Action PollFsm::next_request(Duration now) {
  sent_at_ = now;
  if (!floor_due_ || now >= *floor_due_) {
    floor_due_ = now + timings_.floor_interval;
    asked_wait_ = Duration{0};
    return Send{Resource::FloorPlane, {}, Duration{0}, timings_.answer_slack};
  }
  asked_wait_ = etag_.empty() ? Duration{0} : timings_.wait;
  return Send{Resource::Frame, etag_, asked_wait_, asked_wait_ + timings_.answer_slack};
}

Action PollFsm::after(Duration interval, Duration now) {
  const Duration earliest = sent_at_ + interval;
  if (now < earliest) return Sleep{earliest - now};
  return next_request(now);
}

void PollFsm::enter(SensorState state, std::string reason) {
  const bool changed = state != state_ || (!reason.empty() && reason != last_error_);
  if (!changed) return;
  state_ = state;
  if (!reason.empty()) last_error_ = reason;
  if (state == SensorState::Live) {
    pending_notice_ = Notice{false, "sensor live", {}};
  } else if (state == SensorState::Refused) {
    pending_notice_ = Notice{true, "sensor refused", std::move(reason)};
  } else {
    const bool lost = state == SensorState::Lost;
    pending_notice_ = Notice{true, lost ? "sensor lost" : "sensor not reached", std::move(reason)};
  }
}

std::optional<Notice> PollFsm::due_notice(Duration now) {
  if (!pending_notice_ || (noticed_at_ && now - *noticed_at_ < kNoticeInterval))
    return std::nullopt;
  noticed_at_ = now;
  return std::exchange(pending_notice_, std::nullopt);
}

}  // namespace chorus::poll
