// chorus origin: sets the origin of the world, by numbers or by a person who stands there.
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/json.h"
#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/http/client.h"
#include "fusion-server/client/live_poll.h"
#include "fusion-server/client/service_client.h"
#include "services/ctl/command.h"
#include "services/ctl/console.h"
#include "services/ctl/number_range.h"
#include "services/ctl/registration_report.h"
#include "services/ctl/server_option.h"
#include "services/ctl/stance.h"

namespace chorus::ctl {
namespace {

using client::ServiceClient;

constexpr double kFarthest = 1000.0;  // [m], the limit that the server has

struct OriginArguments {
  std::string url = client::default_server();
  double x = 0.0;
  double z = 0.0;
  double yaw = 0.0;
  bool here = false;
  bool set = false;  ///< An origin is given in one of the two ways.
  double seconds = 2.0;
  bool json = false;
};

/// Watches the person who stands where the origin is to be, on one connection: each frame once, as
/// it comes.
class StanceWatch {
 public:
  StanceWatch(const http::Url& server, tls::Trust trust)
      : poll_(io_, server, {"/frame", "application/json", {}, std::move(trust)},
              {[this](const http::ClientResponse& answer) { take(answer); },
               [this](const Error& error, int status) { failed(error, status); }}) {}

  Result<Stance> run(double seconds) {
    poll_.start();
    io_.run_for(from_seconds(seconds));
    poll_.stop();
    if (failure_) return tl::unexpected<Error>(*failure_);
    return steady(seen_);
  }

 private:
  void take(const http::ClientResponse& answer) {
    const auto frame = parse_json(answer.body, {.bytes = answer.body.size()});
    if (!frame) return end_with(frame.error());
    // A server without ETags may send the same frame again.
    const std::string captured = client::text_at(*frame, "captured");
    if (std::exchange(newest_, captured) == captured) return;
    const auto stance = stance_in(*frame);
    if (!stance) return end_with(stance.error());
    seen_.push_back(*stance);
  }
  void failed(Error error, int status) {
    if (status == 0) error.message += "; is chorus-fusion running there?";
    end_with(std::move(error));
  }
  void end_with(Error why) {
    if (!failure_) failure_ = std::move(why);
    io_.stop();
  }

  asio::io_context io_{1};
  client::LivePoll poll_;
  std::string newest_;
  std::vector<Stance> seen_;
  std::optional<Error> failure_;
};

Result<Stance> watch(const std::string& server, double seconds) {
  const auto url = http::parse_url(server);
  if (!url) return pass(url);
  auto trust = client::authorities();
  if (!trust) return pass(trust);
  return StanceWatch(*url, std::move(*trust)).run(seconds);
}

/// Where the master stands in the world.  An origin at this place, with this yaw, gives the world
/// that a fresh walk would give.
Stance place_of(const nlohmann::json& sensor) {
  const Eigen::Quaterniond q(client::number_at(sensor, "qw"), client::number_at(sensor, "qx"),
                             client::number_at(sensor, "qy"), client::number_at(sensor, "qz"));
  return {client::number_at(sensor, "x"), client::number_at(sensor, "z"),
          q.coeffs().allFinite() ? yaw_of(normalised_or_identity(q).toRotationMatrix()) : 0.0};
}

/// Where the world begins now, in terms of the master sensor, and how to change that.
std::string origin_report(const nlohmann::json& registration) {
  const std::string master = client::text_at(registration, "master", "");
  const auto& sensors = client::part_at(registration, "sensors");
  if (master.empty() || !sensors.contains(master))
    return "the world has no origin yet: no sensor is registered (chorus register)\n";
  const Stance own = place_of(client::part_at(sensors, master.c_str()));
  const std::string name = printable(master);
  return fmt::format(
      "the world begins where x and z are 0: there the master, {}, stands at x {} m, z {} m, and "
      "looks {} deg away from the front\n"
      "to change it: chorus origin --here, or --x, --z, --yaw; back to below {}, in its "
      "direction: chorus origin --x={} --z={} --yaw={}\n",
      name, shown(own.x, 3), shown(own.z, 3), shown(to_deg(own.yaw), 1), name, shown(own.x, 4),
      shown(own.z, 4), shown(to_deg(own.yaw), 2));
}

/// Without an origin to set: shows the present one.
Result<int> show_origin(const ServiceClient& server, bool json) {
  const auto registration = server.get("/registration");
  if (!registration) return pass(registration);
  std::cout << (json ? json_text(*registration) : origin_report(*registration));
  return kExitOk;
}

Result<int> run_origin(const OriginArguments& arguments) {
  const auto server = ServiceClient::of(arguments.url);
  if (!server) return pass(server);
  if (!arguments.set) return show_origin(*server, arguments.json);
  Stance origin{arguments.x, arguments.z, deg(arguments.yaw)};
  if (arguments.here) {
    // Nobody shall stand still for a server that is not there.
    if (const auto there = server->get("/registration"); !there) return pass(there);
    std::cerr << fmt::format("stand still for {} s, facing the front\n", arguments.seconds);
    const auto stance = watch(arguments.url, arguments.seconds);
    if (!stance) return pass(stance);
    origin = *stance;
  }
  const auto registration =
      server->post("/registration/origin",
                   {{"x", origin.x}, {"z", origin.z}, {"yawDegrees", to_deg(origin.yaw)}});
  if (!registration) return pass(registration);
  if (arguments.json) {
    std::cout << json_text(*registration);
  } else {
    std::cout << fmt::format(
                     "the world begins at what was x {:.3f} m, z {:.3f} m; its front is what "
                     "was {:.1f} deg\n",
                     origin.x, origin.z, to_deg(origin.yaw))
              << registration_report(*registration);
  }
  return kExitOk;
}

}  // namespace

Run add_origin(CLI::App& options) {
  const auto arguments = std::make_shared<OriginArguments>();
  add_server_option(options, arguments->url, "The fusion server");
  const auto place = number_range(-kFarthest, kFarthest);
  auto* x = options.add_option("--x", arguments->x, "Of the new origin, in the world as it is [m]");
  auto* z = options.add_option("--z", arguments->z, "Likewise [m]");
  auto* yaw = options.add_option("--yaw", arguments->yaw,
                                 "Where the new front is, about +y from the front there is [deg]");
  x->check(place);
  z->check(place);
  yaw->check(number_range(-360.0, 360.0));
  auto* here = options.add_flag("--here", arguments->here,
                                "Where one person stands, facing what shall be the front");
  here->excludes(x)->excludes(z)->excludes(yaw);
  options.add_option("--seconds", arguments->seconds, "How long the person is watched")
      ->check(number_range(0.5, 30.0))
      ->needs(here)
      ->capture_default_str();
  options.add_flag("--json", arguments->json, "Report as JSON");
  options.callback([x, z, yaw, here, arguments] {
    arguments->set = x->count() + z->count() + yaw->count() + here->count() > 0;
  });
  return [arguments] { return run_origin(*arguments); };
}

}  // namespace chorus::ctl
