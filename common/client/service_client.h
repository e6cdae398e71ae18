// Sends requests to a fusion server, in JSON. Problem documents (RFC 9457) become errors.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/http/client.h"
#include "common/tls/credentials.h"

namespace chorus::client {

/// The error that the answer's problem document states; if it has none, an error with the bare
/// status; a 401 says first what to do about CHORUS_TOKEN.  `where`: the request.
[[nodiscard]] Error refusal_of(const http::ClientResponse& answer, const std::string& where);

/// The Authorization header with the bearer token in CHORUS_TOKEN; empty if the variable is not
/// set.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> authorization();

/// The authorities that are accepted for an https:// server: those in the file that CHORUS_CA
/// names; otherwise the workshop's own (/etc/chorus/tls/ca.crt), if this host has its certificate
/// and the user may read it; otherwise those of the operating system.
[[nodiscard]] Result<tls::Trust> authorities();

/// http::fetch() with authorities().
[[nodiscard]] Result<http::ClientResponse> fetch_trusted(const http::Url& url,
                                                         const http::ClientRequest& request,
                                                         const http::ClientLimits& limits = {});

/// Where the certificates of this host are, if it has any.
inline constexpr const char* kTlsFolder = "/etc/chorus/tls";

/// True if services of this host use TLS: `chorus init` configures it where there is a host.crt.
[[nodiscard]] bool host_has_tls(const std::string& folder = kTlsFolder);

/// The address of the fusion server on this host.
[[nodiscard]] std::string default_server(const std::string& tls_folder = kTlsFolder);

class ServiceClient {
 public:
  /// `url` names the server; a path in it becomes a prefix.  For https:// the authorities() are
  /// read here, once.
  [[nodiscard]] static Result<ServiceClient> of(std::string_view url);

  /// The answer to a GET; null if it is empty.
  [[nodiscard]] Result<nlohmann::json> get(std::string_view path) const;
  [[nodiscard]] Result<nlohmann::json> post(std::string_view path,
                                            const nlohmann::json& body) const;
  [[nodiscard]] Result<nlohmann::json> remove(std::string_view path) const;

 private:
  ServiceClient(http::Url base, tls::Trust trust)
      : base_(std::move(base)), trust_(std::move(trust)) {}
  [[nodiscard]] Result<nlohmann::json> ask(std::string_view method, std::string_view path,
                                           std::string body) const;

  http::Url base_;
  tls::Trust trust_;
};

/// The member's string; `fallback` if the member is absent or has another type.
[[nodiscard]] std::string text_at(const nlohmann::json& object, const char* key,
                                  std::string fallback = "-");
/// NaN if there is no such number.
[[nodiscard]] double number_at(const nlohmann::json& object, const char* key);
/// The member if it is an object or array; otherwise an empty object.
[[nodiscard]] const nlohmann::json& part_at(const nlohmann::json& object, const char* key);

}  // namespace chorus::client
