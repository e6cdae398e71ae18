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

/// The error that a problem document states, or else the bare status; `where`: the request.
[[nodiscard]] Error refusal_of(const http::ClientResponse& answer, const std::string& where);

/// The header of every request: the bearer token in CHORUS_TOKEN, if one is set.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> authorization();

/// The authorities that must have certified an https:// server: the file in CHORUS_CA; else that of
/// the workshop, if this host has one that the user may read (/etc/chorus/tls/ca.crt); else those
/// of the operating system.
[[nodiscard]] Result<tls::Trust> authorities();

/// http::fetch with these authorities.
[[nodiscard]] Result<http::ClientResponse> fetch_trusted(const http::Url& url,
                                                         const http::ClientRequest& request,
                                                         const http::ClientLimits& limits = {});

/// Where the certificates of this host are, if it has any.
inline constexpr const char* kTlsFolder = "/etc/chorus/tls";

/// Whether services of this host have TLS: `chorus init` gives it to them where host.crt is.
[[nodiscard]] bool host_has_tls(const std::string& folder = kTlsFolder);

/// The fusion server of this host.
[[nodiscard]] std::string default_server(const std::string& tls_folder = kTlsFolder);

class ServiceClient {
 public:
  /// `url` names the server; a path in it is kept as prefix.  For https:// the authorities() are
  /// read here, once.
  [[nodiscard]] static Result<ServiceClient> of(std::string_view url);

  /// An empty answer is null.
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

/// Reads a member that may be absent or of another type; then the fallback is returned.
[[nodiscard]] std::string text_at(const nlohmann::json& object, const char* key,
                                  std::string fallback = "-");
[[nodiscard]] double number_at(const nlohmann::json& object, const char* key);  ///< NaN if none.
/// An object's member if that is an object or array; otherwise an empty one.
[[nodiscard]] const nlohmann::json& part_at(const nlohmann::json& object, const char* key);

}  // namespace chorus::client
