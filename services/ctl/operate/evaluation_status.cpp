#include "services/ctl/operate/evaluation_status.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/http/status.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

/// The evaluation at the usual port of this host; null if nothing answers there.
nlohmann::json found_at(http::Url host) {
  constexpr http::ClientLimits kBriefly{1 << 20, std::chrono::milliseconds(500),
                                        std::chrono::seconds(1)};
  host.port = static_cast<std::uint16_t>(kEvaluationPort);
  http::ClientRequest request;
  request.target = "/evaluation";
  request.headers = {{"Accept", "application/json"}};
  const auto answer = client::fetch_trusted(host, request, kBriefly);
  if (!answer || answer->status != http::status::kOk) return {};
  auto read = nlohmann::json::parse(answer->body, nullptr, false);
  return read.is_object() ? read : nlohmann::json();
}

bool is_this_host(const std::string& host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

/// The client's words are of a tracker.
void name_evaluation(Error& error) {
  constexpr std::string_view kTracker = "chorus-fusion";
  if (const auto at = error.message.find(kTracker); at != std::string::npos)
    error.message.replace(at, kTracker.size(), "chorus-evaluation");
}

/// Whether an evaluation on the tracker's host that names its tracker so means this one.
bool judges(const nlohmann::json& evaluation, const http::Url& tracker) {
  const auto told = http::parse_url(client::text_at(evaluation, "tracker", ""));
  return told && told->port == tracker.port &&
         (told->host == tracker.host || is_this_host(told->host));
}

}  // namespace

Result<nlohmann::json> evaluation_of(const std::string& url, const client::ServiceClient& tracker,
                                     const std::string& tracker_url) {
  if (!url.empty()) {
    const auto service = client::ServiceClient::of(url);
    if (!service) return pass(service);
    auto told = service->get("/evaluation");
    if (!told) name_evaluation(told.error());
    return told;
  }
  if (auto relayed = tracker.get("/evaluation"); relayed && relayed->is_object()) return relayed;
  const auto own = http::parse_url(tracker_url);
  if (!own) return pass(own);
  auto found = found_at(*own);
  return judges(found, *own) ? std::move(found) : nlohmann::json();
}

std::string judged_limbs(const nlohmann::json& evaluation) {
  if (!evaluation.is_object()) return {};
  std::vector<std::string> off, others;
  std::size_t good = 0;
  for (const auto& limb : client::part_at(evaluation, "limbs")) {
    const std::string state = client::text_at(limb, "state");
    const std::string words = "  " + printable(client::text_at(limb, "comment")) + "\n";
    if (state == "good")
      ++good;
    else
      (state == "off" ? off : others).push_back(words);
  }
  std::string text =
      fmt::format("judged by worn sensors: {} limb{} agree{}, {} off, {} not judged\n", good,
                  good == 1 ? "" : "s", good == 1 ? "s" : "", off.size(), others.size());
  for (const auto& words : off) text += words;
  for (const auto& words : others) text += words;
  return text;
}

}  // namespace chorus::ctl
