// /registration and its sessions over HTTP: GET reads, POST starts a session, moves the world's
// origin, accepts or declines a proposed registration, or goes back to the previous one; DELETE
// forgets the registration or cancels a session.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "common/http/router.h"
#include "common/service/serving.h"
#include "fusion-server/core/world.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/status/registration_progress.h"
#include "fusion-server/status/session_status.h"

namespace chorus::rest {

/// What a client asks for when it starts a session.
struct SessionRequest {
  Duration target = std::chrono::seconds(30);
  Adoption adoption = Adoption::AtOnce;
};

/// What the routes ask of the owner of the registration.  The functions must only post a task and
/// return.  `ticket` counts the requests: RegistrationProgress::commands says how many have been
/// carried out.
struct RegistrationControl {
  std::function<void(const SessionRequest& request, std::uint64_t session, std::uint64_t ticket)>
      start;
  std::function<void(std::uint64_t session, std::uint64_t ticket)> cancel;
  std::function<void(std::uint64_t ticket)> forget;
  std::function<void(const core::Origin& origin, std::uint64_t ticket)> move_origin;
  std::function<void(const SensorId& sensor, std::uint64_t ticket)> register_anew;
  std::function<void(std::uint64_t ticket)> undo;
  std::function<void(bool accept, std::uint64_t ticket)> decide;
  /// What holds for a session unless the request says otherwise.
  std::function<SessionRequest()> defaults = [] { return SessionRequest{}; };
};

/// Thread-safe.  A client's request affects every answer after its own: until the owner has carried
/// it out, its expected outcome is shown instead of the older state.
class RegistrationResources {
 public:
  RegistrationResources(service::Serving serving, RegistrationControl control);

  void publish(const Registration& registration, const RegistrationProgress& progress);
  void add_routes(http::Router& router);

 private:
  [[nodiscard]] Result<http::ActionResult> post(const http::Request& request);
  [[nodiscard]] http::ActionResult forget();
  [[nodiscard]] Result<http::ActionResult> move_origin(const http::Request& request);
  [[nodiscard]] Result<http::ActionResult> register_anew(const std::string& id);
  [[nodiscard]] Result<http::ActionResult> undo();
  [[nodiscard]] Result<http::ActionResult> accept();
  [[nodiscard]] Result<http::ActionResult> decline();
  [[nodiscard]] Result<http::ActionResult> cancel(const std::string& id);
  [[nodiscard]] Result<http::DocumentPtr> session(const std::string& id) const;
  [[nodiscard]] Result<SessionStatus> find(const std::string& id) const;
  void show();
  void end_newest();
  void end_proposal();
  void forget_needs();

  service::Serving serving_;
  RegistrationControl control_;
  std::shared_ptr<http::LiveDocument> live_;
  mutable std::mutex mutex_;  ///< Guards the members below.
  Registration registration_;
  RegistrationProgress progress_;
  std::uint64_t asked_ = 0;  ///< Ticket of the latest request.
  std::uint64_t version_ = 0;
};

/// Reads a body such as {"seconds": 30, "adopt": "when-accepted"}; what is omitted, or all of an
/// empty body, is as in `fallback`.  InvalidArgument for anything else.
[[nodiscard]] Result<SessionRequest> parse_session_request(std::string_view body,
                                                           SessionRequest fallback);

/// Reads a body such as {"x": 1.5, "z": -2, "yawDegrees": 90}, in the present world; what is
/// omitted is 0.  InvalidArgument for anything else.
[[nodiscard]] Result<core::Origin> parse_origin_request(std::string_view body);

}  // namespace chorus::rest
