#include "common/http/route_lines.h"

namespace chorus::http {

namespace {

/// What lets web pages of another origin read; browsers let none without it.
std::string sharing_lines(const std::string& origin) {
  if (origin.empty()) return {};
  return "Access-Control-Allow-Origin: " + origin +
         "\r\n"
         "Access-Control-Expose-Headers: ETag, Link, Location, Content-Location, Allow, "
         "Preference-Applied, Retry-After, Chorus-Clock, Server-Timing\r\n"
         "Timing-Allow-Origin: " +
         origin + "\r\n";
}

}  // namespace

std::string common_lines(const std::string& origin) {
  return "Vary: Accept, Accept-Encoding, Origin\r\n" + sharing_lines(origin) +
         "X-Content-Type-Options: nosniff\r\n"
         "Link: </openapi.json>; rel=\"service-desc\"\r\n";
}

std::string lines_of(const ServerConfig& config, const Router::Entry& entry) {
  std::string lines = "Allow: " + allowed_methods(entry) +
                      "\r\nLink: <http://www.w3.org/ns/ldp#Resource>; rel=\"type\"\r\n";
  if (!entry.shows_people) return lines + common_lines(config.allowed_origin);
  // Nor may a page show it in an element of its own, which needs no permission otherwise.
  lines += "Cross-Origin-Resource-Policy: same-origin\r\n";
  return lines + common_lines(config.allowed_origin == "*" ? "" : config.allowed_origin);
}

}  // namespace chorus::http
