#include "services/sensor/device/bridge/push_desk.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/base/log.h"
#include "common/base/shortened.h"

namespace chorus::bridge {
namespace {

constexpr std::size_t kQueue = 64;                        // Largest number of frames that wait.
constexpr Duration kMaxRepeat = std::chrono::seconds(1);  // as in SensorService
constexpr auto kShut = std::chrono::seconds(1);
constexpr std::uint64_t kWidestGap = 1000;
constexpr std::size_t kSilentPerPusher = 4;
constexpr std::size_t kMostLeaving = 64;  // They leave within a quarter of a second.

std::string described(const Pusher& pusher) {
  const std::string from = pusher.address.empty() ? "" : " from " + pusher.address;
  return fmt::format("\"{}\" ({}{})", pusher.name, pusher.via, from);
}

long whole_seconds(std::chrono::steady_clock::duration duration) {
  return static_cast<long>(std::chrono::duration_cast<std::chrono::seconds>(duration).count());
}

}  // namespace

PushDesk::PushDesk(DeskOptions options) : options_(std::move(options)), queue_(kQueue) {}

Result<PushDesk::Guest> PushDesk::connect(const std::string& via) {
  const std::lock_guard lock(mutex_);
  if (steady_now() < shut_until_) {
    return fail(ErrorCode::Unavailable, "/push",
                "a program has just been sent away for flooding; try again in a second");
  }
  const std::size_t most = kSilentPerPusher * options_.settings.max_pushers;
  std::size_t of_way = 0;
  std::size_t leaving = 0;
  Silent* oldest = nullptr;
  for (auto& [guest, one] : silent_) {
    if (one.leaves) ++leaving;
    if (one.leaves || one.via != via) continue;
    ++of_way;
    if (oldest == nullptr) oldest = &one;
  }
  if (leaving >= kMostLeaving)
    return fail(ErrorCode::Unavailable, "/push",
                fmt::format("{} programs connected and said nothing; end them", leaving));
  if (of_way >= most && oldest != nullptr) oldest->leaves = true;
  silent_.emplace(++last_guest_, Silent{via});
  return last_guest_;
}

void PushDesk::greeted(Guest guest) { disconnect(guest); }

void PushDesk::disconnect(Guest guest) {
  const std::lock_guard lock(mutex_);
  silent_.erase(guest);
}

bool PushDesk::must_leave(Guest guest) const {
  const std::lock_guard lock(mutex_);
  const auto found = silent_.find(guest);
  return found != silent_.end() && found->second.leaves;
}

void PushDesk::shut_for_a_moment() {
  const std::lock_guard lock(mutex_);
  shut_until_ = steady_now() + kShut;
}

/// Call it with the mutex held.
bool PushDesk::idle(const Holder& holder) const {
  return steady_now() - holder.last_frame.value_or(holder.sat_down) >
         options_.settings.yields_after;
}

Result<PushDesk::Seat> PushDesk::sit_down(const Pusher& pusher) {
  const std::lock_guard lock(mutex_);
  if (holder_ && !idle(*holder_)) {
    return fail(ErrorCode::Conflict, options_.sensor.str(),
                fmt::format("{} pushes to this sensor already; end it, or give this program a "
                            "chorus-sensor of its own",
                            described(*holder_->status.pusher)));
  }
  Holder holder;
  holder.seat = ++last_seat_;
  holder.sat_down = steady_now();
  holder.status.pusher = pusher;
  holder.status.since = now();
  holder_ = std::move(holder);
  turned_away_.clear();
  log::info("a program pushes frames", {{"name", pusher.name},
                                        {"layout", pusher.layout},
                                        {"via", pusher.via},
                                        {"address", pusher.address}});
  return last_seat_;
}

bool PushDesk::sits(Seat seat) const {
  const std::lock_guard lock(mutex_);
  return holder_ && holder_->seat == seat;
}

void PushDesk::leave(Seat seat, std::string_view why) {
  const std::lock_guard lock(mutex_);
  if (!holder_ || holder_->seat != seat) return;
  departed_ = fmt::format("{} left: {}", described(*holder_->status.pusher), why);
  log::info("a program pushes no more", {{"name", holder_->status.pusher->name}, {"why", why}});
  holder_.reset();
}

/// How far our sequence advances: a gap in the pusher's own numbers means lost frames.
std::uint64_t PushDesk::step_of(const PushedFrame& frame) const {
  if (!frame.sequence || !holder_->last_count || *frame.sequence <= *holder_->last_count) return 1;
  return std::min(*frame.sequence - *holder_->last_count, kWidestGap);
}

/// True if what was captured at this time may follow the last one.  SensorService has the same
/// rule, but here the pusher gets an error.
bool PushDesk::Line::advances(Timestamp captured) const {
  if (!last_captured || captured > *last_captured) return true;
  if (*last_captured - captured > kMaxRepeat) return true;
  return captured != *last_captured && refused_captured && captured > *refused_captured;
}

/// Whether this pusher may deliver what was captured at this time; then `line` has taken the time.
/// Call it with the mutex held.
Result<void> PushDesk::check_turn(Seat seat, Line& line, Timestamp captured) const {
  if (!holder_ || holder_->seat != seat)
    return fail(ErrorCode::Conflict, "type", "another program pushes to this sensor now");
  if (!line.advances(captured)) {
    line.refused_captured = captured;
    return fail(ErrorCode::Conflict, "captured",
                "must be later than that of the frame before; send frames in order, each once");
  }
  line.last_captured = captured;
  line.refused_captured.reset();
  return {};
}

/// Call it with the mutex held.
void PushDesk::note_taken() {
  holder_->last_frame = steady_now();
  holder_->refused_since = false;
  ++holder_->status.frames;
}

Result<void> PushDesk::take(Seat seat, PushedFrame frame, const Hello& hello) {
  const std::lock_guard lock(mutex_);
  if (auto ok = check_turn(seat, frames_, frame.captured); !ok) return ok;
  Capture capture;
  capture.frame.sensor = options_.sensor;
  capture.frame.sequence = frames_.sequence += step_of(frame);
  capture.frame.captured = frame.captured;
  capture.frame.received = now();
  capture.frame.bodies = std::move(frame.bodies);
  capture.frame.floor = frame.floor ? frame.floor : hello.floor;
  // The floor is that of one pusher: another may stand elsewhere, and this one may have taken its
  // own back by a new hello.
  capture.begins_anew =
      !std::exchange(holder_->sent_frame, true) || (holder_->hello_had_floor && !hello.floor);
  holder_->hello_had_floor = hello.floor.has_value();
  holder_->last_count = frame.sequence;
  note_taken();
  queue_.give(std::move(capture));
  return {};
}

Result<void> PushDesk::take(Seat seat, PushedOrientations pushed) {
  const std::lock_guard lock(mutex_);
  if (!options_.settings.orientations)
    return fail(ErrorCode::Conflict, "type",
                "this sensor takes no orientations; set device.bridge.orientations");
  if (auto ok = check_turn(seat, instants_, pushed.instant.captured); !ok) return ok;
  pushed.instant.source = options_.sensor;
  pushed.instant.received = now();
  pushed.instant.sequence = ++instants_.sequence;
  note_taken();
  queue_.give(std::move(pushed.instant));
  return {};
}

void PushDesk::note_refusal(Seat seat, const Error& error) {
  const std::string text = shortened(to_string(error), kMaxReason);
  refusals_.hit(text);
  const std::lock_guard lock(mutex_);
  if (!holder_ && seat == 0) turned_away_ = text;
  if (!holder_ || holder_->seat != seat) return;
  ++holder_->status.refused;
  holder_->status.last_error = text;
  holder_->refused_since = true;
}

void PushDesk::note_left_out(Seat seat) {
  const std::lock_guard lock(mutex_);
  if (holder_ && holder_->seat == seat) ++holder_->status.left_out;
}

void PushDesk::note_doubt(Seat seat, const std::string& doubt) {
  const std::lock_guard lock(mutex_);
  if (!holder_ || holder_->seat != seat || holder_->status.doubt == doubt) return;
  holder_->status.doubt = doubt;
  if (!doubt.empty())
    log::warn("pushed frames look wrong",
              {{"name", holder_->status.pusher->name}, {"reason", doubt}});
}

void PushDesk::note_clock(Seat seat, const std::optional<ClockEstimate>& estimate) {
  const std::lock_guard lock(mutex_);
  if (holder_ && holder_->seat == seat) holder_->status.clock = estimate;
}

/// Human-readable: why no frames arrive from the holder.  Call it with the mutex held.
std::string PushDesk::silence_of(const Holder& holder) const {
  const std::string who = described(*holder.status.pusher);
  if (holder.refused_since) {
    return fmt::format("no frame of {} is taken: {}", who, holder.status.last_error);
  }
  if (!holder.last_frame) return who + " has said hello and pushes no frames";
  return fmt::format("{} has pushed no frame for {} s", who,
                     whole_seconds(steady_now() - *holder.last_frame));
}

PushStatus PushDesk::status() const {
  const std::lock_guard lock(mutex_);
  PushStatus status = holder_ ? holder_->status : PushStatus{};
  if (!holder_) {
    status.state = "waiting";
    status.reason = "no program pushes frames";
    if (!turned_away_.empty()) {
      status.reason += "; the last one that tried was refused: " + turned_away_;
    } else if (!departed_.empty()) {
      status.reason += "; " + departed_;
    }
    return status;
  }
  const bool live = holder_->last_frame && !idle(*holder_);
  status.state = live ? "live" : "silent";
  if (!live) status.reason = silence_of(*holder_);
  return status;
}

}  // namespace chorus::bridge
