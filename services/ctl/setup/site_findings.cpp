#include "services/ctl/setup/site_findings.h"

#include <fmt/format.h>

#include "common/client/service_client.h"
#include "common/http/status.h"

namespace chorus::ctl {
namespace {

bool flag_at(const nlohmann::json& object, const char* key) {
  const auto it = object.is_object() ? object.find(key) : object.end();
  return it != object.end() && it->is_boolean() && it->get<bool>();
}

Finding cell_finding(const std::string& name, const nlohmann::json& cell) {
  const std::string subject = "cell " + name;
  const std::string state = client::text_at(cell, "state", "");
  if (!flag_at(cell, "placed"))
    return {false, subject, "has no place in the site, so nobody of it is recognised elsewhere",
            "name the file of places (site.places) in its fusion.json; docs/guide/hall.md"};
  if (state == "silent")
    return {false, subject, "says nothing", "chorus doctor on its host says why"};
  if (state == "mistrusted")
    return {false, subject, "says what contradicts what others see",
            "was it moved? find its place again; docs/guide/hall.md"};
  return {true, subject, state == "own" ? "is this one, and has a place" : "is heard"};
}

}  // namespace

Findings site_findings_of(const nlohmann::json& cells) {
  const std::string subject = "site " + client::text_at(cells, "siteName", "");
  if (!flag_at(cells, "connected")) {
    const std::string trouble = client::text_at(cells, "trouble", "");
    return {{false, subject,
             "is not connected: " + (trouble.empty() ? "no server answers" : trouble),
             "systemctl status chorus-site on the server's host; site.servers, user, password and "
             "ca in fusion.json"}};
  }
  Findings all{{true, subject, "is connected by " + client::text_at(cells, "server", "")}};
  const auto list = cells.find("siteCells");
  if (list == cells.end() || !list->is_object()) return all;
  for (const auto& [name, cell] : list->items()) all.push_back(cell_finding(name, cell));
  return all;
}

Findings site_findings(const ExaminedService& service) {
  const auto section = service.config.find("site");
  if (service.kind != "fusion" || section == service.config.end() ||
      client::text_at(*section, "name", "").empty())
    return {};
  const std::string subject = "site " + client::text_at(*section, "name", "");
  const auto answer = ask_service(service, "site/cells/");
  if (!answer) return {};  // health_finding() says that the service does not answer.
  if (answer->status == http::status::kNotFound)
    return {{false, subject, "is in the file, but not in the running service",
             "systemctl restart chorus-fusion"}};
  const auto cells = nlohmann::json::parse(answer->body, nullptr, false);
  if (answer->status != http::status::kOk || !cells.is_object())
    return {{false, subject, "cannot be asked yet", "do its sensors deliver frames?"}};
  return site_findings_of(cells);
}

}  // namespace chorus::ctl
