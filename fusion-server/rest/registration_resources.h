// /registration over HTTP: GET shows, POST starts a session, DELETE forgets.
#pragma once

#include <functional>
#include <memory>

#include "common/http/router.h"
#include "fusion-server/rest/frame_resources.h"
#include "fusion-server/status.h"

namespace chorus::rest {

/// How long a session may be asked to collect [s]: shorter walks cannot be solved, longer ones only
/// take memory.
inline constexpr double kShortestSession = 8.0;
inline constexpr double kLongestSession = 300.0;

/// What the routes ask of whoever owns the registration.  Called on the server's thread; must only
/// post.
struct RegistrationControl {
  /// Conflict when a session is running.
  std::function<Result<void>(Duration target)> start;
  std::function<Result<void>()> forget;
  /// How long a session collects when the request does not say.
  std::function<Duration()> default_target = [] { return std::chrono::seconds(30); };
};

class RegistrationResources {
 public:
  RegistrationResources(RestContext context, RegistrationControl control);

  void publish(const Registration& registration, const SessionStatus& session);
  void add_routes(http::Router& router);

 private:
  [[nodiscard]] Result<http::ActionResult> post(const http::Request& request) const;

  RestContext context_;
  RegistrationControl control_;
  std::shared_ptr<http::LiveDocument> live_;
  std::uint64_t version_ = 0;
};

/// "{"seconds": 30}" or an empty body -> the target; anything else is InvalidArgument and says so.
[[nodiscard]] Result<Duration> parse_session_request(std::string_view body, Duration fallback);

}  // namespace chorus::rest
