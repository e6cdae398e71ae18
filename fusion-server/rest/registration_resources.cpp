#include "fusion-server/rest/registration_resources.h"

#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/log.h"
#include "common/resource/json_guard.h"
#include "fusion-server/wire/registration_resource.h"

namespace chorus::rest {
namespace {

constexpr int kAccepted = 202;
constexpr int kNoContent = 204;

}  // namespace

Result<Duration> parse_session_request(std::string_view body, Duration fallback) {
  const auto wrong = [](std::string message) {
    return fail(ErrorCode::InvalidArgument, "registration", std::move(message));
  };
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) return fallback;
  constexpr resource::JsonLimits kLimits{4096, 4};
  const auto json = resource::parse_json(body, kLimits);
  if (!json || !json->is_object()) {
    const std::string reason = json ? "" : "; " + to_string(json.error());
    return wrong("send a JSON object, such as {\"seconds\": 30}" + reason);
  }
  for (const auto& [key, value] : json->items()) {
    if (key != "seconds") return wrong("\"" + key + "\" is not known; only \"seconds\" is");
  }
  if (json->empty()) return fallback;
  const auto& value = json->at("seconds");
  const double wanted = value.is_number() ? value.get<double>() : std::nan("");
  if (!(wanted >= kShortestSession && wanted <= kLongestSession)) {
    return wrong("\"seconds\" is a number from " + log::number_text(kShortestSession) + " to " +
                 log::number_text(kLongestSession));
  }
  return from_seconds(wanted);
}

RegistrationResources::RegistrationResources(RestContext context, RegistrationControl control)
    : context_(std::move(context)),
      control_(std::move(control)),
      live_(std::make_shared<http::LiveDocument>()) {}

void RegistrationResources::publish(const Registration& registration,
                                    const SessionStatus& session) {
  http::DocumentOptions options;
  options.version = context_.instance + "-" + std::to_string(++version_);
  resource::Place here;
  here.path = "registration";
  here.root = context_.root;
  live_->publish(resource::document_of(wire::registration_node(registration, session),
                                       std::move(options), here));
}

Result<http::ActionResult> RegistrationResources::post(const http::Request& request) const {
  const auto target = parse_session_request(request.body, control_.default_target());
  if (!target) return pass(target);
  if (auto started = control_.start(*target); !started) return pass(started);
  return http::ActionResult{kAccepted, live_->current(), "/registration"};
}

void RegistrationResources::add_routes(http::Router& router) {
  router.live("/registration", live_);
  router.action(
      http::Method::Post, "/registration",
      [this](const http::Request& request, const http::PathParams&) { return post(request); });
  router.action(
      http::Method::Delete, "/registration",
      [this](const http::Request&, const http::PathParams&) -> Result<http::ActionResult> {
        if (auto forgotten = control_.forget(); !forgotten) return pass(forgotten);
        return http::ActionResult{kNoContent, nullptr, {}};
      });
}

}  // namespace chorus::rest
