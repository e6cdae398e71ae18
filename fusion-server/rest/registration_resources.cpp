#include "fusion-server/rest/registration_resources.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/log.h"
#include "common/base/units.h"
#include "common/http/status.h"
#include "fusion-server/core/awaited.h"
#include "fusion-server/wire/registration_nodes.h"
#include "fusion-server/wire/session_limits.h"

namespace chorus::rest {
namespace {

/// Reads the members of a small object; `example` shows a correct one in errors.
Result<nlohmann::json> object_of(std::string_view body, const char* what, const char* example) {
  constexpr JsonLimits kLimits{4096, 4};
  auto json = parse_json(body, kLimits);
  if (json && json->is_object()) return json;
  const std::string reason = json ? "" : "; " + to_string(json.error());
  return fail(ErrorCode::InvalidArgument, what,
              std::string("send a JSON object, such as ") + example + reason);
}

bool busy(const RegistrationProgress& progress) {
  return !progress.sessions.empty() && running(progress.sessions.front());
}

/// Conflict while a session is running: `what` cannot be changed then.
Result<void> unless_busy(const RegistrationProgress& progress, const char* what) {
  if (!busy(progress)) return {};
  return fail(ErrorCode::Conflict, what,
              "a registration session is running; wait for its end, or cancel it: chorus register "
              "--cancel (DELETE " +
                  wire::session_path(progress.sessions.front().id) + ")");
}

}  // namespace

Result<SessionRequest> parse_session_request(std::string_view body, SessionRequest fallback) {
  const auto wrong = [](std::string message) {
    return fail(ErrorCode::InvalidArgument, "registration", std::move(message));
  };
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) return fallback;
  const auto json = object_of(body, "registration", R"({"seconds": 30})");
  if (!json) return pass(json);
  for (const auto& [key, value] : json->items()) {
    if (key == "seconds") {
      const double wanted = value.is_number() ? value.get<double>() : std::nan("");
      if (!(wanted >= wire::kMinSession && wanted <= wire::kMaxSession)) {
        return wrong("\"seconds\" is a number from " + log::number_text(wire::kMinSession) +
                     " to " + log::number_text(wire::kMaxSession));
      }
      fallback.target = from_seconds(wanted);
    } else if (key == "adopt") {
      const auto named = wire::adoption_named(value.is_string() ? value.get<std::string>() : "");
      if (!named) return wrong("\"adopt\" is \"at-once\" or \"when-accepted\"");
      fallback.adoption = *named;
    } else {
      return wrong("\"" + key + "\" is not known; \"seconds\" and \"adopt\" are");
    }
  }
  return fallback;
}

Result<core::Origin> parse_origin_request(std::string_view body) {
  const auto json = object_of(body, "origin", R"({"x": 1.5, "z": -2, "yawDegrees": 90})");
  if (!json) return pass(json);
  core::Origin origin;
  for (const auto& [key, value] : json->items()) {
    double* place = key == "x" ? &origin.x : key == "z" ? &origin.z : nullptr;
    if (key == "yawDegrees") place = &origin.yaw;
    if (!place || !value.is_number())
      return fail(ErrorCode::InvalidArgument, "origin",
                  "\"" + key + "\": known are the numbers \"x\", \"z\" [m] and \"yawDegrees\"");
    *place = value.get<double>();
  }
  origin.yaw = deg(origin.yaw);
  return origin;
}

RegistrationResources::RegistrationResources(service::Serving serving, RegistrationControl control)
    : serving_(std::move(serving)),
      control_(std::move(control)),
      live_(std::make_shared<http::LiveDocument>()) {}

void RegistrationResources::publish(const Registration& registration,
                                    const RegistrationProgress& progress) {
  const std::scoped_lock lock(mutex_);
  if (progress.commands < asked_) return;  // older than what we have promised
  registration_ = registration;
  progress_ = progress;
  show();
}

void RegistrationResources::show() {
  http::DocumentOptions options;
  options.version = serving_.run + "-" + std::to_string(++version_);
  live_->publish(resource::document_of(wire::registration_node(registration_, progress_),
                                       std::move(options), serving_.place("registration")));
}

Result<http::ActionResult> RegistrationResources::post(const http::Request& request) {
  const auto wish = parse_session_request(request.body, control_.defaults());
  if (!wish) return pass(wish);
  const std::scoped_lock lock(mutex_);
  if (!live_->current()) {
    return fail(ErrorCode::Unavailable, "registration", "the server is starting; ask again");
  }
  auto& sessions = progress_.sessions;
  const bool runs = busy(progress_);
  if (runs && !sessions.front().automatic) {
    return fail(ErrorCode::Conflict, "registration",
                "a session is running already: GET " + wire::session_path(sessions.front().id) +
                    " follows it, DELETE cancels it (chorus register --cancel)");
  }
  if (!runs) {
    SessionStatus started;
    started.id = progress_.next_session++;
    started.state = SessionState::Collecting;
    sessions.insert(sessions.begin(), std::move(started));
  }
  sessions.front().automatic = false;
  sessions.front().adoption = wish->adoption;
  sessions.front().target = seconds(wish->target);
  const std::uint64_t id = sessions.front().id;
  control_.start(*wish, id, ++asked_);
  show();
  return http::ActionResult{http::status::kAccepted, live_->current(), wire::session_path(id)};
}

void RegistrationResources::end_newest() {
  if (busy(progress_)) progress_.sessions.front().state = SessionState::Cancelled;
}

/// Neither it nor the decision about it is shown any longer.
void RegistrationResources::end_proposal() {
  progress_.proposal.reset();
  std::erase(progress_.awaits, core::kDecide);
}

/// Nothing that was said of other places is shown with these, until the pipeline speaks of them.
void RegistrationResources::forget_needs() {
  progress_.awaits.clear();
  progress_.alarms.clear();
}

http::ActionResult RegistrationResources::forget() {
  const std::scoped_lock lock(mutex_);
  end_newest();
  const std::uint64_t version = registration_.version;
  end_proposal();
  registration_ = Registration{};
  registration_.version = version;
  control_.forget(++asked_);
  show();
  return {http::status::kNoContent, nullptr, {}};
}

Result<http::ActionResult> RegistrationResources::move_origin(const http::Request& request) {
  const auto origin = parse_origin_request(request.body);
  if (!origin) return pass(origin);
  const std::scoped_lock lock(mutex_);
  if (auto idle = unless_busy(progress_, "origin"); !idle) return pass(idle);
  auto next = core::with_origin(registration_, *origin);
  if (!next) return pass(next);
  if (progress_.proposal) {
    if (auto moved = core::with_origin(progress_.proposal->registration, *origin))
      progress_.proposal->registration = std::move(*moved);
  }
  const std::uint64_t version = registration_.version + 1;
  progress_.earlier = std::exchange(registration_, std::move(*next));
  registration_.version = version;
  control_.move_origin(*origin, ++asked_);
  show();
  return http::ActionResult{http::status::kOk, live_->current(), {}};
}

/// The sensor's place is shown as gone at once, if enough others have one.
Result<http::ActionResult> RegistrationResources::register_anew(const std::string& id) {
  constexpr std::size_t kLeastPlaced = 3;
  const std::scoped_lock lock(mutex_);
  if (auto idle = unless_busy(progress_, "registration"); !idle) return pass(idle);
  const auto sensor = SensorId::parse(id);
  const bool placed = sensor && registration_.sensors.contains(*sensor);
  if (!sensor || (!placed && !registration_.verdicts.contains(*sensor)))
    return fail(ErrorCode::NotFound, "registration/sensors/" + id,
                "this sensor has no place and none was sought yet; a walk gives it one");
  if (placed && registration_.sensors.size() < kLeastPlaced)
    return fail(ErrorCode::Conflict, "registration",
                "with fewer than three sensors that have a place, a walk registers all of them: "
                "start one (POST /registration)");
  registration_.sensors.erase(*sensor);
  control_.register_anew(*sensor, ++asked_);
  show();
  return http::ActionResult{http::status::kAccepted, live_->current(), {}};
}

Result<http::ActionResult> RegistrationResources::undo() {
  const std::scoped_lock lock(mutex_);
  if (auto idle = unless_busy(progress_, "registration"); !idle) return pass(idle);
  if (!progress_.earlier)
    return fail(ErrorCode::NotFound, "registration", "no registration from before is known");
  const std::uint64_t version = registration_.version + 1;
  end_proposal();
  forget_needs();
  std::swap(registration_, *progress_.earlier);
  if (progress_.earlier->sensors.empty()) progress_.earlier.reset();
  registration_.version = version;
  control_.undo(++asked_);
  show();
  return http::ActionResult{http::status::kOk, live_->current(), {}};
}

Result<http::ActionResult> RegistrationResources::accept() {
  const std::scoped_lock lock(mutex_);
  if (auto idle = unless_busy(progress_, "registration"); !idle) return pass(idle);
  if (!progress_.proposal)
    return fail(ErrorCode::NotFound, "registration", "no registration waits to be accepted");
  const std::uint64_t version = registration_.version + 1;
  progress_.earlier = std::exchange(registration_, std::move(progress_.proposal->registration));
  end_proposal();
  forget_needs();
  registration_.version = version;
  control_.decide(true, ++asked_);
  show();
  return http::ActionResult{http::status::kOk, live_->current(), {}};
}

Result<http::ActionResult> RegistrationResources::decline() {
  const std::scoped_lock lock(mutex_);
  if (!progress_.proposal)
    return fail(ErrorCode::NotFound, "registration", "no registration waits to be accepted");
  end_proposal();
  control_.decide(false, ++asked_);
  show();
  return http::ActionResult{http::status::kOk, live_->current(), {}};
}

Result<SessionStatus> RegistrationResources::find(const std::string& id) const {
  for (const SessionStatus& session : progress_.sessions) {
    if (std::to_string(session.id) == id) return session;
  }
  return fail(ErrorCode::NotFound, "registration/sessions/" + id,
              "no session of this id, or too long ago; /registration names the newest");
}

Result<http::ActionResult> RegistrationResources::cancel(const std::string& id) {
  const std::scoped_lock lock(mutex_);
  const auto session = find(id);
  if (!session) return pass(session);
  if (!running(*session))
    return fail(ErrorCode::Conflict, "registration/sessions/" + id, "this session is over");
  end_newest();
  control_.cancel(session->id, ++asked_);
  show();
  return http::ActionResult{http::status::kNoContent, nullptr, {}};
}

Result<http::DocumentPtr> RegistrationResources::session(const std::string& id) const {
  const std::scoped_lock lock(mutex_);
  const auto session = find(id);
  if (!session) return pass(session);
  http::DocumentOptions options;
  options.version = serving_.run + "-" + std::to_string(version_);
  return resource::document_of(wire::session_node(*session, progress_.awaits), std::move(options),
                               serving_.place("registration/sessions/" + id));
}

void RegistrationResources::add_routes(http::Router& router) {
  using http::Method;
  using http::PathParams;
  using http::Request;
  using Done = Result<http::ActionResult>;
  const std::string one = "/registration/sessions/{id}";
  router.live("/registration", live_);
  router.get(one,
             [this](const Request&, const PathParams& params) { return session(params.at("id")); });
  router.action(Method::Post, "/registration",
                [this](const Request& request, const PathParams&) { return post(request); });
  router.action(Method::Delete, "/registration",
                [this](const Request&, const PathParams&) -> Done { return forget(); });
  router.action(Method::Post, "/registration/origin",
                [this](const Request& request, const PathParams&) { return move_origin(request); });
  router.action(
      Method::Post, "/registration/sensors/{id}/again",
      [this](const Request&, const PathParams& params) { return register_anew(params.at("id")); });
  router.action(Method::Post, "/registration/undo",
                [this](const Request&, const PathParams&) { return undo(); });
  router.action(Method::Post, "/registration/accept",
                [this](const Request&, const PathParams&) { return accept(); });
  router.action(Method::Post, "/registration/decline",
                [this](const Request&, const PathParams&) { return decline(); });
  router.action(Method::Delete, one, [this](const Request&, const PathParams& params) {
    return cancel(params.at("id"));
  });
}

}  // namespace chorus::rest
