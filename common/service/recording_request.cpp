#include "common/service/recording_request.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/record/recording_index.h"

namespace chorus::service {
namespace {

constexpr double kLongest = 7 * 24 * 3600.0;  // [s]

tl::unexpected<Error> wrong(std::string message) {
  return fail(ErrorCode::InvalidArgument, "recordings", std::move(message));
}

/// Takes one key from the body of a POST.
Result<void> take(const std::string& key, const nlohmann::json& value, RecordingRequest& out) {
  if (key == "name") {
    if (!value.is_string()) return wrong("\"name\" is a text");
    out.name = value.get<std::string>();
    // A name that begins with - would be an option to every command that gets it.
    if (record::is_recording_name(out.name) && !out.name.starts_with('-')) return {};
    return wrong("a \"name\" has 1 to 64 characters of A-Z a-z 0-9 _ -, the first no -");
  }
  if (key == "seconds") {
    if (!value.is_number()) return wrong("\"seconds\" is a number");
    const double length = value.get<double>();
    if (!(length >= 1.0 && length <= kLongest)) return wrong("\"seconds\" is from 1 to 604800");
    out.duration = from_seconds(length);
    return {};
  }
  if (key == "raw" || key == "fused") {
    if (!value.is_boolean()) return wrong("\"" + key + "\" is true or false");
    (key == "raw" ? out.raw : out.fused) = value.get<bool>();
    return {};
  }
  return wrong("\"" + key +
               "\" is not one of: \"name\" (text), \"seconds\" (number), \"raw\" and "
               "\"fused\" (true or false)");
}

}  // namespace

Result<RecordingRequest> parse_recording_request(std::string_view body, bool has_fused) {
  RecordingRequest request;
  request.fused = has_fused;
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) return request;
  constexpr JsonLimits kLimits{4096, 4};
  const auto json = parse_json(body, kLimits);
  if (!json || !json->is_object()) {
    const std::string reason = json ? "" : "; " + to_string(json.error());
    return wrong("send a JSON object, such as {\"seconds\": 60}" + reason);
  }
  for (const auto& [key, value] : json->items()) {
    if (auto ok = take(key, value, request); !ok) return pass(ok);
  }
  if (request.fused && !has_fused) return wrong("a sensor has no fused frames to record");
  if (!request.raw && !request.fused)
    return wrong("neither raw nor fused frames are to be recorded");
  return request;
}

}  // namespace chorus::service
