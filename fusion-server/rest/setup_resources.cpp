#include "fusion-server/rest/setup_resources.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/fnv.h"
#include "common/base/json.h"
#include "common/http/client.h"
#include "common/http/status.h"
#include "common/resource/link_lines.h"

namespace chorus::rest {
namespace {

using nlohmann::json;
using Done = Result<http::ActionResult>;
using Wishes = SetupControl::Wishes;

constexpr JsonLimits kBody{64u << 10, 6};
constexpr const char* kShape =
    "send {\"sensors\": [{\"id\": \"s1\", \"url\": \"http://HOST:8081/\", \"token\": \"...\"}]}";

Result<std::string> string_at(const json& object, const char* key, bool needed) {
  const auto member = object.find(key);
  if (member == object.end() && !needed) return std::string();
  if (member == object.end() || !member->is_string())
    return fail(ErrorCode::InvalidArgument, key, kShape);
  return member->get<std::string>();
}

Result<client::FollowedService> sensor_of(const json& object, bool named) {
  if (!object.is_object()) return fail(ErrorCode::InvalidArgument, "sensors", kShape);
  for (const auto& [key, value] : object.items()) {
    if (key != "id" && key != "url" && key != "token")
      return fail(ErrorCode::InvalidArgument, key, kShape);
  }
  const auto id = string_at(object, "id", named);
  const auto url = string_at(object, "url", true);
  const auto token = string_at(object, "token", false);
  for (const auto* text : {&id, &url, &token}) {
    if (!*text) return pass(*text);
  }
  client::FollowedService sensor{{}, *url, *token};
  if (const auto parsed = http::parse_url(*url); !parsed) return pass(parsed);
  if (!named) return sensor;
  const auto name = SensorId::parse(*id);
  if (!name) return fail(ErrorCode::InvalidArgument, "id", name.error().message);
  sensor.id = *name;
  return sensor;
}

http::DocumentPtr json_document(const std::string& run, std::string text) {
  http::DocumentOptions options;
  options.version = run + "-" + std::to_string(fnv1a(text));
  return resource::other_document("application/json", std::move(text), std::move(options));
}

std::string dumped(const json& value) {
  return value.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

json found_json(const std::vector<client::FoundSensor>& found) {
  json all = json::array();
  for (const client::FoundSensor& sensor : found)
    all.push_back({{"id", sensor.id}, {"url", sensor.url()}, {"host", sensor.host}});
  return all;
}

json trials_json(const std::map<std::string, Trial>& trials) {
  json all = json::object();
  for (const auto& [url, trial] : trials) {
    const char* state = trial.running ? "trying" : trial.result.good ? "good" : "bad";
    all[url] = {{"state", state}};
    if (!trial.result.words.empty()) all[url]["words"] = trial.result.words;
    if (!trial.result.sensor_id.empty()) all[url]["sensorId"] = trial.result.sensor_id;
  }
  return all;
}

Result<SensorId> sensor_named(const http::PathParams& params) {
  const auto id = SensorId::parse(params.at("id"));
  if (id) return *id;
  return fail(ErrorCode::NotFound, "sensors/" + params.at("id"),
              "no sensor of this id is known here");
}

Result<bool> silence_of(std::string_view body) {
  const auto wish = parse_json(body, kBody);
  if (!wish) return pass(wish);
  const auto silenced =
      wish->is_object() && wish->size() == 1 ? wish->find("silenced") : wish->end();
  if (silenced != wish->end() && silenced->is_boolean()) return silenced->get<bool>();
  return fail(ErrorCode::InvalidArgument, "silenced", "send {\"silenced\": true} or false");
}

/// The routes need `control` and `run` for as long as the router lives.
struct Setup {
  SetupControl control;
  std::string run;

  [[nodiscard]] Done done(const Result<void>& outcome, int status) const {
    if (!outcome) return pass(outcome);
    return http::ActionResult{status, json_document(run, setup_json(control.facts())), {}};
  }
  [[nodiscard]] Done add(std::string_view body) const {
    const auto wishes = parse_sensor_wishes(body);
    if (!wishes) return pass(wishes);
    auto added = done(control.add(*wishes), http::status::kCreated);
    if (added) added->location = "/sensors/" + wishes->front().id.str();
    return added;
  }
  [[nodiscard]] Done attempt(std::string_view body) const {
    const auto wish = parse_json(body, kBody);
    if (!wish) return pass(wish);
    const auto sensor = sensor_of(*wish, false);
    if (!sensor) return pass(sensor);
    return done(control.attempt(*sensor), http::status::kAccepted);
  }
  [[nodiscard]] Done preview(std::string_view body) const {
    const auto wishes = parse_sensor_wishes(body);
    if (!wishes) return pass(wishes);
    const auto text = control.preview(*wishes);
    if (!text) return pass(text);
    const json shown{{"file", control.facts().file}, {"text", *text}};
    return http::ActionResult{http::status::kOk, json_document(run, dumped(shown)), {}};
  }
};

void add_sensor_routes(http::Router& router, const std::shared_ptr<const Setup>& setup) {
  using http::Method;
  using http::PathParams;
  using http::Request;
  router.action(Method::Post, "/sensors/", [setup](const Request& request, const PathParams&) {
    return setup->add(request.body);
  });
  router.action(Method::Patch, "/sensors/{id}",
                [setup](const Request& request, const PathParams& params) -> Done {
                  const auto id = sensor_named(params);
                  if (!id) return pass(id);
                  const auto silent = silence_of(request.body);
                  if (!silent) return pass(silent);
                  return setup->done(setup->control.silence(*id, *silent), http::status::kOk);
                });
  router.action(Method::Delete, "/sensors/{id}",
                [setup](const Request&, const PathParams& params) -> Done {
                  const auto id = sensor_named(params);
                  if (!id) return pass(id);
                  return setup->done(setup->control.take_out(*id), http::status::kOk);
                });
}

}  // namespace

Result<Wishes> parse_sensor_wishes(std::string_view body) {
  const auto wish = parse_json(body, kBody);
  if (!wish) return pass(wish);
  if (!wish->is_object()) return fail(ErrorCode::InvalidArgument, "sensors", kShape);
  const bool one = wish->contains("url");
  const json all = one ? json::array({*wish}) : wish->value("sensors", json());
  if (!all.is_array() || all.empty() || (!one && wish->size() != 1))
    return fail(ErrorCode::InvalidArgument, "sensors", kShape);
  Wishes wishes;
  for (const json& each : all) {
    auto sensor = sensor_of(each, true);
    if (!sensor) return pass(sensor);
    const auto same = [&](const auto& other) { return other.id == sensor->id; };
    if (std::ranges::any_of(wishes, same))
      return fail(ErrorCode::InvalidArgument, "sensors",
                  "two of them are called " + sensor->id.str());
    wishes.push_back(std::move(*sensor));
  }
  return wishes;
}

std::string setup_json(const SetupFacts& facts) {
  json out{{"text", facts.text},
           {"searching", facts.searching},
           {"found", found_json(facts.found)},
           {"trials", trials_json(facts.trials)},
           {"added", facts.added},
           {"silenced", facts.silenced}};
  if (!facts.file.empty()) out["file"] = facts.file;
  if (!facts.search_problem.empty()) out["searchProblem"] = facts.search_problem;
  return dumped(out);
}

void add_setup_routes(http::Router& router, const service::Serving& serving, SetupControl control) {
  using http::Method;
  using http::PathParams;
  using http::Request;
  const auto setup = std::make_shared<const Setup>(Setup{std::move(control), serving.run});
  router.get("/setup", [setup](const Request&, const PathParams&) -> Result<http::DocumentPtr> {
    return json_document(setup->run, setup_json(setup->control.facts()));
  });
  router.action(Method::Post, "/setup/search", [setup](const Request&, const PathParams&) {
    setup->control.search();
    return setup->done({}, http::status::kAccepted);
  });
  router.action(Method::Post, "/setup/try", [setup](const Request& request, const PathParams&) {
    return setup->attempt(request.body);
  });
  router.action(Method::Post, "/setup/preview", [setup](const Request& request, const PathParams&) {
    return setup->preview(request.body);
  });
  add_sensor_routes(router, setup);
}

}  // namespace chorus::rest
