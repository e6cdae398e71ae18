#include "common/http/route_lines.h"

namespace chorus::http {

std::string common_lines(const ServerConfig& config) {
  return "Vary: Accept, Origin\r\n"
         "Access-Control-Allow-Origin: " +
         config.allowed_origin +
         "\r\n"
         "Access-Control-Expose-Headers: ETag, Link, Location, Content-Location, Allow, "
         "Preference-Applied, Retry-After, Chorus-Clock, Server-Timing\r\n"
         "Timing-Allow-Origin: *\r\n"
         "X-Content-Type-Options: nosniff\r\n"
         "Link: </openapi.json>; rel=\"service-desc\"\r\n";
}

std::string lines_of(const ServerConfig& config, const Router::Entry& entry) {
  return "Allow: " + allowed_methods(entry) +
         "\r\nLink: <http://www.w3.org/ns/ldp#Resource>; rel=\"type\"\r\n" + common_lines(config);
}

}  // namespace chorus::http
