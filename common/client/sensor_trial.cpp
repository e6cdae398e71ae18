#include "common/client/sensor_trial.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/base/json.h"
#include "common/base/shortened.h"
#include "common/base/strong_id.h"
#include "common/client/service_client.h"
#include "common/http/client.h"
#include "common/http/status.h"

namespace chorus::client {
namespace {

constexpr http::ClientLimits kTrialLimits{.max_body_bytes = 1u << 20,
                                          .connect_timeout = std::chrono::milliseconds(1500),
                                          .answer_timeout = std::chrono::milliseconds(2500)};
constexpr JsonLimits kTrialJson{1u << 20, 32};
constexpr std::size_t kTitle = 80;  // [bytes] of a stranger's title, which every page is shown

SensorTrial bad(std::string words) { return {false, std::move(words), {}}; }

/// What to do about an address at which nobody answers.
std::string unanswered(const http::Url& url, const Error& error) {
  const std::string where = fmt::format("{}:{}", url.host, url.port);
  if (error.message.find("refused") != std::string::npos)
    return fmt::format(
        "At {} no program listens: start chorus-sensor there, and mind its port "
        "(8081 unless it was changed) and that it listens to other hosts "
        "(http.bind).",
        where);
  if (error.code == ErrorCode::Timeout)
    return fmt::format(
        "{} does not answer in time: is the host switched on, in this network, and "
        "is the port open in its firewall?",
        where);
  return fmt::format("{} cannot be reached: {}.", where, error.message);
}

SensorTrial refused(int status, bool has_token) {
  if (status == http::status::kUnauthorized || status == http::status::kForbidden)
    return bad(has_token ? "The service there does not accept this token."
                         : "The service there asks for a token: chorus init printed it when it "
                           "wrote the sensor's configuration.");
  return bad(fmt::format("What is there answers with status {}: it is no Chorus sensor.", status));
}

struct Asking {
  http::Url url;
  http::ClientRequest request;
  tls::Trust trust;

  [[nodiscard]] Result<http::ClientResponse> get(const std::string& path) const {
    http::ClientRequest own = request;
    own.target = url.target + path;
    return http::fetch(url, own, kTrialLimits, trust);
  }
};

/// What its newest frame says, after the service has described itself as `title`.
SensorTrial with_frame(const Asking& asking, const std::string& title, SensorTrial trial) {
  const auto answer = asking.get("frame");
  if (!answer) return bad(unanswered(asking.url, answer.error()));
  if (answer->status == http::status::kUnauthorized || answer->status == http::status::kForbidden)
    return refused(answer->status, !asking.request.headers.empty());
  trial.good = true;
  if (answer->status != http::status::kOk) {
    trial.words = title + " is there, but has not delivered a frame yet.";
    return trial;
  }
  const auto frame = parse_json(answer->body, kTrialJson);
  const std::size_t bodies = frame ? part_at(*frame, "bodies").size() : 0;
  trial.words = bodies == 0   ? title + " is there and sees nobody now."
                : bodies == 1 ? title + " is there and sees one person."
                              : fmt::format("{} is there and sees {} people.", title, bodies);
  return trial;
}

/// A service puts its run into its ETags.
bool of_run(const http::ClientResponse& answer, const std::string& run) {
  const auto etag = answer.headers.find("etag");
  return !run.empty() && etag != answer.headers.end() &&
         etag->second.find(run) != std::string::npos;
}

}  // namespace

SensorTrial try_sensor(const std::string& url, const std::string& token, const tls::Trust& trust,
                       const std::string& own_run) {
  auto parsed = http::parse_url(url);
  if (!parsed)
    return bad(fmt::format("{}: an address looks like http://192.168.1.20:8081/.",
                           parsed.error().message));
  if (!parsed->target.ends_with('/')) parsed->target += '/';
  Asking asking{*parsed, {.headers = {{"Accept", "application/json"}}}, trust};
  if (!token.empty()) asking.request.headers.emplace_back("Authorization", "Bearer " + token);
  const auto answer = asking.get("");
  if (!answer) return bad(unanswered(asking.url, answer.error()));
  if (answer->status != http::status::kOk) return refused(answer->status, !token.empty());
  if (of_run(*answer, own_run))
    return bad("This is the address of this server itself: type that of a sensor.");
  const auto self = parse_json(answer->body, kTrialJson);
  if (!self || !self->is_object() || !self->contains("frame"))
    return bad(
        "What is there answers, but does not describe itself as a sensor: is the port right?");
  SensorTrial trial;
  if (const auto id = SensorId::parse(text_at(*self, "sensorId", ""))) trial.sensor_id = id->str();
  return with_frame(asking, shortened(text_at(*self, "title", "A sensor"), kTitle),
                    std::move(trial));
}

}  // namespace chorus::client
