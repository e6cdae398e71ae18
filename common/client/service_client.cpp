#include "common/client/service_client.h"

#include <unistd.h>

#include <cstdlib>
#include <limits>

#include "common/base/json.h"
#include "common/http/status.h"

#include <fmt/format.h>

namespace chorus::client {
namespace {

constexpr const char* kAuthoritiesVariable = "CHORUS_CA";
constexpr const char* kAuthoritiesOfWorkshop = "/etc/chorus/tls/ca.crt";

/// The environment variable that holds the bearer token for servers that require a token.
constexpr const char* kTokenVariable = "CHORUS_TOKEN";

/// What to do about a 401, in words of this program: the server's own speak of HTTP headers.
std::string token_advice() {
  return authorization().empty() ? "set CHORUS_TOKEN to a token of this server"
                                 : "the server does not know the token in CHORUS_TOKEN";
}

}  // namespace

std::vector<std::pair<std::string, std::string>> authorization() {
  const char* token = std::getenv(kTokenVariable);
  if (token == nullptr || *token == '\0') return {};
  return {{"Authorization", std::string("Bearer ") + token}};
}

bool host_has_tls(const std::string& folder) {
  return ::access((folder + "/host.crt").c_str(), F_OK) == 0;
}

std::string default_server(const std::string& tls_folder) {
  return std::string(host_has_tls(tls_folder) ? "https" : "http") + "://127.0.0.1:8080/";
}

Result<tls::Trust> authorities() {
  const char* file = std::getenv(kAuthoritiesVariable);
  if (file != nullptr && *file != '\0') return tls::Trust::load(file);
  if (::access(kAuthoritiesOfWorkshop, R_OK) == 0) return tls::Trust::load(kAuthoritiesOfWorkshop);
  return tls::Trust();
}

Result<http::ClientResponse> fetch_trusted(const http::Url& url, const http::ClientRequest& request,
                                           const http::ClientLimits& limits) {
  if (!url.secure) return http::fetch(url, request, limits);
  const auto trust = authorities();
  if (!trust) return pass(trust);
  return http::fetch(url, request, limits, *trust);
}

Error refusal_of(const http::ClientResponse& answer, const std::string& where) {
  const auto problem = parse_json(answer.body).value_or(nlohmann::json());
  std::string message = fmt::format("answers with status {}", answer.status);
  if (answer.status == http::status::kUnauthorized) message += ": " + token_advice();
  for (const char* key : {"title", "detail"}) {
    if (problem.is_object() && problem.contains(key) && problem[key].is_string())
      message += ": " + problem[key].get<std::string>();
  }
  auto code = ErrorCode::Unavailable;
  if (answer.status == http::status::kNotFound) code = ErrorCode::NotFound;
  if (answer.status == http::status::kConflict) code = ErrorCode::Conflict;
  return {code, where, message};
}

Result<ServiceClient> ServiceClient::of(std::string_view url) {
  auto base = http::parse_url(url);
  if (!base) return pass(base);
  while (base->target.ends_with('/')) base->target.pop_back();
  auto trust = base->secure ? authorities() : Result<tls::Trust>(tls::Trust());
  if (!trust) return pass(trust);
  return ServiceClient(std::move(*base), std::move(*trust));
}

Result<nlohmann::json> ServiceClient::get(std::string_view path) const {
  return ask("GET", path, {});
}

Result<nlohmann::json> ServiceClient::post(std::string_view path,
                                           const nlohmann::json& body) const {
  return ask("POST", path, body.dump());
}

Result<nlohmann::json> ServiceClient::remove(std::string_view path) const {
  return ask("DELETE", path, {});
}

Result<nlohmann::json> ServiceClient::ask(std::string_view method, std::string_view path,
                                          std::string body) const {
  http::ClientRequest request;
  request.method = method;
  request.target = base_.target + std::string(path);
  request.headers = {{"Accept", "application/json"}};
  if (!body.empty()) request.headers.push_back({"Content-Type", "application/json"});
  for (auto& header : authorization()) request.headers.push_back(std::move(header));
  request.body = std::move(body);
  const std::string where = http::url_text(base_, request.target);
  const auto answer = http::fetch(base_, request, {}, trust_);
  if (!answer && answer.error().message.starts_with("cannot connect"))
    return fail(answer.error().code, where,
                answer.error().message + "; is chorus-fusion running there?");
  if (!answer) return fail(answer.error().code, where, answer.error().message);
  if (answer->status >= http::status::kBadRequest)
    return tl::unexpected<Error>(refusal_of(*answer, where));
  if (answer->body.empty()) return nlohmann::json();
  auto parsed = parse_json(answer->body, {.bytes = answer->body.size()});
  if (!parsed)
    return fail(ErrorCode::Malformed, where, "does not answer in JSON. Is it a Chorus service?");
  return parsed;
}

std::string text_at(const nlohmann::json& object, const char* key, std::string fallback) {
  if (!object.is_object()) return fallback;
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>()
                                                     : std::move(fallback);
}

double number_at(const nlohmann::json& object, const char* key) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!object.is_object()) return kNone;
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : kNone;
}

const nlohmann::json& part_at(const nlohmann::json& object, const char* key) {
  static const nlohmann::json kEmpty = nlohmann::json::object();
  if (!object.is_object()) return kEmpty;
  const auto found = object.find(key);
  return found != object.end() && found->is_structured() ? *found : kEmpty;
}

}  // namespace chorus::client
