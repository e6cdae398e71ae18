// Answers of a sensor, and a follower in a known state, without a socket and without sleeping.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "common/client/poll_fsm.h"

namespace chorus::client {

inline constexpr double kFull = 0.999999999;  ///< Jitter that keeps the whole back-off.

[[nodiscard]] inline Timestamp at_ms(int ms) {
  return from_unix_ns(1'790'000'000'000'000'000) + std::chrono::milliseconds(ms);
}

[[nodiscard]] inline FrameAnswered frame(int ms, std::string etag) {
  return {200, std::move(etag), at_ms(ms)};
}

[[nodiscard]] inline Failed reset() {
  return {Error{ErrorCode::Io, "127.0.0.1:8081", "connection reset"}};
}

[[nodiscard]] inline const Send& send_of(const Step& step) { return std::get<Send>(*step.action); }
[[nodiscard]] inline Duration sleep_of(const Step& step) {
  return std::get<Sleep>(*step.action).duration;
}

/// A follower that has already received the floor plane; its first request for a frame has been
/// under way since `now`.
[[nodiscard]] inline PollFsm at_first_frame(Duration now) {
  PollFsm fsm;
  (void)fsm.resume(Started{}, now, kFull);
  (void)fsm.resume(FloorAnswered{}, now, kFull);
  return fsm;
}

/// A live follower: one frame was delivered, and the long poll for the second has been under way
/// since `now`.
[[nodiscard]] inline PollFsm live(Duration now) {
  PollFsm fsm = at_first_frame(now - std::chrono::milliseconds(20));
  (void)fsm.resume(frame(0, "\"1\""), now, kFull);
  return fsm;
}

}  // namespace chorus::client
