// Follows services: a sensor's /frame, a tracker's /frame, anything that is a DocumentKind.
//
// There is one thread for all of them, and one or two connections per service and kind.  A dead,
// slow or faulty service costs the others nothing except network traffic and a tenth of the
// thread's time.  For each service: event stream with long polling beside it, back-fill of what was
// lost, the offset of its clock from ours, a budget for reading, bearer token and TLS.
//
// A service of its own follows a tracker like this; `inbox` is a Handover that its thread takes
// from:
//
//   client::Followers followers({.clock = clock});
//   followers.follow<resource::FrameResource>(
//       client::kFrames, {{*SensorId::parse("tracker"), "http://127.0.0.1:8080/"}},
//       [&](client::Arrived<resource::FrameResource> frame) { inbox.give(std::move(frame)); });
//   ...
//   const Timestamp instant = frame.document->captured + correction(frame.clock);  // by our clock
//   for (const client::FollowReport& each : followers.reports()) ...  // live? which trouble?
//
// follow_config.h reads the entries of a configuration; linking chorus::client is all it needs.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/client/document_kind.h"
#include "common/client/frames.h"
#include "common/client/poll_events.h"
#include "common/time/clock.h"
#include "common/time/ntp_status.h"
#include "common/tls/credentials.h"

namespace chorus::client {

struct FollowedService {
  SensorId id;             ///< Its own name, or what a tracker is called here.
  std::string url;         ///< The URL of the service's `/`: "http://127.0.0.1:8081/".
  std::string token = {};  ///< Sent with every request; empty: none.
  tls::Trust trust = {};   ///< The authorities accepted for https.

  bool operator==(const FollowedService&) const = default;
};

/// The state of following one service; a copy.
struct FollowReport {
  FollowedService service;
  SensorState state = SensorState::Connecting;
  /// What is wrong at present, also with the floor plane of a live sensor.
  std::string last_error;
  bool streaming = false;  ///< True while its documents come by event stream instead of polling.
  std::optional<Timestamp> newest;  ///< Capture time of the newest document, by our clock.
  double rate_hz = 0.0;             ///< Documents per second that arrived in the last two seconds.
  std::optional<ClockEstimate> clock;
  std::optional<NtpStatus> host;  ///< What its host says of its own clock.
  std::uint64_t frames = 0;
  std::uint64_t missed = 0;  ///< Documents missing from the numbering: neither delivered nor filled
                             ///< in later.
  std::uint64_t early = 0;   ///< Documents refused because their time is ahead of ours.
  std::uint64_t stale = 0;   ///< Documents refused because their time is far behind ours.
  std::uint64_t failures = 0;
};

struct FollowOptions {
  PollTimings timings = {};
  std::size_t max_body_bytes = 512u << 10;  ///< Limit for one frame; 64 bodies are about 350 kB.
  std::shared_ptr<const Clock> clock = std::make_shared<SystemClock>();
};

class Followers {
 public:
  explicit Followers(FollowOptions options);
  ~Followers();  ///< Stops all following and joins the thread.

  /// From now on follows these services, and no others, for documents of this kind; those already
  /// followed continue undisturbed, with the `deliver` that they have.  Every url must be valid for
  /// http::parse_url().  `deliver` is called on the thread of the followers and must return at
  /// once; if it throws, that document counts as a failure.  Thread-safe.
  template <class Value>
  void follow(const KindOf<Value>& kind, std::vector<FollowedService> services,
              std::function<void(Arrived<Value>)> deliver) {
    follow_any(kind, std::move(services), typed<Value>(std::move(deliver)));
  }

  /// Ends all following; nothing is delivered afterwards.  reports() may still be called.
  void stop();

  /// By service, ordered by id.
  [[nodiscard]] std::vector<FollowReport> reports(const DocumentKind& kind = kFrames) const;

 private:
  void follow_any(const DocumentKind& kind, std::vector<FollowedService> services,
                  const DeliverAny& deliver);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::client
