// Follows one sensor: carries out the decisions of PollFsm on the poll thread.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include "common/http/event_stream_client.h"
#include "common/net/asio.h"
#include "fusion-server/poll/answer.h"
#include "fusion-server/poll/frame_tally.h"
#include "fusion-server/poll/parse_budget.h"
#include "fusion-server/poll/poller.h"

namespace chorus::poll {

/// Has one connection for requests and one for the event stream.  Runs on the poll thread; only
/// report() may be called from any thread.
class Follower : public std::enable_shared_from_this<Follower> {
 public:
  Follower(asio::io_context& io, PolledSensor sensor, http::Url url, const PollerOptions& options);

  void start();
  void stop();
  [[nodiscard]] PollReport report(Timestamp now) const;

 private:
  using FramePtr = std::shared_ptr<const resource::FrameResource>;
  /// A frame that was read, when it was received, and whether a newer one came before it.
  struct Arrival {
    FramePtr raw;
    Timestamp received;
    bool late = false;
  };

  template <class Doing>
  void survive(const Doing& doing);
  void feed(const Event& event);
  void act(const Send& send);
  void act(const Sleep& sleep);
  void open_stream();
  void take(Result<http::ClientResponse> response, const Send& asked);
  void take_clock(const http::ClientResponse& response);
  void take_frame(const http::ClientResponse& response, Resource asked);
  void take_events(const std::vector<http::ServerEvent>& events);
  void take_event(std::string_view text);
  /// The frame with its times by our clock but without its bodies, which are placed only once it
  /// is certain that it is handed on.
  [[nodiscard]] SensorFrame dated(const Arrival& arrival) const;
  [[nodiscard]] std::optional<Error> untimely_now(const SensorFrame& frame) const;
  /// Counts a frame that was refused because of its time.
  void note_untimely(const SensorFrame& frame);
  [[nodiscard]] bool in_doubt() const { return clock_.doubtful() || fsm_.checking_clock(); }
  void deliver(Arrival arrival);
  void hand_on(const Arrival& arrival);
  void hand_on_held();
  void publish_state();
  void tell(const Notice& notice) const;

  const PollerOptions& options_;
  PolledSensor sensor_;
  http::Url url_;
  http::AsyncClient client_;
  http::AsyncEventStream stream_;
  net::Timer timer_;
  PollFsm fsm_;
  ClockFilter clock_;
  ParseBudget budget_;
  AgeWatch ages_;
  std::minstd_rand random_;
  bool stopped_ = false;
  std::uint64_t early_ = 0;
  std::uint64_t stale_ = 0;
  /// True if the stream was not read for some time: then only its newest event is worth reading.
  bool rested_ = false;
  Timestamp received_{};
  std::optional<FloorPlane> floor_;
  std::string floor_error_;  ///< Why the last answer of /floor-plane was none.
  std::optional<NtpStatus> host_;
  std::optional<Arrival> answered_;  ///< The frame in the answer or event that is being handled.
  std::deque<Arrival> held_;  ///< Frames held back while the clock is in doubt; a few at most.
  mutable std::mutex mutex_;
  PollReport report_;  ///< Guarded by mutex_, like tally_.
  FrameTally tally_;
};

}  // namespace chorus::poll
