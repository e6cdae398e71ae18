// Clocks are arguments: code that needs the time is given a Clock.
#pragma once

#include <atomic>

#include "common/time/timestamp.h"

namespace chorus {

class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual Timestamp now() const = 0;
};

/// The host's UTC (CLOCK_REALTIME), as NTP keeps it, plus a fixed error for a simulated host.
class SystemClock final : public Clock {
 public:
  SystemClock() = default;
  explicit SystemClock(Duration error) : error_(error) {}
  [[nodiscard]] Timestamp now() const override;

 private:
  Duration error_{0};
};

/// A clock that a test moves by hand.
class FakeClock final : public Clock {
 public:
  explicit FakeClock(Timestamp start) : ns_(to_unix_ns(start)) {}
  [[nodiscard]] Timestamp now() const override { return from_unix_ns(ns_.load()); }
  void set(Timestamp t) { ns_.store(to_unix_ns(t)); }
  void advance(Duration d) { ns_.fetch_add(d.count()); }

 private:
  std::atomic<std::int64_t> ns_;
};

}  // namespace chorus
