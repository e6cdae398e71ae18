#include "services/ctl/setup/findings.h"

#include <pwd.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/base/file.h"
#include "common/base/json.h"
#include "common/base/version.h"
#include "common/client/service_client.h"
#include "common/http/client.h"
#include "common/http/status.h"
#include "common/tls/certificate.h"
#include "common/tls/credentials.h"

namespace chorus::ctl {
namespace {

constexpr http::ClientLimits kBrief{1 << 20, std::chrono::seconds(2), std::chrono::seconds(2)};
constexpr double kMostClockDifference = 20.0;  // [ms]; half a frame at 30 Hz is 17 ms.
constexpr double kLeastFree = 1024.0;          // [MB]: half an hour of six sensors.
constexpr double kBytesPerMb = 1e6;
constexpr double kNsPerMs = 1e6;

/// `trust` is for https:// services; without it, client::authorities() is used.
Result<http::ClientResponse> ask(const std::string& base, const std::string& path,
                                 const std::string& token,
                                 const std::optional<tls::Trust>& trust = {}) {
  const auto url = http::parse_url(base);
  if (!url) return pass(url);
  http::ClientRequest request;
  request.target = url->target + (url->target.ends_with('/') ? "" : "/") + path;
  request.headers = {{"Accept", "application/json, text/plain;q=0.5"}};
  if (!token.empty()) request.headers.emplace_back("Authorization", "Bearer " + token);
  if (trust) return http::fetch(*url, request, kBrief, *trust);
  return client::fetch_trusted(*url, request, kBrief);
}

/// The words of a problem document; without one, the bare status.
std::string words_of(const http::ClientResponse& answer) {
  const auto document = nlohmann::json::parse(answer.body, nullptr, false);
  return client::text_at(document, "detail", "status " + std::to_string(answer.status));
}

std::string text_in(const nlohmann::json& object, const char* key) {
  return client::text_at(object, key, "");
}

/// The folder, or the nearest parent folder that exists.
std::string existing(std::filesystem::path folder) {
  std::error_code ignored;
  while (folder.has_relative_path() && !std::filesystem::exists(folder, ignored))
    folder = folder.parent_path();
  return folder.empty() ? "." : folder.string();
}

Result<tls::CertificateFacts> facts_in(const std::string& file) {
  constexpr std::uintmax_t kMaxFileBytes = 1u << 20;
  const auto text = read_file(file, kMaxFileBytes);
  if (!text) return pass(text);
  return tls::facts_of(*text);
}

/// Whether a user may create files in a folder, by owner, group and mode.  A folder that does not
/// exist yet is made by the unit, and a host without that user has no unit: both are no obstacle.
bool may_write(const std::string& user, const std::string& folder) {
  const passwd* who = ::getpwnam(user.c_str());
  struct stat is {};
  if (who == nullptr || ::stat(folder.c_str(), &is) != 0) return true;
  if (is.st_uid == who->pw_uid) return (is.st_mode & S_IWUSR) != 0;
  if (is.st_gid == who->pw_gid) return (is.st_mode & S_IWGRP) != 0;
  return (is.st_mode & S_IWOTH) != 0;
}

Finding folder_finding(const std::string& what, const std::string& folder,
                       const std::string& user) {
  const std::string subject = what + " " + folder;
  struct statvfs disk {};
  if (::statvfs(existing(folder).c_str(), &disk) != 0)
    return {false, subject, "cannot be looked at", "name another folder in the configuration"};
  if (!may_write(user, folder))
    return {false, subject, "cannot be written to by the user " + user,
            "chown -R " + user + ": " + folder + ", or name another folder in the configuration"};
  const double free =
      static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize) / kBytesPerMb;
  if (free >= kLeastFree) return {true, subject, fmt::format("{:.0f} MB free", free)};
  return {false, subject, fmt::format("only {:.0f} MB free", free),
          "delete old recordings, or name a folder on another disk"};
}

/// The version in a line such as: chorus_build{version="0.1.0"} 1
std::string version_in(const std::string& metrics) {
  constexpr std::string_view kBefore = "chorus_build{version=\"";
  const std::size_t at = metrics.find(kBefore);
  if (at == std::string::npos) return {};
  const std::string rest = metrics.substr(at + kBefore.size());
  return rest.substr(0, rest.find('"'));
}

/// The sensor host's clock minus ours [ms], and its uncertainty: half of the round-trip time.
struct ClockDifference {
  double ms = 0.0;  ///< NaN when the host does not report its clock.
  double uncertainty = 0.0;
};

ClockDifference clock_difference(const http::ClientResponse& answer) {
  const auto document = nlohmann::json::parse(answer.body, nullptr, false);
  const std::string text = text_in(document, "nowNanoseconds");
  const double theirs = text.empty() ? client::number_at(document, "nowNanoseconds")
                                     : std::strtod(text.c_str(), nullptr);
  const auto sent = static_cast<double>(answer.sent_ns);
  const auto received = static_cast<double>(answer.received_ns);
  return {(theirs - (sent + received) / 2) / kNsPerMs, (received - sent) / 2 / kNsPerMs};
}

/// What the host says of its own clock.
std::string host_words(const http::ClientResponse& clock) {
  const auto document = nlohmann::json::parse(clock.body, nullptr, false);
  if (!document.is_object() || !document.contains("synchronised")) return {};
  if (document["synchronised"] != true)
    return " (follows no other clock; frames are corrected as its answers tell)";
  const std::string text = text_in(document, "maxErrorNanoseconds");
  const double most = text.empty() ? client::number_at(document, "maxErrorNanoseconds")
                                   : std::strtod(text.c_str(), nullptr);
  if (!std::isfinite(most)) return " (synchronised)";
  return fmt::format(" (synchronised, by its own account at most {:.1f} ms off)", most / kNsPerMs);
}

Finding of_answering(const std::string& subject, const std::string& url, const std::string& token,
                     const http::ClientResponse& clock, const tls::Trust& trust) {
  const auto [difference, uncertainty] = clock_difference(clock);
  if (std::abs(difference) - uncertainty > kMostClockDifference) {
    return {false, subject,
            fmt::format("its clock is {:.0f} ms {} ours", std::abs(difference),
                        difference > 0 ? "ahead of" : "behind"),
            "let chrony on both hosts follow the same server (docs/guide/workshop.md)"};
  }
  const auto metrics = ask(url, "metrics", token, trust);
  const std::string theirs = metrics ? version_in(metrics->body) : "";
  if (!theirs.empty() && theirs != version()) {
    return {false, subject, fmt::format("runs version {}, and this is {}", theirs, version()),
            "install the same packages on all hosts"};
  }
  return {true, subject,
          fmt::format("answers at {}, clock {:+.1f} ms{}", url, difference, host_words(clock))};
}

/// True if we refused the service's certificate (tls::Seal::failure); the message then says what to
/// do.
bool refuses_certificate(const Error& error) { return error.code == ErrorCode::Forbidden; }

Finding unreached(const std::string& subject, const Error& error) {
  if (refuses_certificate(error))
    return {false, subject, to_string(error),
            "chorus doctor on that host looks at its certificate"};
  return {false, subject, to_string(error),
          "is chorus-sensor running there (systemctl status chorus-sensor), does it listen on "
          "the network (http.address), does a firewall let its port through?"};
}

Finding sensor_finding(const nlohmann::json& sensor, const tls::Trust& trust) {
  const std::string subject = "sensor " + text_in(sensor, "id");
  const std::string url = text_in(sensor, "url");
  if (const auto parsed = http::parse_url(url); !parsed)
    return {false, subject, to_string(parsed.error()),
            "mend \"url\" of this sensor in the configuration, then reload"};
  const std::string token = text_in(sensor, "token");
  const auto clock = ask(url, "clock", token, trust);
  if (!clock) return unreached(subject, clock.error());
  if (clock->status == http::status::kUnauthorized) {
    return {false, subject, "does not take our token",
            "copy one of its http.tokens (role read) to \"token\" of this sensor, and reload"};
  }
  if (clock->status != http::status::kOk)
    return {false, subject, words_of(*clock),
            "is " + url +
                " where its chorus-sensor listens (http.port), and no other program? Then ask "
                "chorus doctor on that host"};
  return of_answering(subject, url, token, *clock, trust);
}

}  // namespace

std::uint16_t ExaminedService::port() const {
  const double port = client::number_at(client::part_at(config, "http"), "port");
  if (port > 0 && port <= 65535) return static_cast<std::uint16_t>(port);
  return kind == "sensor" ? 8081 : 8080;
}

std::string ExaminedService::url() const {
  std::string address = text_in(client::part_at(config, "http"), "address");
  if (address.empty() || address == "0.0.0.0" || address == "::") address = "127.0.0.1";
  const auto facts = facts_in(certificate());
  if (facts && !facts->names.empty() &&
      std::ranges::find(facts->names, address) == facts->names.end())
    address = facts->names.front();
  if (address.find(':') != std::string::npos) address = "[" + address + "]";
  return fmt::format("{}://{}:{}/", certificate().empty() ? "http" : "https", address, port());
}

std::string ExaminedService::certificate() const {
  return text_in(client::part_at(client::part_at(config, "http"), "tls"), "certificate");
}

std::string ExaminedService::read_token() const {
  const auto& section = client::part_at(config, "http");
  for (const auto& token : client::part_at(section, "tokens")) {
    if (!text_in(token, "token").empty()) return text_in(token, "token");
  }
  return text_in(section, "bearer_token");
}

Result<http::ClientResponse> ask_service(const ExaminedService& service, const std::string& path) {
  return ask(service.url(), path, service.read_token());
}

Result<ExaminedService> examined_service(const std::string& kind, const std::string& file) {
  constexpr std::uintmax_t kMaxFileBytes = 1u << 20;
  const auto text = read_file(file, kMaxFileBytes);
  if (!text) return pass(text);
  JsonLimits limits;
  limits.comments = true;
  auto config = parse_json(*text, limits);
  if (!config) return pass(config);
  if (!config->is_object()) return fail(ErrorCode::Malformed, file, "is no JSON object");
  return ExaminedService{kind, file, std::move(*config)};
}

Finding clock_finding(const NtpStatus& clock) {
  if (!clock.synchronised) {
    return {false, "clock", "is not synchronised",
            "apt install chrony; chronyc sources says what it follows (docs/guide/workshop.md)"};
  }
  return {true, "clock",
          fmt::format("synchronised, at most {:.1f} ms off",
                      static_cast<double>(clock.max_error.count()) / kNsPerMs)};
}

Finding health_finding(const ExaminedService& service) {
  const std::string subject = "chorus-" + service.kind;
  const auto answer = ask(service.url(), "healthz", "");
  if (!answer && refuses_certificate(answer.error()))
    return {false, subject, to_string(answer.error()),
            "does this host have the ca.crt of its authority in /etc/chorus/tls?"};
  if (!answer) {
    return {
        false, subject, "does not answer at " + service.url(),
        fmt::format("systemctl start {0}; journalctl -u {0} says why it does not stay", subject)};
  }
  if (answer->status == http::status::kOk) {
    const auto told = nlohmann::json::parse(answer->body, nullptr, false);
    const std::string warning = text_in(told, "warning");
    if (warning.empty()) return {true, subject, "answers at " + service.url()};
    return {false, subject, "answers, but " + warning, "chorus status says more"};
  }
  if (answer->status != http::status::kUnavailable)
    return {
        false, subject, fmt::format("{} answers otherwise: {}", service.url(), words_of(*answer)),
        fmt::format("systemctl restart {}; if this stays, another program has the port (ss -ltnp "
                    "sport = :{} names it): stop that, or set http.port",
                    subject, service.port())};
  return {false, subject, words_of(*answer),
          service.kind == "sensor" ? "is the device there, or the program that pushes frames?"
                                   : "the sensors below say more; then: chorus register"};
}

Finding token_finding(const ExaminedService& service) {
  const std::string subject = "token of chorus-" + service.kind;
  const std::string token = service.read_token();
  const auto answer = ask(service.url(), "clock", token);
  if (!answer)
    return {false, subject, "cannot be tried while the service does not answer", "see above"};
  if (answer->status == http::status::kOk) {
    return {true, subject, token.empty() ? "none is needed on this host" : "is taken"};
  }
  return {false, subject, words_of(*answer),
          fmt::format("the file and the running service differ: systemctl reload chorus-{}",
                      service.kind)};
}

Findings certificate_findings(const ExaminedService& service) {
  constexpr std::chrono::days kEarly{30};
  const std::string file = service.certificate();
  if (file.empty()) return {};
  const std::string subject = "certificate " + file;
  const std::string advice =
      "chorus init certificate NAME... --renew where the authority is, copy it here, then: "
      "systemctl reload chorus-" +
      service.kind;
  const auto facts = facts_in(file);
  if (!facts) return {{false, subject, facts.error().message, advice}};
  const auto now = std::chrono::system_clock::now();
  const std::string until = tls::date_text(facts->not_after);
  if (now > facts->not_after) return {{false, subject, "has expired on " + until, advice}};
  if (now < facts->not_before)
    return {{false, subject, "is not good before " + tls::date_text(facts->not_before),
             "set the clock of this host"}};
  if (now + kEarly > facts->not_after) return {{false, subject, "expires on " + until, advice}};
  return {
      {true, subject, fmt::format("good until {}, for {}", until, fmt::join(facts->names, ", "))}};
}

Findings disk_findings(const ExaminedService& service, const std::string& user) {
  Findings all;
  const std::string recordings = text_in(client::part_at(service.config, "recording"), "folder");
  if (!recordings.empty()) all.push_back(folder_finding("recordings", recordings, user));
  const std::string state = text_in(service.config, "state_dir");
  if (!state.empty() && state != "auto") all.push_back(folder_finding("state", state, user));
  return all;
}

Findings sensor_findings(const ExaminedService& service) {
  Findings all;
  if (service.kind != "fusion") return all;
  const std::string file = text_in(client::part_at(service.config, "poll"), "ca");
  const auto trust = tls::Trust::load(file);
  if (!trust) all.push_back({false, "poll.ca", to_string(trust.error()), "mend poll.ca"});
  for (const auto& sensor : client::part_at(service.config, "sensors"))
    all.push_back(sensor_finding(sensor, trust.value_or(tls::Trust())));
  if (all.empty())
    all.push_back({false, "sensors", "none is named in " + service.file,
                   "chorus init fusion --sensor ID=URL,TOKEN"});
  return all;
}

}  // namespace chorus::ctl
