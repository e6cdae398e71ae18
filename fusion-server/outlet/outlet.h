// A protocol's sending end, and the wrapper that gives it a thread and a bounded queue.
#pragma once

#include <atomic>
#include <memory>
#include <string_view>
#include <thread>

#include "common/base/handover.h"
#include "common/base/rate_report.h"
#include "common/time/clock.h"
#include "fusion-server/outlet/tracker_frame.h"
#include "fusion-server/sink.h"

namespace chorus::outlet {

/// Encodes and sends, synchronously, always on the same thread; may take its time.
class Outlet {
 public:
  virtual ~Outlet() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  virtual void send(const TrackerFrame& frame) = 0;
  /// Counters that only the protocol knows: failed, refused, clients.  Any thread.
  [[nodiscard]] virtual SinkCounters counters() const = 0;
};

/// Settings that every protocol gets.
struct OutletContext {
  std::size_t slots = 6;  ///< Persons at most.
  std::shared_ptr<const Clock> clock;
};

enum class Latency {
  Exact,      ///< The fused instant as it is, alignment delay included.
  Predicted,  ///< Moved to the time of sending at constant velocity.
};

struct OutletTiming {
  Latency latency = Latency::Exact;
  std::size_t slots = 6;  ///< Persons at most.
  std::shared_ptr<const Clock> clock;
};

/// Hands frames to the outlet on a thread of its own.  When the outlet is two frames behind, the
/// oldest is dropped and counted; the pipeline never waits.  An exception from the outlet is
/// logged, counted as failed, and costs that frame.
class OutletSink final : public Sink {
 public:
  OutletSink(std::unique_ptr<Outlet> outlet, OutletTiming timing);
  ~OutletSink() override;  ///< Stops and joins.

  [[nodiscard]] std::string_view name() const override { return outlet_->name(); }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;
  [[nodiscard]] SinkCounters counters() const override;

 private:
  void run();
  void send(TrackerState& state, const Snapshot& snapshot);

  std::unique_ptr<Outlet> outlet_;
  OutletTiming timing_;
  Handover<std::shared_ptr<const Snapshot>> waiting_;
  RateReport trouble_;
  std::atomic<std::uint64_t> sent_ = 0;
  std::atomic<std::uint64_t> failed_ = 0;
  std::jthread thread_;
};

}  // namespace chorus::outlet
