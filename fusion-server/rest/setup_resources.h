// Adding sensors without a shell: /setup says what was found and tried, POST /setup/search looks
// for sensors in the network, POST /setup/try tries an address, POST /setup/preview shows the file
// that POST /sensors/ would write; PATCH /sensors/{id} silences, DELETE /sensors/{id} takes out.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/client/discovery.h"
#include "common/client/followers.h"
#include "common/client/sensor_trial.h"
#include "common/http/router.h"
#include "common/service/serving.h"

namespace chorus::rest {

struct Trial {
  bool running = true;
  client::SensorTrial result;
};

struct SetupFacts {
  std::string file;  ///< Where added sensors are kept; empty: nowhere.
  std::string text;  ///< What the file holds, without tokens.
  bool searching = false;
  std::string search_problem;  ///< Why nothing can be found; empty: nothing is wrong.
  std::vector<client::FoundSensor> found;
  std::map<std::string, Trial> trials;          ///< By address.
  std::set<std::string> added;                  ///< The ids that DELETE /sensors/{id} can take out.
  std::map<std::string, std::string> silenced;  ///< Addresses by id.
};

/// What the routes ask of the owner of the sensors.  `search` and `attempt` must only post a task.
struct SetupControl {
  using Wishes = std::vector<client::FollowedService>;
  std::function<SetupFacts()> facts;
  std::function<void()> search;
  /// Conflict: this address, or too many others, are being tried.
  std::function<Result<void>(const client::FollowedService&)> attempt;
  std::function<Result<std::string>(const Wishes&)> preview;
  std::function<Result<void>(const Wishes&)> add;
  std::function<Result<void>(const SensorId&, bool silent)> silence;
  std::function<Result<void>(const SensorId&)> take_out;
};

/// Reads {"sensors": [{"id": "s1", "url": "http://...", "token": "..."}]}, at least one, of
/// distinct ids; or one such sensor alone.  InvalidArgument for anything else.
[[nodiscard]] Result<SetupControl::Wishes> parse_sensor_wishes(std::string_view body);

[[nodiscard]] std::string setup_json(const SetupFacts& facts);

void add_setup_routes(http::Router& router, const service::Serving& serving, SetupControl control);

}  // namespace chorus::rest
