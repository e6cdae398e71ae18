#include "services/ctl/operate/running_findings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/base/asked_program.h"
#include "common/client/service_client.h"
#include "common/http/status.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

constexpr int kNotInstalled = 127;

/// A JSON document of the running service; discarded if there is none.
nlohmann::json document_of(const ExaminedService& service, const std::string& path) {
  const auto answer = ask_service(service, path);
  const bool there = answer && answer->status == http::status::kOk;
  return nlohmann::json::parse(there ? answer->body : "", nullptr, false);
}

std::string trimmed_end(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

}  // namespace

Findings check_findings(const ExaminedService& service) {
  const std::string name = "chorus-" + service.kind;
  const auto asked =
      ask_program({sibling_program(name).string(), "--check", "--config", service.file});
  const std::string subject = "configuration of " + name;
  if (asked && asked->code == kNotInstalled) return {};
  if (!asked || asked->cut_short)
    return {{false, subject,
             "cannot be checked: " + (asked ? "it takes too long" : to_string(asked.error())),
             name + " --check --config " + service.file}};
  if (asked->code == 0) return {{true, subject, "is good"}};
  return {{false, subject, trimmed_end(asked->said),
           "mend " + service.file + "; " + name + " cannot start with it"}};
}

Findings configuration_findings(const ExaminedService& service) {
  const std::string name = "chorus-" + service.kind;
  const std::string subject = name + " as it runs";
  const auto told = document_of(service, "configuration");
  if (!told.is_object()) return {};
  const std::string error = client::text_at(told, "lastReloadError", "");
  if (!error.empty())
    return {{false, subject, "the last reload changed nothing: " + error,
             "mend it, then: systemctl reload " + name}};
  Findings all;
  if (const auto keys = lines_at(told, "pendingRestart"); !keys.empty())
    all.push_back({false, subject,
                   fmt::format("waits for a restart with {}", fmt::join(keys, ", ")),
                   "systemctl restart " + name});
  if (const auto keys = lines_at(told, "changedOnDisk"); !keys.empty())
    all.push_back(
        {false, subject,
         fmt::format("{} differs in the file from what is in force", fmt::join(keys, ", ")),
         "systemctl reload " + name});
  if (all.empty()) all.push_back({true, subject, "has what is in the file in force"});
  return all;
}

Findings followed_findings(const ExaminedService& service) {
  Findings all;
  if (service.kind != "fusion") return all;
  const auto told = document_of(service, "sensors/");
  if (!told.is_object()) return all;
  std::size_t live = 0;
  for (const auto& [id, sensor] : client::part_at(told, "sensors").items()) {
    const std::string state = client::text_at(sensor, "state");
    if (state == "live") ++live;
    if (state == "live") continue;
    const std::string error = client::text_at(sensor, "lastError", "");
    all.push_back({false, "sensor " + id + " as chorus-fusion sees it",
                   error.empty() ? state : state + ": " + error,
                   "mend what it names; the server tries again by itself"});
  }
  if (all.empty() && live > 0)
    all.push_back(
        {true, "sensors as chorus-fusion sees them", fmt::format("all {} are live", live)});
  return all;
}

}  // namespace chorus::ctl
