// One pushing program, from its hello on: reads its messages, estimates its clock, and passes its
// frames to the desk.  No IO; not thread-safe.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/net/token_bucket.h"
#include "services/sensor/device/bridge/push_desk.h"

namespace chorus::bridge {

/// What became of a message.
enum class Heard {
  Hello,
  Clock,
  Frame,
  LeftOut,  ///< A frame beyond the rate, or sent before its clock is known.
};

class PushSession {
 public:
  /// `via` and `address`: see Pusher.
  PushSession(std::shared_ptr<PushDesk> desk, std::string via, std::string address);
  ~PushSession();  ///< Leaves the desk.
  PushSession(const PushSession&) = delete;
  PushSession& operator=(const PushSession&) = delete;

  /// An error is meant for the program; lost() says whether it may continue after one.
  [[nodiscard]] Result<Heard> hear(std::string_view message);
  /// True when the program floods, has been replaced, or never sent a valid hello.
  [[nodiscard]] bool lost() const { return lost_; }
  /// Why the program leaves, for people.
  void leave_because(std::string why) { why_ = std::move(why); }

  [[nodiscard]] const std::optional<Hello>& hello() const { return hello_; }
  /// Call after asking for its time: for a second, frames before the answer are left out.
  void expect_clock();
  /// True when more exchanges with its clock are needed soon: there are too few, or they contradict
  /// each other.
  [[nodiscard]] bool wants_clock() const;
  [[nodiscard]] bool holds_sensor() const { return seat_ != 0 && desk_->sits(seat_); }

 private:
  [[nodiscard]] Result<void> admit(std::size_t bytes);
  [[nodiscard]] Result<Heard> on(Hello hello);
  [[nodiscard]] Result<Heard> on(const ClockAnswer& answer);
  [[nodiscard]] Result<Heard> on(PushedFrame frame);
  [[nodiscard]] Result<Duration> shift_of(Timestamp captured) const;

  std::shared_ptr<PushDesk> desk_;
  std::string via_;
  std::string address_;
  std::string why_ = "the connection ended";
  std::optional<Hello> hello_;
  PushDesk::Seat seat_ = 0;
  ClockFilter clock_;
  int exchanges_ = 0;
  SteadyTime unknown_until_{};  ///< Applies while there has been no exchange.
  net::TokenBucket messages_;
  net::TokenBucket bytes_;
  net::TokenBucket frames_;
  bool lost_ = false;
};

}  // namespace chorus::bridge
