#include "common/http/route_lines.h"

namespace chorus::http {

namespace {

/// The CORS lines that let web pages of `origin` read the answers; without them browsers refuse.
std::string sharing_lines(const std::string& origin, const AnswerPolicy& policy) {
  if (origin.empty()) return {};
  const std::string clock = policy.clock_field.empty() ? "" : policy.clock_field + ", ";
  return "Access-Control-Allow-Origin: " + origin +
         "\r\n"
         "Access-Control-Expose-Headers: ETag, Link, Location, Content-Location, Allow, "
         "Preference-Applied, Retry-After, " +
         clock +
         "Server-Timing\r\n"
         "Timing-Allow-Origin: " +
         origin + "\r\n";
}

std::string lines_for(const std::string& origin, const AnswerPolicy& policy) {
  return "Vary: Accept, Accept-Encoding, Origin\r\n" + sharing_lines(origin, policy) +
         "X-Content-Type-Options: nosniff\r\n" + policy.lines;
}

}  // namespace

std::string common_lines(const ServerConfig& config) {
  return lines_for(config.allowed_origin, config.policy);
}

std::string lines_of(const ServerConfig& config, const Router::Entry& entry) {
  std::string lines = "Allow: " + allowed_methods(entry) + "\r\n" + config.policy.resource_lines;
  if (!entry.shows_people) return lines + common_lines(config);
  // A foreign page must not embed the resource in an element either, which needs no permission by
  // default.
  lines += "Cross-Origin-Resource-Policy: same-origin\r\n";
  return lines +
         lines_for(config.allowed_origin == "*" ? "" : config.allowed_origin, config.policy);
}

}  // namespace chorus::http
