#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/parse.h"
#include "common/time/timestamp.h"
#include "services/ergonomics/ergonomics_host.h"
#include "services/ergonomics/score_nodes.h"
#include "services/ergonomics/workplace_nodes.h"

namespace chorus::ergonomics_service {

using http::PathParams;
using http::Request;

namespace {

Result<std::uint64_t> person_of(const PathParams& params) {
  const std::string& text = params.at("person");
  const auto id = parse_name_number(text);
  if (!id) return fail(ErrorCode::NotFound, text, "is nobody; a person's name is a number");
  return *id;
}

Result<const PersonScores*> person_in(const ScoreFrame& frame, std::uint64_t id) {
  for (const PersonScores& each : frame.persons) {
    if (each.person == id) return &each;
  }
  return fail(ErrorCode::NotFound, "person " + std::to_string(id), "is not in the frame");
}

}  // namespace

ErgonomicsService::ErgonomicsService(Scoring scoring, service::Serving serving,
                                     std::optional<workplace::Scene> scene)
    : scoring_(std::move(scoring)),
      methods_(scoring_.methods()),
      serving_(std::move(serving)),
      scene_(std::move(scene)) {}

void ErgonomicsService::take(const resource::FrameResource& frame) {
  std::shared_ptr<const ScoreFrame> scores;
  {
    const std::lock_guard lock(mutex_);
    const std::uint64_t before = scoring_.latest().sequence;
    const ScoreFrame& latest = scoring_.take(frame);
    if (latest.sequence == before) return;
    frame_ = frame;
    scores = std::make_shared<const ScoreFrame>(latest);
  }
  live_->publish_lazily([scores, this] {
    http::DocumentOptions options;
    options.version = serving_.run + "-" + std::to_string(scores->sequence);
    options.captured = scores->captured;
    return resource::document_of(scores_node(*scores, methods_), std::move(options),
                                 serving_.place("ergonomics/"));
  });
}

bool ErgonomicsService::scored_any() const {
  const std::lock_guard lock(mutex_);
  return scoring_.latest().sequence != 0;
}

ErgonomicsService::Answer ErgonomicsService::person(const Request& request,
                                                    const PathParams& params) const {
  const auto id = person_of(params);
  if (!id) return pass(id);
  const std::lock_guard lock(mutex_);
  const ScoreFrame* frame = &scoring_.latest();
  if (const auto at = request.query.find("at"); at != request.query.end()) {
    const auto instant = parse_iso8601(at->second);
    if (!instant) return fail(ErrorCode::InvalidArgument, "at", instant.error().message);
    frame = scoring_.at(*instant);
    if (frame == nullptr)
      return fail(ErrorCode::NotFound, at->second, "is not among the scores of the last 30 s");
  }
  const auto scores = person_in(*frame, *id);
  if (!scores) return pass(scores);
  http::DocumentOptions options;
  options.version = serving_.run + "-" + std::to_string(frame->sequence);
  options.captured = frame->captured;
  return resource::document_of(person_node(**scores, methods_, ""), std::move(options),
                               serving_.place("ergonomics/" + std::to_string(*id)));
}

Result<const resource::BodyResource*> ErgonomicsService::body_of(const PathParams& params) const {
  const auto id = person_of(params);
  if (!id) return pass(id);
  for (const resource::BodyResource& body : frame_.bodies) {
    if (body.id == *id) return &body;
  }
  return fail(ErrorCode::NotFound, "person " + std::to_string(*id), "is not in the frame");
}

ErgonomicsService::Answer ErgonomicsService::size(const PathParams& params) const {
  const std::lock_guard lock(mutex_);
  const auto body = body_of(params);
  if (!body) return pass(body);
  const auto weight = weights_.find((*body)->id);
  const auto told = weight == weights_.end() ? std::nullopt : std::optional(weight->second);
  http::DocumentOptions options;
  options.version = serving_.run + "-" + std::to_string(frame_.sequence) +
                    (told ? "-" + std::to_string(*told) : "");
  return resource::document_of(size_node(**body, told), std::move(options),
                               serving_.place("ergonomics/" + params.at("person") + "/size",
                                              "ergonomics/" + params.at("person") + "/"));
}

ErgonomicsService::Answer ErgonomicsService::at_workplace(const PathParams& params) const {
  if (!scene_)
    return fail(ErrorCode::NotFound, "workplace",
                "is not known: name its scene (--scene FILE, or \"scene\" in the configuration)");
  const std::lock_guard lock(mutex_);
  const auto body = body_of(params);
  if (!body) return pass(body);
  http::DocumentOptions options;
  options.version = serving_.run + "-" + std::to_string(frame_.sequence);
  options.captured = frame_.captured;
  resource::BodyResource now = **body;
  now.captured = frame_.captured;
  return resource::document_of(workplace_node(now, *scene_), std::move(options),
                               serving_.place("ergonomics/" + params.at("person") + "/workplace",
                                              "ergonomics/" + params.at("person") + "/"));
}

Result<http::ActionResult> ErgonomicsService::weigh(const Request& request,
                                                    const PathParams& params) {
  constexpr double kHeaviest = 300.0;
  const auto fields = parse_json(request.body);
  if (!fields) return pass(fields);
  const auto kg =
      fields->is_object() && fields->size() == 1 ? fields->find("weightKg") : fields->end();
  if (kg == fields->end() || !kg->is_number() || !(kg->get<double>() >= 1.0) ||
      !(kg->get<double>() <= kHeaviest))
    return fail(ErrorCode::InvalidArgument, "weightKg", "send {\"weightKg\": 1 to 300}");
  const std::lock_guard lock(mutex_);
  const auto body = body_of(params);
  if (!body) return pass(body);
  weights_[(*body)->id] = kg->get<double>();
  return http::ActionResult{204, nullptr, ""};
}

Result<http::ActionResult> ErgonomicsService::stance(const PathParams& params) {
  const auto id = person_of(params);
  if (!id) return pass(id);
  const std::lock_guard lock(mutex_);
  if (auto ok = scoring_.ask_stance(*id); !ok) return pass(ok);
  return http::ActionResult{202, nullptr, ""};
}

http::DocumentPtr ErgonomicsService::asked_document() const {
  const ergonomics::Asked& asked = scoring_.asked();
  resource::Node node{"", {"PostureAnswers"}, {}};
  if (asked.load_kg) node.properties.emplace_back("loadKg", resource::Decimal{*asked.load_kg, 2});
  const auto flag = [&](const char* key, const std::optional<bool>& answer) {
    if (answer) node.properties.emplace_back(key, *answer);
  };
  flag("shock", asked.shock);
  flag("wristTwisted", asked.wrist_twisted);
  flag("armSupported", asked.arm_supported);
  flag("heldOverMinute", asked.held_over_minute);
  flag("repeated", asked.repeated);
  flag("unstable", asked.unstable);
  http::DocumentOptions options;
  options.version = serving_.run + "-asked-" + std::to_string(asked_version_);
  return resource::document_of(std::move(node), std::move(options), serving_.place("asked"));
}

Result<http::ActionResult> ErgonomicsService::ask(const Request& request) {
  const auto fields = parse_json(request.body);
  if (!fields) return pass(fields);
  if (!fields->is_object()) return fail(ErrorCode::Malformed, "body", "must be a JSON object");
  for (const auto& [key, value] : fields->items()) {
    if (!ergonomics::is_asked_field(key))
      return fail(ErrorCode::InvalidArgument, key, "is nothing that is asked");
  }
  auto asked = ergonomics::read_asked(*fields, "body");
  if (!asked) return pass(asked);
  const std::lock_guard lock(mutex_);
  scoring_.ask(std::move(*asked));
  ++asked_version_;
  return http::ActionResult{200, asked_document(), ""};
}

service::Self ErgonomicsService::description() const {
  service::Self self;
  self.title = "Chorus ergonomics";
  self.description = "Posture scores of the people of a tracker, with their doubt; a screening.";
  self.type = "PostureService";
  self.resources = {{"ergonomics/", "postureScores", "everybody's scores, live"},
                    {"methods/", "postureMethods", "the methods, their inputs and levels"},
                    {"asked", "", "what no tracker sees: the load, the grip, ...; PUT changes it"}};
  return self;
}

void ErgonomicsService::add_methods(http::Router& router) {
  http::DocumentOptions options;
  options.version = serving_.run + "-methods";
  const auto document =
      resource::document_of(methods_node(methods_), std::move(options), serving_.place("methods/"));
  router.get("/methods/",
             [document](const Request&, const PathParams&) -> Answer { return document; });
}

void ErgonomicsService::add_persons(http::Router& router) {
  router.get("/ergonomics/{person}/size",
             [this](const Request&, const PathParams& params) { return size(params); });
  router.action(
      http::Method::Put, "/ergonomics/{person}/size",
      [this](const Request& request, const PathParams& params) { return weigh(request, params); });
  router.get("/ergonomics/{person}/workplace",
             [this](const Request&, const PathParams& params) { return at_workplace(params); });
  router.action(http::Method::Post, "/ergonomics/{person}/stance",
                [this](const Request&, const PathParams& params) { return stance(params); });
}

void ErgonomicsService::add_routes(http::Router& router) {
  router.get("/", [this](const Request&, const PathParams&) -> Answer {
    return service::self_document(description(), serving_, "plain");
  });
  router.live("/ergonomics/", live_);
  router.get("/ergonomics/{person}", [this](const Request& request, const PathParams& params) {
    return person(request, params);
  });
  add_persons(router);
  router.get("/asked", [this](const Request&, const PathParams&) -> Answer {
    const std::lock_guard lock(mutex_);
    return asked_document();
  });
  router.action(http::Method::Put, "/asked",
                [this](const Request& request, const PathParams&) { return ask(request); });
  add_methods(router);
}

}  // namespace chorus::ergonomics_service
