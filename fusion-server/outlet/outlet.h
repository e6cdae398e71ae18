// The sending end of a protocol, and a wrapper that runs it on its own thread with a bounded queue.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "common/base/handover.h"
#include "common/base/rate_report.h"
#include "common/time/clock.h"
#include "fusion-server/outlet/tracker_frame.h"
#include "fusion-server/sink.h"

namespace chorus::outlet {

/// Encodes and sends synchronously, always on the same thread; it may be slow.
class Outlet {
 public:
  virtual ~Outlet() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  virtual void send(const TrackerFrame& frame) = 0;
  /// Counters that only the protocol knows: failed, refused, clients.  May be called from any
  /// thread.
  [[nodiscard]] virtual SinkCounters counters() const = 0;
};

/// What every protocol receives in addition to its own settings.
struct OutletContext {
  std::size_t slots = 6;  ///< Maximum number of people.
  std::shared_ptr<const Clock> clock;
  std::vector<std::string> props = {};  ///< Names of the things in hands, which are announced.
};

enum class Latency {
  Exact,      ///< Sends the fused poses as they are, later than real time by the alignment delay.
  Predicted,  ///< Sends poses predicted to the time of sending.
};

struct OutletTiming {
  Latency latency = Latency::Exact;
  std::size_t slots = 6;  ///< Maximum number of people.
  std::shared_ptr<const Clock> clock;
  std::shared_ptr<const workplace::PropBoard> board = {};  ///< Who holds what.
};

/// Passes frames to the outlet on a thread of its own.  When two frames wait for the outlet and
/// another comes, the older of the two is dropped and counted; the pipeline never waits.  An
/// exception from the outlet is logged and counted as failed; only that frame is lost.
class OutletSink final : public Sink {
 public:
  OutletSink(std::unique_ptr<Outlet> outlet, OutletTiming timing);
  ~OutletSink() override;  ///< Stops and joins the thread.

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
