#include "services/ctl/operate/events_report.h"

#include <fmt/format.h>

#include "common/client/service_client.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {

std::string events_report(const nlohmann::json& told) {
  std::string text;
  for (const auto& event : client::part_at(told, "events")) {
    // To the second, as people read times.
    const std::string time = client::text_at(event, "time").substr(0, 19) + "Z";
    text += fmt::format("{}  {:<7}  {}\n", printable(time),
                        printable(client::text_at(event, "severity")),
                        printable(client::text_at(event, "message")));
    const std::string advice = client::text_at(event, "advice", "");
    if (!advice.empty()) text += fmt::format("{:>31}{}\n", "", printable(advice));
  }
  return text.empty() ? "nothing has happened in the last day\n" : text;
}

}  // namespace chorus::ctl
