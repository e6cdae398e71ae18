// One pusher, from its hello on.  Reads its messages, estimates its clock, and passes its
// frames to the desk.  No IO; not thread-safe.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/net/token_bucket.h"
#include "common/sensor/body_placer.h"
#include "services/sensor/device/bridge/pose_doubts.h"
#include "services/sensor/device/bridge/push_desk.h"

namespace chorus::bridge {

/// The kind of a message, and what was done with it.
enum class Heard {
  Hello,
  Clock,
  Frame,    ///< A frame, or orientations.
  LeftOut,  ///< A frame beyond the maximum rate, or sent before the pusher's clock is known.
};

class PushSession {
 public:
  /// `via` and `address`: see Pusher.
  PushSession(std::shared_ptr<PushDesk> desk, std::string via, std::string address);
  ~PushSession();  ///< Leaves the desk.
  PushSession(const PushSession&) = delete;
  PushSession& operator=(const PushSession&) = delete;

  /// Handles one message.  An error is sent to the pusher; lost() says whether it may continue
  /// after that.
  [[nodiscard]] Result<Heard> hear(std::string_view message);
  /// True when the pusher has sent too much, has been replaced, or has sent no hello that was
  /// accepted.
  [[nodiscard]] bool lost() const { return lost_; }
  /// Human-readable: why the pusher leaves.
  void leave_because(std::string why) { why_ = std::move(why); }

  [[nodiscard]] const std::optional<Hello>& hello() const { return hello_; }
  /// Call this after asking for the pusher's time.  Frames are then left out until the pusher's
  /// first answer, but for a second at most.
  void expect_clock();
  /// True when the pusher should be asked for its time again soon: there have been too few answers,
  /// or they contradict each other.
  [[nodiscard]] bool wants_clock() const;
  /// What is probably wrong although frames are taken; each doubt is returned once.
  [[nodiscard]] std::optional<Error> take_doubt() { return doubts_.take_new(); }
  [[nodiscard]] bool holds_sensor() const { return seat_ != 0 && desk_->sits(seat_); }

 private:
  [[nodiscard]] Result<void> admit(std::size_t bytes);
  [[nodiscard]] Result<Heard> on(Hello hello);
  [[nodiscard]] Result<Heard> on(const ClockAnswer& answer);
  [[nodiscard]] Result<Heard> on(PushedFrame frame);
  [[nodiscard]] Result<Heard> on(PushedOrientations pushed);
  /// What is common to all that is pushed: LeftOut, an error, or Frame when it may be taken after
  /// adding `shift` to its times.
  [[nodiscard]] Result<Heard> admit_capture(Timestamp captured, Duration& shift);
  [[nodiscard]] Result<Duration> shift_of(Timestamp captured) const;

  std::shared_ptr<PushDesk> desk_;
  std::string via_;
  std::string address_;
  std::string why_ = "the connection ended";
  std::optional<Hello> hello_;
  PushDesk::Seat seat_ = 0;
  BodyPlacer placer_;
  PoseDoubts doubts_;
  ClockFilter clock_;
  int exchanges_ = 0;
  /// While the pusher's clock is unknown, frames are left out until this time.
  SteadyTime unknown_until_{};
  net::TokenBucket messages_;
  net::TokenBucket bytes_;
  net::TokenBucket frames_;
  bool lost_ = false;
};

}  // namespace chorus::bridge
