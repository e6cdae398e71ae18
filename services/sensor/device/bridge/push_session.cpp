#include "services/sensor/device/bridge/push_session.h"

#include <utility>

#include <fmt/format.h>

namespace chorus::bridge {
namespace {

// Leaves room for clock answers, and for frames beyond the rate.
constexpr double kMessagesPerFrame = 4.0;
constexpr int kFewExchanges = 8;
// Many pushers stamp in whole milliseconds; that rounding must not look like a contradiction.
constexpr Duration kCoarseStamps = std::chrono::milliseconds(1);
// The fusion server's limits for the times of sensors (proto/README.md, section 4).
constexpr Duration kOldest = std::chrono::seconds(10);
constexpr Duration kMaxAhead = std::chrono::milliseconds(100);
constexpr Duration kMaxAheadUnasked = std::chrono::seconds(2);

net::Allowance burst_of_a_second(double per_second) { return {per_second, per_second}; }

}  // namespace

PushSession::PushSession(std::shared_ptr<PushDesk> desk, std::string via, std::string address)
    : desk_(std::move(desk)),
      via_(std::move(via)),
      address_(std::move(address)),
      messages_(burst_of_a_second(kMessagesPerFrame * desk_->options().settings.max_rate_hz)),
      bytes_(burst_of_a_second(desk_->options().settings.max_bytes_per_s)),
      frames_(burst_of_a_second(desk_->options().settings.max_rate_hz)) {}

PushSession::~PushSession() {
  if (seat_ != 0) desk_->leave(seat_, why_);
}

void PushSession::expect_clock() {
  constexpr auto kPatience = std::chrono::seconds(1);
  if (exchanges_ == 0) unknown_until_ = desk_->steady_now() + kPatience;
}

bool PushSession::wants_clock() const { return exchanges_ < kFewExchanges || clock_.doubtful(); }

/// Limits size and rate.  Called before a message is parsed, so that refusing a flood costs almost
/// nothing.
Result<void> PushSession::admit(std::size_t bytes) {
  const BridgeSettings& settings = desk_->options().settings;
  if (bytes > settings.max_message_bytes) {
    return fail(ErrorCode::TooLarge, {},
                fmt::format("a message has at most {} bytes (device.bridge.max_message_kb); this "
                            "one has {}",
                            settings.max_message_bytes, bytes));
  }
  const SteadyTime now = desk_->steady_now();
  if (messages_.take(1.0, now) && bytes_.take(static_cast<double>(bytes), now)) return {};
  lost_ = true;
  why_ = "it flooded";
  desk_->shut_for_a_moment();
  return fail(
      ErrorCode::Unavailable, {},
      fmt::format("too much: at most {:.0f} messages and {:.1f} MB a second are read "
                  "(device.bridge.max_rate_hz, max_mb_per_s); send each frame once",
                  kMessagesPerFrame * settings.max_rate_hz, settings.max_bytes_per_s / 1e6));
}

Result<Heard> PushSession::hear(std::string_view message) {
  if (const auto ok = admit(message.size()); !ok) {
    if (seat_ != 0) desk_->note_refusal(seat_, ok.error());
    return pass(ok);
  }
  auto heard =
      read_push_message(message, hello_ ? &*hello_ : nullptr).and_then([this](PushMessage&& read) {
        return std::visit([this](auto&& one) { return on(std::move(one)); }, std::move(read));
      });
  if (heard) return heard;
  if (!hello_) lost_ = true;
  desk_->note_refusal(seat_, heard.error());
  return heard;
}

Result<Heard> PushSession::on(Hello hello) {
  const bool same = hello_ && hello_->name == hello.name;
  if (hello_ && !same) {
    return fail(ErrorCode::Conflict, "name",
                "a connection keeps the name of its first hello, \"" + hello_->name + "\"");
  }
  if (!holds_sensor()) {
    const auto seat =
        desk_->sit_down({hello.name, std::string(hello.layout->name), via_, address_});
    lost_ = !seat;
    if (!seat) return pass(seat);
    seat_ = *seat;
  }
  if (hello_ && hello_->sensor_from_pusher != hello.sensor_from_pusher) doubts_ = {};
  if (hello_ && hello_->layout != hello.layout) placer_ = {};  // The new layout has other bones.
  hello_ = std::move(hello);
  return Heard::Hello;
}

Result<Heard> PushSession::on(const ClockAnswer& answer) {
  const Timestamp now = desk_->now();
  if (answer.sent > now) {
    return fail(ErrorCode::Malformed, "sent",
                "must be the stamp of our question, as it was; this one lies ahead");
  }
  clock_.add({answer.sent - kCoarseStamps, answer.received, answer.answered, now + kCoarseStamps});
  ++exchanges_;
  if (seat_ != 0) desk_->note_clock(seat_, clock_.at(now));
  return Heard::Clock;
}

/// What has to be added to a capture time to convert it to our clock; an error, with advice, if the
/// frame is then in the future or too old.
Result<Duration> PushSession::shift_of(Timestamp captured) const {
  const Timestamp now = desk_->now();
  const auto estimate = clock_.at(now);
  const Duration shift = estimate ? estimate->ours_minus_theirs : Duration{0};
  const Duration age = now - (captured + shift);
  const Duration ahead = estimate ? kMaxAhead + estimate->uncertainty : kMaxAheadUnasked;
  if (age >= -ahead && age <= kOldest) return shift;
  const char* const what =
      estimate ? "stamp frames by the clock that answers our questions for the time"
               : "set your clock (NTP), or answer the questions for the time (proto/bridge.md, "
                 "section 4), so that it need not be right";
  return fail(ErrorCode::InvalidArgument, "captured",
              fmt::format("is {:.3f} s {}; {}", seconds(std::chrono::abs(age)),
                          age < Duration::zero() ? "in the future" : "ago", what));
}

Result<Heard> PushSession::admit_capture(Timestamp captured, Duration& shift) {
  if (!holds_sensor()) {
    lost_ = true;
    why_ = "another program took its place";
    return fail(ErrorCode::Conflict, "type", "another program pushes to this sensor now");
  }
  const SteadyTime now = desk_->steady_now();
  if (!frames_.take(1.0, now) || (exchanges_ == 0 && now < unknown_until_)) {
    desk_->note_left_out(seat_);
    return Heard::LeftOut;
  }
  if (clock_.doubtful()) {
    return fail(ErrorCode::Unavailable, "captured",
                "your clock has just been set; frames are taken again as soon as it is known anew");
  }
  const auto known = shift_of(captured);
  if (!known) return pass(known);
  shift = *known;
  return Heard::Frame;
}

Result<Heard> PushSession::on(PushedFrame frame) {
  Duration shift{0};
  const auto admitted = admit_capture(frame.captured, shift);
  if (!admitted || *admitted != Heard::Frame) return admitted;
  frame.captured += shift;
  for (BodyFrame& body : frame.bodies) body.captured = frame.captured;
  PlacingErrors errors;
  errors.focal = hello_->focal_sigma;
  placer_.place(frame.bodies, frame.shapes, errors);
  doubts_.look(frame, *hello_, desk_->steady_now());
  desk_->note_doubt(seat_, doubts_.lasting());
  const auto taken = desk_->take(seat_, std::move(frame), *hello_);
  if (!taken) return pass(taken);
  return Heard::Frame;
}

Result<Heard> PushSession::on(PushedOrientations pushed) {
  Duration shift{0};
  const auto admitted = admit_capture(pushed.instant.captured, shift);
  if (!admitted || *admitted != Heard::Frame) return admitted;
  pushed.instant.captured += shift;
  for (inertial::InertialReading& each : pushed.instant.readings) each.captured += shift;
  const auto taken = desk_->take(seat_, std::move(pushed));
  if (!taken) return pass(taken);
  return Heard::Frame;
}

}  // namespace chorus::bridge
