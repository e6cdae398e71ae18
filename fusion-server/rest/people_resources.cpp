#include "fusion-server/rest/people_resources.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/parse.h"
#include "common/http/status.h"

namespace chorus::rest {
namespace {

constexpr Duration kLeastInterval = std::chrono::milliseconds(200);

Result<PersonId> person_of(const std::string& id) {
  if (const auto number = parse_name_number(id)) return PersonId{*number};
  return fail(ErrorCode::NotFound, "people/" + id.substr(0, 32),
              "ids of people are whole numbers; GET /people/ lists them");
}

}  // namespace

resource::Node person_node(const journal::KnownPerson& person, std::string id) {
  using resource::Decimal;
  resource::Node node{std::move(id), {"TrackedPerson"}, {}};
  auto& out = node.properties;
  out.emplace_back("personId", std::to_string(person.id.value));
  if (!person.name.empty()) out.emplace_back("name", person.name);
  out.emplace_back("state", std::string(journal::name_of(person.presence)));
  if (person.slot) out.emplace_back("slot", static_cast<std::int64_t>(*person.slot));
  out.emplace_back("firstSeen", person.since);
  if (person.last_seen) out.emplace_back("lastSeen", *person.last_seen);
  if (person.sides_confidence)
    out.emplace_back("sidesConfidence", Decimal{*person.sides_confidence, 2});
  if (person.stature) {
    out.emplace_back("stature", Decimal{person.stature->length, 2});
    out.emplace_back("statureSigma", Decimal{person.stature->sigma, 2});
  }
  std::vector<std::string> sensors;
  for (const SensorId& sensor : person.sensors) sensors.push_back(sensor.str());
  out.emplace_back("sensors", std::move(sensors));
  return node;
}

Result<std::string> parse_naming(std::string_view body) {
  constexpr JsonLimits kLimits{4096, 4};
  const auto json = parse_json(body, kLimits);
  const bool naming = json && json->is_object() && json->size() == 1 && json->contains("name");
  if (naming && json->at("name").is_null()) return std::string();
  if (naming && json->at("name").is_string()) return json->at("name").get<std::string>();
  return fail(ErrorCode::InvalidArgument, "people",
              R"(send a JSON object with one member: {"name": "Anna"}, or {"name": null})");
}

PeopleResources::PeopleResources(service::Serving serving, Duration remember,
                                 std::function<void(PersonId)> forget)
    : serving_(std::move(serving)),
      forget_(std::move(forget)),
      list_(std::make_shared<http::LiveDocument>()),
      roll_(remember) {
  show();
}

void PeopleResources::publish(std::shared_ptr<const Snapshot> snapshot) {
  const std::scoped_lock lock(mutex_);
  changed_ = roll_.take(*snapshot) || changed_;
  const Duration passed = snapshot->instant - shown_;
  // A clock that was set back must not hold the list back.
  if (!changed_ || (passed >= Duration{0} && passed < kLeastInterval)) return;
  shown_ = snapshot->instant;
  show();
}

void PeopleResources::remember_for(Duration remember) {
  const std::scoped_lock lock(mutex_);
  roll_.remember_for(remember);
}

std::vector<journal::KnownPerson> PeopleResources::people() const {
  const std::scoped_lock lock(mutex_);
  return roll_.people();
}

void PeopleResources::show() {
  changed_ = false;
  resource::Node node{"", {"PersonList", "ldp:BasicContainer", "ldp:Container"}, {}};
  std::vector<resource::Ref> contains;
  std::vector<resource::Node> members;
  for (const journal::KnownPerson& person : roll_.people()) {
    const std::string id = std::to_string(person.id.value);
    contains.push_back({id});
    members.push_back(person_node(person, id));
  }
  node.properties.emplace_back("title", std::string("people"));
  node.properties.emplace_back("contains", std::move(contains));
  node.properties.emplace_back("people", std::move(members));
  http::DocumentOptions options;
  options.version = serving_.run + "-" + std::to_string(++version_);
  list_->publish(resource::document_of(std::move(node), std::move(options),
                                       serving_.place("people/"), resource::Kind::Container));
}

Result<http::DocumentPtr> PeopleResources::one(const std::string& id) const {
  const auto person = person_of(id);
  if (!person) return pass(person);
  const std::scoped_lock lock(mutex_);
  const journal::KnownPerson* known = roll_.find(*person);
  if (known == nullptr)
    return fail(ErrorCode::NotFound, "people/" + id,
                "nobody with this id is known; GET /people/ lists who is");
  http::DocumentOptions options;
  options.version = serving_.run + "-" + std::to_string(version_) + (changed_ ? "-next" : "");
  return resource::document_of(person_node(*known, ""), std::move(options),
                               serving_.place("people/" + id));
}

Result<http::ActionResult> PeopleResources::rename(const std::string& id, std::string_view body) {
  const auto person = person_of(id);
  if (!person) return pass(person);
  const auto name = parse_naming(body);
  if (!name) return pass(name);
  {
    const std::scoped_lock lock(mutex_);
    if (auto done = roll_.rename(*person, *name); !done) return pass(done);
    show();
  }
  return one(id).map([](const http::DocumentPtr& document) {
    return http::ActionResult{http::status::kOk, document, {}};
  });
}

Result<http::ActionResult> PeopleResources::forget(const std::string& id) {
  const auto person = person_of(id);
  if (!person) return pass(person);
  const std::scoped_lock lock(mutex_);
  if (auto done = roll_.forget(*person); !done) return pass(done);
  forget_(*person);
  show();
  return http::ActionResult{http::status::kNoContent, nullptr, {}};
}

void PeopleResources::add_routes(http::Router& router) {
  using http::Method;
  using http::PathParams;
  using http::Request;
  router.live("/people/", list_);
  router.get("/people/{id}",
             [this](const Request&, const PathParams& params) { return one(params.at("id")); });
  router.action(Method::Patch, "/people/{id}",
                [this](const Request& request, const PathParams& params) {
                  return rename(params.at("id"), request.body);
                });
  router.action(
      Method::Post, "/people/{id}/forget",
      [this](const Request&, const PathParams& params) { return forget(params.at("id")); });
}

}  // namespace chorus::rest
