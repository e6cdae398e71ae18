// chorus register: starts a registration session and stays until its verdict.
#include <chrono>
#include <iostream>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "fusion-server/client/service_client.h"
#include "fusion-server/rest/registration_resources.h"
#include "services/ctl/command.h"
#include "services/ctl/console.h"
#include "services/ctl/registration_report.h"
#include "services/ctl/server_option.h"

namespace chorus::ctl {
namespace {

constexpr std::chrono::milliseconds kAskEvery{250};
/// The server counts only time in which somebody is seen; after this long without any, nobody will
/// come.
constexpr std::chrono::seconds kPatience{60};

struct RegisterArguments {
  std::string url = client::kDefaultServer;
  double seconds = 30.0;  // a walk through a room, as in the guide
  bool fresh = false;
  bool json = false;
};

bool collecting(const nlohmann::json& registration) {
  return client::text_at(client::part_at(registration, "session"), "state") == "collecting";
}

/// Follows the session until it is idle again; every answer moves the bar.
Result<nlohmann::json> follow(const client::ServiceClient& server, const std::string& url) {
  Progress progress(std::cerr, on_terminal(), "walk through the room");
  auto last_step = std::chrono::steady_clock::now();
  double last_elapsed = -1.0;
  while (std::chrono::steady_clock::now() - last_step < kPatience) {
    const auto registration = server.get("/registration");
    if (!registration || !collecting(*registration)) {
      if (registration) progress.show(1.0, client::text_at(*registration, "verdict"));
      progress.finish();
      return registration;
    }
    const auto& session = client::part_at(*registration, "session");
    const double elapsed = client::number_at(session, "elapsedSeconds");
    const double target = client::number_at(session, "targetSeconds");
    if (elapsed > last_elapsed) last_step = std::chrono::steady_clock::now();
    last_elapsed = elapsed;
    progress.show(elapsed / (target > 0.0 ? target : 1.0),
                  client::text_at(*registration, "verdict"));
    std::this_thread::sleep_for(kAskEvery);
  }
  progress.finish();
  return fail(ErrorCode::Timeout, url,
              "no sensor has seen anybody for a minute; the session goes on.");
}

/// What the walk lacked when its result was not taken; the registration is then the one from
/// before.
bool print_shortcomings(const nlohmann::json& registration) {
  const auto& reasons = client::part_at(client::part_at(registration, "session"), "reasons");
  if (reasons.empty()) return false;
  std::cerr << "this walk was not good enough:\n";
  for (const auto& reason : reasons) {
    if (reason.is_string()) std::cerr << "  " << reason.get<std::string>() << '\n';
  }
  return true;
}

Result<int> run_register(const RegisterArguments& arguments) {
  const auto server = client::ServiceClient::of(arguments.url);
  if (!server) return pass(server);
  if (arguments.fresh) {
    if (const auto forgotten = server->remove("/registration"); !forgotten) return pass(forgotten);
  }
  const auto started = server->post("/registration", {{"seconds", arguments.seconds}});
  if (!started) return pass(started);
  const auto registration = follow(*server, arguments.url);
  if (!registration) return pass(registration);
  std::cout << (arguments.json ? registration->dump(2) + "\n" : registration_report(*registration));
  if (print_shortcomings(*registration)) return kExitFailed;
  const std::string verdict = client::text_at(*registration, "verdict");
  return verdict == "Good" || verdict == "Provisional" ? kExitOk : kExitFailed;
}

}  // namespace

Run add_register(CLI::App& options) {
  const auto arguments = std::make_shared<RegisterArguments>();
  add_server_option(options, arguments->url, "The fusion server");
  options.add_option("--seconds", arguments->seconds, "Length of the walk")
      ->check(CLI::Range(rest::kShortestSession, rest::kLongestSession))
      ->capture_default_str();
  options.add_flag("--fresh", arguments->fresh, "Forget the registration there is before starting");
  options.add_flag("--json", arguments->json, "Report as JSON");
  return [arguments] { return run_register(*arguments); };
}

}  // namespace chorus::ctl
