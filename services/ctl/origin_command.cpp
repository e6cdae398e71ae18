// chorus origin: sets the origin of the world, by numbers or by a person who stands there.
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/units.h"
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

constexpr std::chrono::milliseconds kAskEvery{50};
constexpr double kFarthest = 1000.0;  // [m], the same as the server's

struct OriginArguments {
  std::string url = client::default_server();
  double x = 0.0;
  double z = 0.0;
  double yaw = 0.0;
  bool here = false;
  double seconds = 2.0;
  bool json = false;
};

/// Watches the person who stands there for this long.
Result<Stance> watch(const ServiceClient& server, double seconds) {
  std::vector<Stance> seen;
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::string newest;
  while (std::chrono::steady_clock::now() < until) {
    const auto frame = server.get("/frame");
    if (!frame) return pass(frame);
    const std::string captured = client::text_at(*frame, "captured");
    if (std::exchange(newest, captured) != captured) {
      const auto stance = stance_in(*frame);
      if (!stance) return pass(stance);
      seen.push_back(*stance);
    }
    std::this_thread::sleep_for(kAskEvery);
  }
  return steady(seen);
}

Result<int> run_origin(const OriginArguments& arguments) {
  const auto server = ServiceClient::of(arguments.url);
  if (!server) return pass(server);
  Stance origin{arguments.x, arguments.z, deg(arguments.yaw)};
  if (arguments.here) {
    std::cerr << fmt::format("stand still for {} s, facing the front\n", arguments.seconds);
    const auto stance = watch(*server, arguments.seconds);
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
  options.callback([x, z, yaw, here] {
    if (x->count() + z->count() + yaw->count() + here->count() == 0)
      throw CLI::RequiredError("--here, or --x, --z, --yaw");
  });
  return [arguments] { return run_origin(*arguments); };
}

}  // namespace chorus::ctl
