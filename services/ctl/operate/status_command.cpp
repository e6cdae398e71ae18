// chorus status: shows the sensors, registration and fused bodies of a fusion server, once.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "common/client/service_client.h"
#include "common/http/client.h"
#include "common/http/status.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/operate/evaluation_status.h"
#include "services/ctl/operate/events_report.h"
#include "services/ctl/operate/no_fusion_server.h"
#include "services/ctl/operate/registration_report.h"

namespace chorus::ctl {
namespace {

struct StatusArguments {
  std::string url = client::default_server();
  std::string evaluation;  ///< Empty: looked for on the server's host.
  bool json = false;
  bool events = false;
};

/// Where the sensor's clock offset is known from: the host's answers, a walk, how old its frames
/// are, or nothing.
std::string clock_source(const nlohmann::json& sensor) {
  if (sensor.contains("clockFromAgeMilliseconds")) return "age";
  if (sensor.contains("clockFromWalkMilliseconds")) return "walk";
  return sensor.contains("clockOffsetMilliseconds") ? "host" : "-";
}

/// A line about the sensors whose hosts say that their clock follows no other; empty if none does.
std::string host_clocks_line(const nlohmann::json& sensors) {
  std::vector<std::string> free;
  for (const auto& [name, sensor] : sensors.items()) {
    const auto synchronised = sensor.find("hostSynchronised");
    if (synchronised != sensor.end() && *synchronised == false) free.push_back(printable(name));
  }
  if (free.empty()) return {};
  return fmt::format(
      "{}: the clock of {} follows no other (no NTP, chrony or PTP); frames are corrected as the "
      "answers of {} tell\n",
      fmt::join(free, ", "), free.size() == 1 ? "its host" : "each host",
      free.size() == 1 ? "the host" : "the hosts");
}

std::string sensors_report(const nlohmann::json& sensors) {
  std::vector<std::vector<std::string>> rows{{"sensor", "state", "age [ms]", "rate [Hz]",
                                              "clock offset [ms]", "from", "bodies", "share",
                                              "url"}};
  for (const auto& [name, sensor] : sensors.items()) {
    rows.push_back({name, client::text_at(sensor, "state"),
                    shown(client::number_at(sensor, "ageMilliseconds"), 1),
                    shown(client::number_at(sensor, "rateHz"), 1),
                    shown(client::number_at(sensor, "clockOffsetMilliseconds"), 3),
                    clock_source(sensor), shown(client::number_at(sensor, "bodies"), 0),
                    shown(client::number_at(sensor, "share"), 2), client::text_at(sensor, "url")});
  }
  std::string text = rows.size() > 1 ? table(std::move(rows)) : "no sensors are configured\n";
  for (const auto& [name, sensor] : sensors.items()) {
    const std::string error = client::text_at(sensor, "lastError", "");
    if (!error.empty()) text += printable(name + ": " + error) + "\n";
  }
  std::set<std::string> contested;  // The same words stand with each sensor that sees the body.
  for (const auto& sensor : sensors) contested.insert(client::text_at(sensor, "contested", ""));
  for (const std::string& words : contested) {
    if (!words.empty()) text += "contested: " + printable(words) + "\n";
  }
  return text + host_clocks_line(sensors);
}

/// What the sensor's own service reports as wrong with its device; empty if nothing is wrong.
std::string own_words(const std::string& sensor_url) {
  constexpr http::ClientLimits kBriefly{1 << 16, std::chrono::seconds(1), std::chrono::seconds(1)};
  const auto url = http::parse_url(sensor_url);
  if (!url) return {};
  http::ClientRequest request;
  request.target = url->target + (url->target.ends_with('/') ? "healthz" : "/healthz");
  const auto answer = client::fetch_trusted(*url, request, kBriefly);
  if (!answer || answer->status < http::status::kBadRequest) return {};
  return client::text_at(nlohmann::json::parse(answer->body, nullptr, false), "detail", "");
}

/// Adds, for each sensor that answers the server but has no frames, the sensor's own reason.
void ask_the_silent(nlohmann::json& sensors) {
  for (auto& sensor : sensors) {
    const std::string error = client::text_at(sensor, "lastError", "");
    if (!error.starts_with("the sensor service answers")) continue;
    const std::string words = own_words(client::text_at(sensor, "url", ""));
    if (!words.empty()) sensor["lastError"] = error + ": " + words;
  }
}

bool any_live(const nlohmann::json& sensors) {
  return std::any_of(sensors.begin(), sensors.end(), [](const nlohmann::json& sensor) {
    return client::text_at(sensor, "state") == "live";
  });
}

std::string bodies_report(const nlohmann::json& frame) {
  const auto& bodies = client::part_at(frame, "bodies");
  std::string text = fmt::format("fused bodies: {}, captured {}\n", bodies.size(),
                                 printable(client::text_at(frame, "captured")));
  for (const auto& body : bodies) {
    const auto& head = client::part_at(client::part_at(body, "joints"), "Head");
    text +=
        fmt::format("  body {}: head at {} {} {}\n", shown(client::number_at(body, "bodyId"), 0),
                    shown(client::number_at(head, "x"), 3), shown(client::number_at(head, "y"), 3),
                    shown(client::number_at(head, "z"), 3));
  }
  return text;
}

/// A line for each inertial source: who wears it, what it knows, and what is amiss.
std::string inertial_report(const nlohmann::json& sources) {
  std::string text;
  for (const auto& [name, source] : sources.items()) {
    text += fmt::format("inertial {}: {}, {} Hz", printable(name), client::text_at(source, "state"),
                        shown(client::number_at(source, "rateHz"), 1));
    if (source.contains("wearer"))
      text += fmt::format(", worn by body {}, {} limbs known",
                          shown(client::number_at(source, "wearer"), 0),
                          lines_at(source, "knownLimbs").size());
    text += "\n";
    const std::string error = client::text_at(source, "lastError", "");
    if (!error.empty()) text += "  " + printable(error) + "\n";
    for (const std::string& reason : lines_at(source, "reasons"))
      text += "  " + printable(reason) + "\n";
  }
  return text;
}

/// What is amiss with the configuration; empty if nothing is, or if the server is too old to say.
std::string configuration_report(const nlohmann::json& told) {
  std::string text;
  const std::string error = client::text_at(told, "lastReloadError", "");
  if (!error.empty())
    text += "configuration: the last reload changed nothing: " + printable(error) + "\n";
  if (const auto keys = lines_at(told, "pendingRestart"); !keys.empty())
    text += fmt::format("configuration: {} wait{} for a restart\n", fmt::join(keys, ", "),
                        keys.size() == 1 ? "s" : "");
  if (const auto keys = lines_at(told, "changedOnDisk"); !keys.empty())
    text += fmt::format("configuration: {} differ{} in the file; a reload (SIGHUP) takes it\n",
                        fmt::join(keys, ", "), keys.size() == 1 ? "s" : "");
  return text;
}

/// A line for each output that is enabled.
std::string outputs_report(const nlohmann::json& told) {
  std::string text;
  for (const auto& [name, output] : client::part_at(told, "outputs").items()) {
    text += fmt::format("output {}: {}", printable(name), client::text_at(output, "state"));
    const std::string error = client::text_at(output, "lastError", "");
    if (!error.empty()) text += ": " + printable(error);
    text += fmt::format(", {} clients, {} frames, {} refused\n",
                        shown(client::number_at(output, "clients"), 0),
                        shown(client::number_at(output, "frames"), 0),
                        shown(client::number_at(output, "refused"), 0));
    const std::string refusal = client::text_at(output, "lastRefusal", "");
    if (!refusal.empty()) text += "  the last refusal: " + printable(refusal) + "\n";
  }
  return text;
}

/// What happened in the last day, instead of the state.
Result<int> run_events(const client::ServiceClient& server, const StatusArguments& arguments) {
  const auto told = server.get("/events");
  if (!told) return tl::unexpected<Error>(no_fusion_server(server, arguments.url, told.error()));
  std::cout << (arguments.json ? json_text(*told) : events_report(*told));
  return kExitOk;
}

/// Everything that is asked; what the server lacks is null.
struct Told {
  nlohmann::json sensors, registration, frame, configuration, outputs, evaluation, inertial;
};

Result<Told> asked(const client::ServiceClient& server, const StatusArguments& arguments) {
  const auto sensors = server.get("/sensors/");
  if (!sensors)
    return tl::unexpected<Error>(no_fusion_server(server, arguments.url, sensors.error()));
  auto registration = server.get("/registration");
  if (!registration) return pass(registration);
  auto evaluation = evaluation_of(arguments.evaluation, server, arguments.url);
  if (!evaluation) std::cerr << "note: " << printable(to_string(evaluation.error())) << '\n';
  Told told;
  told.sensors = client::part_at(*sensors, "sensors");
  ask_the_silent(told.sensors);
  told.registration = std::move(*registration);
  // Before the first fused frame the server answers with 503, which is a state, not a failure.
  told.frame = server.get("/frame").value_or(nlohmann::json());
  told.configuration = server.get("/configuration").value_or(nlohmann::json());
  told.outputs = server.get("/outputs/").value_or(nlohmann::json());
  told.evaluation = std::move(evaluation).value_or(nlohmann::json());
  // Older servers have no /inertial/.
  const nlohmann::json inertial = server.get("/inertial/").value_or(nlohmann::json());
  told.inertial = client::part_at(inertial, "inertialSources");
  return told;
}

Result<int> run_status(const StatusArguments& arguments) {
  const auto server = client::ServiceClient::of(arguments.url);
  if (!server) return pass(server);
  if (arguments.events) return run_events(*server, arguments);
  const auto told = asked(*server, arguments);
  if (!told) return pass(told);
  const bool alive = any_live(told->sensors);
  if (arguments.json) {
    nlohmann::json all{
        {"sensors", told->sensors},   {"registration", told->registration},
        {"frame", told->frame},       {"configuration", told->configuration},
        {"inertial", told->inertial}, {"outputs", client::part_at(told->outputs, "outputs")}};
    if (!told->evaluation.is_null()) all["evaluation"] = told->evaluation;
    std::cout << json_text(all);
  } else {
    std::cout << sensors_report(told->sensors) << registration_report(told->registration)
              << (told->frame.is_null() ? "no fused frame yet\n" : bodies_report(told->frame))
              << judged_limbs(told->evaluation) << inertial_report(told->inertial)
              << outputs_report(told->outputs) << configuration_report(told->configuration);
    if (!alive) std::cerr << "no sensor is live\n";
  }
  return alive ? kExitOk : kExitFailed;
}

}  // namespace

Run add_status(CLI::App& options) {
  const auto arguments = std::make_shared<StatusArguments>();
  add_server_option(options, arguments->url, "The fusion server", "url,--url");
  options
      .add_option(
          "--evaluation", arguments->evaluation,
          "The chorus-evaluation that judges it; otherwise the one that it relays, or at port "
          "8092 of its host")
      ->envname("CHORUS_EVALUATION_URL");
  options.add_flag("--json", arguments->json, "Report as JSON");
  options.add_flag("--events", arguments->events,
                   "What happened in the last day, and what to do about it, instead of the state");
  return [arguments] { return run_status(*arguments); };
}

}  // namespace chorus::ctl
