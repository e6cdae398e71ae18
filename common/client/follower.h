// Follows one service: carries out the decisions of PollFsm on the poll thread.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string_view>
#include <vector>

#include "common/client/answer.h"
#include "common/client/followers.h"
#include "common/client/frame_tally.h"
#include "common/client/parse_budget.h"
#include "common/client/poll_fsm.h"
#include "common/http/event_stream_client.h"
#include "common/net/asio.h"

namespace chorus::client {

/// What is followed, how, and to whom its documents go.
struct Following {
  DocumentKind kind;
  const FollowOptions& options;
  DeliverAny deliver;
};

/// Has one connection for requests and one for the event stream.  Runs on the poll thread; only
/// report() may be called from any thread.
class Follower : public std::enable_shared_from_this<Follower> {
 public:
  Follower(asio::io_context& io, FollowedService service, http::Url url, Following following);

  void start();
  void stop();
  [[nodiscard]] FollowReport report(Timestamp now) const;
  [[nodiscard]] const FollowedService& service() const noexcept { return service_; }

 private:
  /// A document that was read, when it was received, and whether a newer one came before it.
  struct Arrival {
    Document raw;
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
  void take_document(const http::ClientResponse& response, Resource asked);
  void take_events(const std::vector<http::ServerEvent>& events);
  void take_event(std::string_view text);
  [[nodiscard]] Dated dated(const Arrival& arrival) const;
  [[nodiscard]] std::optional<Error> untimely_now(const Dated& document) const;
  /// Counts a document that was refused because of its time.
  void note_untimely(const Dated& document);
  [[nodiscard]] bool in_doubt() const { return clock_.doubtful() || fsm_.checking_clock(); }
  void deliver(Arrival arrival);
  void hand_on(const Arrival& arrival);
  void hand_on_held();
  void publish_state();
  void tell(const Notice& notice) const;

  [[nodiscard]] std::string target_of(const Send& send) const;

  const Following following_;
  const FollowedService service_;
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
  std::optional<Arrival> answered_;  ///< The document in the answer or event that is being handled.
  std::deque<Arrival> held_;  ///< Documents held back while the clock is in doubt; a few at most.
  mutable std::mutex mutex_;
  FollowReport report_;  ///< Guarded by mutex_, like tally_.
  FrameTally tally_;
};

}  // namespace chorus::client
