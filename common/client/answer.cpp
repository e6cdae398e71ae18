#include "common/client/answer.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/parse.h"
#include "common/http/status.h"
#include "common/resource/floor_plane_resource.h"

namespace chorus::client {
namespace {

constexpr Duration kMaxAhead = std::chrono::seconds(2);
constexpr Duration kMaxBehind = std::chrono::seconds(10);
constexpr std::size_t kMaxFloorBytes = 64u << 10;

std::string_view header(const http::ClientResponse& response, std::string_view name) {
  const auto it = response.headers.find(name);
  return it == response.headers.end() ? std::string_view{} : std::string_view(it->second);
}

std::string_view without_parameters(std::string_view content_type) {
  content_type = content_type.substr(0, content_type.find(';'));
  while (!content_type.empty() && content_type.back() == ' ') content_type.remove_suffix(1);
  return content_type;
}

std::optional<resource::Format> format_of(std::string_view content_type) {
  for (const resource::Format format : resource::kFormats) {
    if (resource::media_type(format) == content_type) return format;
  }
  return std::nullopt;
}

Event unreadable(ErrorCode code, std::string context, std::string message) {
  return Unreadable{Error{code, std::move(context), std::move(message)}};
}

}  // namespace

Answer read_answer(const http::ClientResponse& response, const DocumentKind& kind,
                   const SensorId& expected) {
  const std::string etag(header(response, "etag"));
  if (response.status != http::status::kOk) return {FrameAnswered{response.status, etag, {}}, {}};
  const std::string_view type = without_parameters(header(response, "content-type"));
  const auto format = format_of(type);
  if (!format || *format == resource::Format::NTriples) {
    return {unreadable(ErrorCode::Unsupported, std::string(kind.path),
                       "the content type is \"" + std::string(type.substr(0, 64)) +
                           "\", where a sensor sends text/turtle or application/json"),
            {}};
  }
  auto document = kind.read(response.body, *format, expected);
  if (!document) return {Unreadable{document.error()}, {}};
  return {FrameAnswered{http::status::kOk, etag, document->captured}, std::move(*document)};
}

Result<Document> read_event(std::string_view text, const DocumentKind& kind,
                            const SensorId& expected) {
  const bool json = text.starts_with('{');
  return kind.read(text, json ? resource::Format::Json : resource::Format::Turtle, expected);
}

Result<std::optional<FloorPlane>> read_floor_answer(const http::ClientResponse& response) {
  if (response.status != http::status::kOk) return std::nullopt;
  if (response.body.size() > kMaxFloorBytes)
    return fail(ErrorCode::TooLarge, "floor-plane", "is longer than any floor plane");
  const std::string_view type = without_parameters(header(response, "content-type"));
  const auto format = format_of(type);
  if (!format) {
    return fail(ErrorCode::Unsupported, "floor-plane",
                "the content type is \"" + std::string(type.substr(0, 64)) +
                    "\", where a sensor sends text/turtle or application/json");
  }
  const auto floor = resource::read_floor_plane(response.body, *format);
  if (!floor) return fail(floor.error().code, "floor-plane", to_string(floor.error()));
  return *floor;
}

std::optional<NtpStatus> read_clock_answer(const http::ClientResponse& response) {
  constexpr JsonLimits kClockLimits{4096, 4};
  if (response.status != http::status::kOk) return std::nullopt;
  const auto document = parse_json(response.body, kClockLimits);
  if (!document || !document->is_object()) return std::nullopt;
  const auto synchronised = document->find("synchronised");
  if (synchronised == document->end() || !synchronised->is_boolean()) return std::nullopt;
  const auto duration = [&](const char* key) {
    const auto found = document->find(key);
    if (found == document->end()) return Duration{0};
    if (found->is_number_integer()) return Duration(found->get<std::int64_t>());
    if (!found->is_string()) return Duration{0};
    std::string_view digits = found->get_ref<const std::string&>();
    return Duration(take_number<std::int64_t>(digits).value_or(0));
  };
  NtpStatus host;
  host.synchronised = synchronised->get<bool>();
  host.offset = duration("offsetNanoseconds");
  host.max_error = duration("maxErrorNanoseconds");
  host.est_error = duration("estimatedErrorNanoseconds");
  return host;
}

std::optional<ClockExchange> exchange_of(const http::ClientResponse& response) {
  const auto stamps = parse_server_stamps(header(response, "chorus-clock"));
  if (!stamps) return std::nullopt;
  return ClockExchange{from_unix_ns(response.sent_ns), stamps->receipt, stamps->sending,
                       from_unix_ns(response.received_ns)};
}

std::optional<Error> untimely(const Dated& document) {
  const Duration ahead = document.captured - document.received;
  if (ahead <= kMaxAhead && -ahead <= kMaxBehind) return std::nullopt;
  const bool future = ahead > Duration{0};
  std::array<char, 64> amount{};
  std::snprintf(amount.data(), amount.size(), "%.1f s %s", std::abs(seconds(ahead)),
                future ? "ahead of" : "behind");
  return Error{ErrorCode::InvalidArgument, "frame",
               "its capture time is " + std::string(amount.data()) +
                   " our clock; set the clock of the sensor's host, best by NTP"};
}

}  // namespace chorus::client
