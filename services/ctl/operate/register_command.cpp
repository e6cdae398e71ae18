// chorus register: starts a registration session, or joins the running one, and follows it until
// its verdict.
#include <chrono>
#include <cmath>
#include <csignal>
#include <iostream>
#include <map>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "common/base/units.h"
#include "common/client/service_client.h"
#include "fusion-server/wire/session_limits.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/operate/registration_report.h"

namespace chorus::ctl {
namespace {

using client::part_at;
using client::ServiceClient;
using client::text_at;

constexpr std::chrono::milliseconds kAskEvery{250};
/// The server counts only the time in which somebody is seen.  If nobody is seen for this long, we
/// give up.
constexpr std::chrono::seconds kPatience{60};

struct RegisterArguments {
  std::string url = client::default_server();
  double seconds = 30.0;  // a walk through a room, as in the guide
  bool fresh = false;
  bool cancel = false;
  bool propose = false;
  bool accept = false;
  bool decline = false;
  bool undo = false;
  bool history = false;
  bool json = false;
};

volatile std::sig_atomic_t ctrl_c_seen = 0;

/// While it lives, Ctrl-C is noted; a second one ends the program at once.
class CtrlC {
 public:
  CtrlC() {
    ctrl_c_seen = 0;
    struct sigaction wanted {};
    wanted.sa_handler = [](int) { ctrl_c_seen = 1; };
    wanted.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(SIGINT, &wanted, &before_);
  }
  ~CtrlC() { ::sigaction(SIGINT, &before_, nullptr); }
  CtrlC(const CtrlC&) = delete;
  CtrlC& operator=(const CtrlC&) = delete;
  [[nodiscard]] static bool seen() { return ctrl_c_seen != 0; }

 private:
  struct sigaction before_ {};
};

/// The path that shows the progress of the newest session in this /registration document; NotFound
/// when it names none.
Result<std::string> session_of(const nlohmann::json& registration, const std::string& url) {
  std::string path = text_at(part_at(registration, "session"), "progress", "");
  if (path.starts_with('/')) return path;
  return fail(ErrorCode::NotFound, url, "names no registration session. Is it an older server?");
}

bool idle(const nlohmann::json& registration) {
  return text_at(part_at(registration, "session"), "state", "idle") == "idle";
}

/// Starts a session, or joins one that is already running.
Result<std::string> start(const ServiceClient& server, const RegisterArguments& arguments) {
  nlohmann::json wish{{"seconds", arguments.seconds}};
  if (arguments.propose) wish["adopt"] = "when-accepted";
  const auto started = server.post("/registration", wish);
  if (started) return session_of(*started, arguments.url);
  if (started.error().code != ErrorCode::Conflict) return pass(started);
  const auto registration = server.get("/registration");
  if (!registration) return pass(registration);
  // The request was refused for another reason, or the session has just ended.
  if (idle(*registration)) return pass(started);
  std::cerr << "a session is running already; this is its progress "
               "(chorus register --cancel ends it)\n";
  return session_of(*registration, arguments.url);
}

/// Says what a walk of this length cannot reach, before it is walked.
void tell_of_short_walk(const ServiceClient& server, double seconds) {
  const auto configuration = server.get("/configuration");
  if (!configuration) return;  // An older server does not say.
  const auto& registration = part_at(part_at(*configuration, "inForce"), "registration");
  constexpr double kUsual = 20.0;  // RegistrationConfig::good_duration
  const double told = client::number_at(registration, "good_duration_s");
  const double good = std::isfinite(told) ? told : kUsual;
  if (seconds >= good) return;
  std::cerr << fmt::format(
      "a walk of {:.0f} s gives places to sensors that have none, and makes none worse, but cannot "
      "become Good: that takes {:.0f} s (--seconds)\n",
      seconds, good);
}

/// Prints what is missing whenever that changes.  The bar shows how long the person still has to
/// walk.
class Advice {
 public:
  void tell(const nlohmann::json& session, Progress& progress) {
    std::string next;
    for (const std::string& line : lines_at(session, "awaits")) {
      if (!line.starts_with("keep walking")) next += "  " + line + "\n";
    }
    if (next == told_) return;
    told_ = next;
    progress.finish();
    std::cerr << next;
  }

 private:
  std::string told_;
};

/// "Provisional, worst s3 41 mm of 30": how well the last solve places the sensors.
std::string remark_of(const nlohmann::json& session) {
  std::string text = text_at(session, "verdict");
  double worst = 0.0;
  std::string name;
  for (const auto& own : part_at(session, "accuracy")) {
    const double radius = client::number_at(own, "expectedRadius");
    if (std::isfinite(radius) && radius <= worst) continue;
    worst = radius;
    name = text_at(own, "sensorId");
    if (!std::isfinite(radius)) break;
  }
  if (name.empty()) return text;
  if (!std::isfinite(worst)) return fmt::format("{}, {} has no place yet", text, printable(name));
  text += fmt::format(", worst {} {:.0f} mm", printable(name), to_mm(worst));
  const double target = client::number_at(session, "targetRadius");
  return std::isfinite(target) ? text + fmt::format(" of {:.0f}", to_mm(target)) : text;
}

/// Follows one session to its end, or until Ctrl-C; every answer updates the bar.
Result<nlohmann::json> follow(const ServiceClient& server, const std::string& path,
                              const std::string& url) {
  Progress progress(std::cerr, on_terminal(), "walk through the room");
  Advice advice;
  auto last_step = std::chrono::steady_clock::now();
  double last_elapsed = -1.0;
  while (std::chrono::steady_clock::now() - last_step < kPatience) {
    const auto session = server.get(path);
    if (!session) return pass(session);
    const std::string state = text_at(*session, "state");
    const bool over = state == "done" || state == "cancelled";
    if (over) progress.show(1.0, state == "done" ? text_at(*session, "verdict") : state);
    if (over || CtrlC::seen()) {
      progress.finish();
      return session;
    }
    const double elapsed = client::number_at(*session, "elapsedSeconds");
    const double target = client::number_at(*session, "targetSeconds");
    if (elapsed > last_elapsed || state == "solving") last_step = std::chrono::steady_clock::now();
    last_elapsed = elapsed;
    progress.show(elapsed / (target > 0.0 ? target : 1.0),
                  state == "solving" ? state : remark_of(*session));
    advice.tell(*session, progress);
    std::this_thread::sleep_for(kAskEvery);
  }
  progress.finish();
  return fail(ErrorCode::Timeout, url,
              "no sensor has seen anybody for a minute; the session goes on (chorus register joins "
              "it, chorus register --cancel ends it)");
}

/// What the proposed registration would change, and how to decide.
std::string proposal_report(const nlohmann::json& proposal) {
  std::vector<std::vector<std::string>> rows{
      {"sensor", "95 % now [mm]", "95 % then [mm]", "moves [mm]", "turns [deg]"}};
  for (const auto& change : part_at(proposal, "changes")) {
    const auto millimetres = [&](const char* key) {
      return shown(to_mm(client::number_at(change, key)), 0);
    };
    rows.push_back({text_at(change, "sensorId"), millimetres("presentRadius"),
                    millimetres("expectedRadius"), millimetres("moves"),
                    shown(client::number_at(change, "turnsDegrees"), 1)});
  }
  std::string reasons;
  for (const std::string& reason : lines_at(proposal, "reasons"))
    reasons += "  " + printable(reason) + "\n";
  return fmt::format(
      "proposed, not in use: {}\n{}{}chorus register --accept puts it into use, chorus register "
      "--decline keeps what was\n",
      text_at(proposal, "verdict"), reasons, table(std::move(rows)));
}

/// Whether this session's result waits to be accepted.
bool proposed_by(const nlohmann::json& session, const nlohmann::json& registration) {
  const double waiting = client::number_at(part_at(registration, "proposal"), "sessionId");
  return waiting == client::number_at(session, "sessionId");
}

/// The sensors that are refused or have no place, each with the reason.  Of a proposal: those that
/// the session could not place.
std::map<std::string, std::string> left_out(const nlohmann::json& session,
                                            const nlohmann::json& registration, bool proposed) {
  const auto reason = [](const nlohmann::json& sensor) {
    const std::string why = fmt::format("{}", fmt::join(lines_at(sensor, "reasons"), "; "));
    return why.empty() ? std::string("the walk does not tell where it stands") : why;
  };
  std::map<std::string, std::string> out;
  const auto& placed = part_at(registration, "sensors");
  if (!proposed) {
    for (const auto& [name, sensor] : part_at(registration, "unplaced").items())
      out.emplace(name, reason(sensor));
    for (const auto& [name, sensor] : placed.items()) {
      if (text_at(sensor, "verdict") == "Refused") out.emplace(name, reason(sensor));
    }
  }
  // A session states no radius for a sensor without a place.
  for (const auto& own : part_at(session, "accuracy")) {
    const std::string name = text_at(own, "sensorId");
    if (std::isfinite(client::number_at(own, "expectedRadius"))) continue;
    if (proposed || !placed.contains(name)) out.emplace(name, reason(session));
  }
  return out;
}

/// Reports the session's own verdict; a registration that was in use before does not count.
int report(const nlohmann::json& session, const nlohmann::json& registration, bool json) {
  const std::string verdict = text_at(session, "verdict");
  const auto adopted = session.find("adopted");
  const bool in_use = adopted != session.end() && adopted->is_boolean() && adopted->get<bool>();
  const bool done = text_at(session, "state") == "done";
  const bool waits = done && proposed_by(session, registration);
  const bool good = waits || (done && in_use && (verdict == "Good" || verdict == "Provisional"));
  if (json) {
    nlohmann::json whole = session;
    whole["registration"] = registration;
    std::cout << json_text(whole);
  } else {
    if (!good) {
      std::cerr << (done ? "this walk was not good enough:\n" : "the session ended early:\n");
      for (const std::string& reason : lines_at(session, "reasons"))
        std::cerr << "  " << reason << '\n';
    }
    std::cout << (waits ? proposal_report(part_at(registration, "proposal"))
                        : registration_report(registration));
  }
  if (!good) return kExitFailed;
  const auto missing = left_out(session, registration, waits);
  for (const auto& [name, reason] : missing)
    std::cerr << fmt::format("{} has no place: {}\n", printable(name), reason);
  return missing.empty() ? kExitOk : kExitFailed;
}

Result<int> print_json(const Result<nlohmann::json>& document) {
  if (!document) return pass(document);
  std::cout << json_text(*document);
  return kExitOk;
}

/// The last few sessions, newest first, and what became of each.
Result<int> history(const ServiceClient& server, bool json) {
  const auto registration = server.get("/registration");
  if (!registration) return pass(registration);
  nlohmann::json sessions = nlohmann::json::array();
  for (const std::string& path : lines_at(*registration, "sessions")) {
    auto session = server.get(path);
    if (session)
      sessions.push_back(std::move(*session));
    else if (session.error().code != ErrorCode::NotFound)
      return pass(session);  // Unless it was dropped to make room for newer ones.
  }
  if (json) return print_json(sessions);
  std::vector<std::vector<std::string>> rows{
      {"session", "started", "by", "walked [s]", "state", "verdict", "adopted", "reasons"}};
  for (const auto& session : sessions) {
    const auto said = [&](const char* key) {
      return session.contains(key) && session.at(key) == true;
    };
    rows.push_back({shown(client::number_at(session, "sessionId"), 0), text_at(session, "started"),
                    said("automatic") ? "itself" : "hand",
                    shown(client::number_at(session, "elapsedSeconds"), 0),
                    text_at(session, "state"), text_at(session, "verdict"),
                    said("adopted") ? "yes" : "no",
                    fmt::format("{}", fmt::join(lines_at(session, "reasons"), "; "))});
  }
  std::cout << (rows.size() > 1 ? table(std::move(rows)) : "no session since the server started\n");
  return kExitOk;
}

Result<int> cancel(const ServiceClient& server, const RegisterArguments& arguments) {
  const auto registration = server.get("/registration");
  if (!registration) return pass(registration);
  if (idle(*registration)) {
    return fail(ErrorCode::NotFound, arguments.url, "no registration session runs");
  }
  const auto path = session_of(*registration, arguments.url);
  if (!path) return pass(path);
  if (const auto cancelled = server.remove(*path); !cancelled) return pass(cancelled);
  if (arguments.json) return print_json(server.get(*path));
  std::cout << "cancelled; the registration is what it was before the session\n";
  return kExitOk;
}

Result<int> undo(const ServiceClient& server, bool json) {
  const auto registration = server.post("/registration/undo", nlohmann::json::object());
  if (!registration || json) return print_json(registration);
  std::cout << "the registration from before the last change is in use again, with its origin; the "
               "same command brings the other one back\n"
            << registration_report(*registration);
  return kExitOk;
}

/// Accepts or declines the proposed registration.
Result<int> decide(const ServiceClient& server, const RegisterArguments& arguments) {
  const char* path = arguments.accept ? "/registration/accept" : "/registration/decline";
  const auto registration = server.post(path, nlohmann::json::object());
  if (!registration || arguments.json) return print_json(registration);
  std::cout << (arguments.accept ? "the proposed registration is in use; chorus register --undo "
                                   "goes back to the one before\n"
                                 : "declined; the registration from before stays in use\n")
            << registration_report(*registration);
  return kExitOk;
}

Result<int> run_register(const RegisterArguments& arguments) {
  const auto server = ServiceClient::of(arguments.url);
  if (!server) return pass(server);
  if (arguments.cancel) return cancel(*server, arguments);
  if (arguments.accept || arguments.decline) return decide(*server, arguments);
  if (arguments.undo) return undo(*server, arguments.json);
  if (arguments.history) return history(*server, arguments.json);
  if (arguments.fresh) {
    if (const auto forgotten = server->remove("/registration"); !forgotten) return pass(forgotten);
  }
  const CtrlC ctrl_c;
  const auto path = start(*server, arguments);
  if (!path) return pass(path);
  tell_of_short_walk(*server, arguments.seconds);
  const auto session = follow(*server, *path, arguments.url);
  if (!session) return pass(session);
  const std::string state = text_at(*session, "state");
  if (CtrlC::seen() && state != "done" && state != "cancelled") {
    std::cerr << "the session goes on without this command (chorus register joins it, chorus "
                 "register --cancel ends it)\n";
    return kExitInterrupted;
  }
  const auto registration = server->get("/registration");
  if (!registration) return pass(registration);
  return report(*session, *registration, arguments.json);
}

}  // namespace

Run add_register(CLI::App& options) {
  const auto arguments = std::make_shared<RegisterArguments>();
  add_server_option(options, arguments->url, "The fusion server", "url,--url");
  options.add_option("--seconds", arguments->seconds, "Length of the walk")
      ->check(number_range(wire::kMinSession, wire::kMaxSession))
      ->capture_default_str();
  auto* propose = options.add_flag(
      "--propose", arguments->propose,
      "Leave the registration in use as it is until the new one is accepted (--accept, --decline)");
  std::vector<CLI::Option*> apart{
      options.add_flag("--fresh", arguments->fresh,
                       "Forget the registration there is before starting; its world stays where it "
                       "is, as far as the same sensors are found again"),
      options.add_flag("--accept", arguments->accept, "Put the proposed registration into use"),
      options.add_flag("--decline", arguments->decline,
                       "Forget the proposed registration; the one in use stays"),
      options.add_flag("--cancel", arguments->cancel,
                       "End the session that runs; the registration is then what it was before"),
      options.add_flag("--undo", arguments->undo,
                       "Go back one step: to the registration and the origin before the last "
                       "change; again: forward to those of now"),
      options.add_flag("--history", arguments->history,
                       "List the last sessions since the server started, and start none")};
  for (std::size_t i = 0; i < apart.size(); ++i) {
    apart[i]->excludes(propose);
    for (std::size_t j = 0; j < i; ++j) apart[i]->excludes(apart[j]);
  }
  options.add_flag("--json", arguments->json, "Report as JSON");
  return [arguments] { return run_register(*arguments); };
}

}  // namespace chorus::ctl
