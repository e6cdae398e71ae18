#include "services/ctl/operate/no_fusion_server.h"

#include "common/client/service_client.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {

Error no_fusion_server(const client::ServiceClient& server, const std::string& url, Error error) {
  if (error.code != ErrorCode::NotFound) return error;
  const auto self = server.get("/");
  if (!self || client::text_at(*self, "sensorId", "").empty()) return error;
  return {ErrorCode::Unsupported, url,
          "is sensor " + client::text_at(*self, "sensorId") +
              ", not a fusion server; its own state is at " + url +
              (url.ends_with('/') ? "healthz" : "/healthz")};
}

}  // namespace chorus::ctl
