#include "common/client/poll_fsm.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/shortened.h"
#include "common/http/status.h"

namespace chorus::client {
namespace {

constexpr Duration kNoticeInterval = std::chrono::seconds(1);
constexpr int kMaxDoublings = 20;  // 0.1 s * 2^20 is far beyond any max_backoff.
constexpr Duration kFloorPause = std::chrono::seconds(1);

// A stream without a frame for this long may be dead.
constexpr Duration kStreamAlive = std::chrono::milliseconds(500);
constexpr Duration kStreamProven = std::chrono::seconds(10);
constexpr Duration kStreamPause = std::chrono::seconds(1);
constexpr Duration kNoStreamPause = std::chrono::seconds(60);

// Interval of clock requests while the offset is not well known.
constexpr Duration kClockHurry = std::chrono::milliseconds(100);
constexpr Duration kClockInterval = std::chrono::milliseconds(500);
constexpr Duration kNoClockInterval = std::chrono::seconds(5);
constexpr Duration kWellKnown = std::chrono::microseconds(300);
// If the offset is still uncertain after so many hurried requests, more of them will not help: the
// network's delays limit it.
constexpr int kMostHurried = 50;
constexpr Duration kOddInterval = std::chrono::seconds(2);
constexpr std::size_t kMaxBeside = 100;
// Clock requests after an odd frame; the filter accepts a step of the clock with the third answer.
constexpr int kClockChecks = 4;

/// Between half of and the whole of first_backoff, doubled for each failure, but at most
/// max_backoff.
Duration backoff(const PollTimings& timings, int failures_in_row, double jitter) {
  const int doublings = std::clamp(failures_in_row - 1, 0, kMaxDoublings);
  Duration whole = timings.first_backoff;
  for (int i = 0; i < doublings && whole < timings.max_backoff; ++i) whole *= 2;
  whole = std::min(whole, timings.max_backoff);
  const double fraction = jitter >= 0.0 && jitter < 1.0 ? jitter : 0.0;  // Also 0 for NaN.
  return whole / 2 + from_seconds(seconds(whole) * 0.5 * fraction);
}

bool refuses_token(int status) {
  return status == http::status::kUnauthorized || status == http::status::kForbidden;
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
  const bool of_stream =
      std::holds_alternative<StreamFrame>(event) || std::holds_alternative<StreamEnded>(event);
  if (!of_stream) asking_ = false;
  Step step = std::visit([&](const auto& one) { return on(one, now, jitter); }, event);
  if (step.action) asking_ = std::holds_alternative<Send>(*step.action);
  step.notice = due_notice(now);
  return step;
}

Step PollFsm::on(const Started&, Duration now, double) { return go_on(now); }

Step PollFsm::on(const Woke&, Duration now, double) { return go_on(now); }

Step PollFsm::on(const FrameAnswered& answer, Duration now, double jitter) {
  if (streaming_) return beside_stream(answer, now);
  if (answer.status == http::status::kUnavailable) {
    return fail(
        gone(),
        "the sensor service answers 503: its device delivers no frames; its /healthz says why",
        jitter);
  }
  if (answer.status != http::status::kNotModified &&
      (answer.status != http::status::kOk || !answer.captured)) {
    return refuse(answer.status, jitter);
  }
  failures_in_row_ = 0;
  token_refused_ = false;
  const bool news = answer.captured && answer.captured != last_captured_;
  if (answer.status == http::status::kOk) etag_ = answer.etag;
  if (news) {
    last_captured_ = answer.captured;
    became_live(now);
    Step step{after(timings_.min_interval, now, answer.rest), true};
    if (wants_stream(now)) step.stream = StreamOrder::Open;
    return step;
  }
  const bool waited = now - sent_at_ >= asked_wait_ / 2;
  if (answer.status == http::status::kNotModified && waited) {
    enter(gone(), "the sensor service answers, but has no new frame");
    return {after(timings_.min_interval, now)};
  }
  // The server ignores Prefer, or sends the same frame again.
  return {after(timings_.idle_interval, now, answer.rest)};
}

/// Handles a frame that was requested because the stream is held up and will bring the same frame
/// later, or that was requested before the stream began.
Step PollFsm::beside_stream(const FrameAnswered& answer, Duration now) {
  if (answer.status == http::status::kOk) etag_ = answer.etag;
  const bool news = answer.status == http::status::kOk && answer.captured && last_captured_ &&
                    *answer.captured > *last_captured_;
  if (news) {
    last_captured_ = answer.captured;
    taken_beside_.push_back(*answer.captured);
    if (taken_beside_.size() > kMaxBeside) taken_beside_.pop_front();
  }
  const Duration interval = news ? timings_.min_interval : timings_.idle_interval;
  const Duration pause = std::max(sent_at_ + interval - now, answer.rest);
  Step step = pause > Duration{0} ? Step{Sleep{pause}} : go_on(now);
  step.deliver = news;
  return step;
}

/// True if this frame was requested in addition to the stream and delivered.  Such frames are
/// forgotten once the stream has passed them.
bool PollFsm::was_taken_beside(Timestamp captured) {
  const bool taken = std::ranges::find(taken_beside_, captured) != taken_beside_.end();
  std::erase_if(taken_beside_, [&](Timestamp each) { return each <= captured; });
  return taken;
}

Step PollFsm::on(const FloorAnswered& answer, Duration now, double) {
  floor_known_ = answer.known;
  floor_pause_ = Duration{0};
  if (!answer.known) floor_due_ = now + kFloorPause;
  return go_on(now);
}

Step PollFsm::on(const KeptAnswered& answer, Duration now, double) {
  backfill_.answered(answer.there);
  return {after(timings_.min_interval, now, answer.rest), answer.there};
}

Step PollFsm::on(const ClockAnswered& answer, Duration now, double) {
  if (clock_checks_ > 0) --clock_checks_;
  if (!answer.uncertainty) {
    clock_checks_ = 0;
    clock_due_ = now + kNoClockInterval;
  } else if (clock_checks_ > 0 || answer.doubtful) {
    clock_due_ = now;
    clock_hurried_ = 0;
  } else {
    const bool hurry = *answer.uncertainty > kWellKnown && clock_hurried_ < kMostHurried;
    clock_hurried_ += hurry ? 1 : 0;
    clock_due_ = now + (hurry ? kClockHurry : kClockInterval);
  }
  return {after(timings_.min_interval, now)};
}

Step PollFsm::on(const Unreadable& body, Duration, double jitter) {
  etag_.clear();  // Without a tag, the next answer has a body even if the frame is the same.
  Step step = fail(SensorState::Refused, to_string(body.error), jitter);
  auto& pause = std::get<Sleep>(*step.action).duration;
  pause = std::max(pause, body.rest);
  return step;
}

Step PollFsm::on(const Failed& failed, Duration now, double jitter) {
  if (asked_ == Resource::FloorPlane && state_ == SensorState::Live)
    floor_pause_ = std::clamp(2 * floor_pause_, kFloorPause, timings_.floor_interval);
  if (asked_ == Resource::Clock) clock_checks_ = 0;
  if (streaming_ && now - streamed_at_ < kStreamAlive) {  // Frames do come; only requests fail.
    ++failures_;
    clock_due_ = now + kClockInterval;
    return {Sleep{backoff(timings_, ++failures_in_row_, jitter)}};
  }
  const bool close = stream_asked_;
  if (close) leave_stream(now, kStreamPause);
  stream_due_ = now;  // A sensor that comes back may be able to stream.
  floor_known_ = false;
  Step step = fail(gone(), to_string(failed.error), jitter);
  if (close) step.stream = StreamOrder::Close;
  return step;
}

Step PollFsm::on(const StreamFrame& frame, Duration now, double) {
  Step step;
  if (!std::exchange(streaming_, true)) {
    streamed_since_ = now;
    clock_due_ = now + kClockHurry;
    clock_hurried_ = 0;
  }
  if (now - streamed_since_ > kStreamProven) stream_pause_ = Duration{0};
  streamed_at_ = now;
  if (offer_.kept) backfill_.saw(frame.sequence, now);
  rhythm_.saw(now);
  if (frame.odd) taken_beside_.clear();  // If its clock was set, earlier times have no meaning.
  const bool taken = was_taken_beside(frame.captured);
  step.deliver = !taken && frame.captured != last_captured_;
  step.late = !taken_beside_.empty();
  if (!step.late) last_captured_ = frame.captured;
  became_live(now);
  if (frame.odd && (!clock_checked_at_ || now - *clock_checked_at_ > kOddInterval)) {
    clock_checked_at_ = now;
    clock_checks_ = kClockChecks;
    clock_due_ = now;
  }
  const bool work = !backfill_.empty() || checking_clock() || floor_is_due(now);
  if (work && !asking_) step.action = next_request(now);
  return step;
}

Step PollFsm::on(const StreamEnded& end, Duration now, double) {
  const bool lived_on_it = streaming_;
  leave_stream(now, end.error.code == ErrorCode::Unsupported ? kNoStreamPause : kStreamPause);
  Step step;
  step.stream = StreamOrder::Close;
  if (lived_on_it && !asking_) step.action = next_request(now);
  return step;
}

/// Sends the next request that is due; closes a silent stream, after which polling continues.
Step PollFsm::go_on(Duration now) {
  const bool silent = streaming_ && now - streamed_at_ > timings_.wait;
  if (silent) leave_stream(now, kStreamPause);
  Step step{next_request(now)};
  if (silent) step.stream = StreamOrder::Close;
  return step;
}

Step PollFsm::fail(SensorState state, std::string reason, double jitter) {
  ++failures_;
  ++failures_in_row_;
  token_refused_ = false;
  enter(state, std::move(reason));
  return {Sleep{backoff(timings_, failures_in_row_, jitter)}};
}

/// Says why there was no document, and what to do about it.
std::string PollFsm::refusal_words(int status) const {
  const bool of_token = refuses_token(status);
  if (status == http::status::kTooManyRequests)
    return "GET " + std::string(offer_.path) +
           " answers 429: the sensor, or a proxy before it, asks for fewer requests from this "
           "address; look for other programs here that ask it";
  return "GET " + std::string(offer_.path) + " answers " + std::to_string(status) +
         (of_token ? "; give the sensor's entry here a token of its http.tokens"
                   : "; check that the url is that of a sensor service");
}

Step PollFsm::refuse(int status, double jitter) {
  // 429 only says that wrong tokens came before; the answer to those has the reason.
  const bool known = token_refused_ && status == http::status::kTooManyRequests;
  Step step = fail(SensorState::Refused, known ? last_error_ : refusal_words(status), jitter);
  token_refused_ = refuses_token(status);
  return step;
}

SensorState PollFsm::gone() const {
  return last_captured_ ? SensorState::Lost : SensorState::Connecting;
}

/// Notes that a frame came. If the sensor was not live and its floor plane is not known, or may be
/// of an earlier run, the plane is requested soon.
void PollFsm::became_live(Duration now) {
  failures_in_row_ = 0;
  if (state_ != SensorState::Live && floor_due_ && !floor_known_) {
    floor_due_ = std::min(*floor_due_, now + floor_pause_);
  }
  enter(SensorState::Live, {});
}

bool PollFsm::wants_stream(Duration now) {
  if (!timings_.stream || stream_asked_ || now < stream_due_) return false;
  backfill_.restart();
  return stream_asked_ = true;
}

/// Ends streaming.  Each stream that lasted less than kStreamProven doubles the pause before the
/// next one, up to a minute.
void PollFsm::leave_stream(Duration now, Duration pause) {
  stream_asked_ = false;
  streaming_ = false;
  rhythm_.restart();
  taken_beside_.clear();
  clock_checks_ = 0;
  stream_pause_ = std::clamp(2 * stream_pause_, pause, kNoStreamPause);
  stream_due_ = now + stream_pause_;
}

bool PollFsm::floor_is_due(Duration now) const {
  return offer_.floor && (!floor_due_ || now >= *floor_due_);
}

Action PollFsm::next_request(Duration now) {
  sent_at_ = now;
  asked_wait_ = Duration{0};
  asked_ = Resource::FloorPlane;
  if (floor_is_due(now) && (!floor_due_ || state_ == SensorState::Live)) {
    floor_due_ = now + timings_.floor_interval;
    return Send{asked_, {}, Duration{0}, timings_.answer_slack};
  }
  if (streaming_) return next_beside_stream(now);
  return next_frame();
}

Action PollFsm::next_frame() {
  asked_ = Resource::Frame;
  asked_wait_ = etag_.empty() ? Duration{0} : timings_.wait;
  return Send{asked_, etag_, asked_wait_, asked_wait_ + timings_.answer_slack};
}

Action PollFsm::next_beside_stream(Duration now) {
  if (!checking_clock()) {
    if (const auto sequence = backfill_.next(now)) {
      asked_ = Resource::KeptFrame;
      return Send{asked_, {}, Duration{0}, timings_.answer_slack, *sequence};
    }
  }
  const auto overdue = rhythm_.overdue_from(now);
  if (overdue && now >= *overdue) return next_frame();
  const Duration next = overdue ? std::min(*overdue, clock_due_) : clock_due_;
  if (now < next) return Sleep{std::min(next - now, kClockInterval)};
  asked_ = Resource::Clock;
  return Send{asked_, {}, Duration{0}, timings_.answer_slack};
}

Action PollFsm::after(Duration interval, Duration now, Duration rest) {
  const Duration pause = std::max(sent_at_ + interval - now, rest);
  if (pause > Duration{0}) return Sleep{pause};
  return next_request(now);
}

void PollFsm::enter(SensorState state, std::string reason) {
  reason = shortened(reason, kMaxReason);
  const bool changed = state != state_ || (!reason.empty() && reason != last_error_);
  if (!changed) return;
  state_ = state;
  last_error_ = reason;
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

}  // namespace chorus::client
