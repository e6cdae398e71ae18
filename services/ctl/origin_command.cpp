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
  double seconds = 2.0;
  bool json = false;
};

/// Watches the person who stands there, on one connection: each frame once, as it comes.
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

Result<int> run_origin(const OriginArguments& arguments) {
  const auto server = ServiceClient::of(arguments.url);
  if (!server) return pass(server);
  Stance origin{arguments.x, arguments.z, deg(arguments.yaw)};
  if (arguments.here) {
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
  options.callback([x, z, yaw, here] {
    if (x->count() + z->count() + yaw->count() + here->count() == 0)
      throw CLI::RequiredError("--here, or --x, --z, --yaw");
  });
  return [arguments] { return run_origin(*arguments); };
}

}  // namespace chorus::ctl
