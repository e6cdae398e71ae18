#include "services/evaluation/evaluation_service.h"

#include <array>
#include <utility>

#include "common/resource/inertial_calibration_resource.h"

namespace chorus::evaluation_service {

using http::PathParams;
using http::Request;

namespace {

http::DocumentPtr document_of_evaluation(std::shared_ptr<const void> value,
                                         const resource::Place& place,
                                         http::DocumentOptions options) {
  const auto evaluation = std::static_pointer_cast<const EvaluationResource>(std::move(value));
  return resource::document_of(evaluation_node(*evaluation), std::move(options), place);
}

constexpr service::ServedKind kServedEvaluations{
    {"evaluation", "evaluations/", "evaluation", nullptr}, document_of_evaluation};

TrackedInstant tracked(const Frame& frame) {
  TrackedInstant instant{frame.document->captured + correction(frame.clock), {}};
  for (const resource::BodyResource& body : frame.document->bodies) {
    auto& [person, skeleton] = instant.people.emplace_back();
    person = PersonId{body.id};
    for (std::size_t j = 0; j < kJointCount; ++j) skeleton.joints[j] = body.joints[j];
  }
  return instant;
}

Result<SensorId> source_of(const std::string& name) {
  auto id = SensorId::parse(name);
  if (!id) return fail(ErrorCode::NotFound, name, "is no name of an inertial source");
  return id;
}

}  // namespace

EvaluationService::EvaluationService(JudgeOptions options, service::Serving serving,
                                     std::string title)
    : judge_(std::move(options)),
      title_(std::move(title)),
      documents_(std::move(serving), {}, kServedEvaluations) {}

void EvaluationService::judges(const std::string& tracker) {
  const std::scoped_lock lock(mutex_);
  tracker_ = tracker;
}

void EvaluationService::take(const std::vector<Heard>& heard) {
  const std::scoped_lock lock(mutex_);
  for (const Heard& each : heard) {
    if (const auto* frame = std::get_if<Frame>(&each)) {
      judge_.take(tracked(*frame));
      continue;
    }
    for (auto& instant : client::place_in_time(std::get<Orientations>(each)))
      judge_.take(std::move(instant));
  }
  if (const auto captured = judge_.judge()) publish(*captured);
}

void EvaluationService::publish(Timestamp captured) {
  auto evaluation = std::make_shared<EvaluationResource>();
  evaluation->sequence = ++sequence_;
  evaluation->captured = captured;
  evaluation->tracker = tracker_;
  evaluation->limbs = judge_.limbs();
  documents_.publish(resource::document_of_value(
      std::shared_ptr<const EvaluationResource>(std::move(evaluation))));
}

service::Self EvaluationService::description() const {
  service::Self self;
  self.title = title_;
  self.description = "Judges a tracker by what worn inertial sensors say.";
  self.type = "Evaluator";
  self.resources = {{"evaluation", "evaluation", "each limb: angle, state, since when, live"},
                    {"evaluation/segments", "", "the tracking errors since the start"},
                    {"calibrations/", "", "how the sensors of each source sit on their limbs"}};
  return self;
}

/// Documents that are made on request change with every instant that is judged.
http::DocumentOptions EvaluationService::options() const {
  http::DocumentOptions out;
  out.version = documents_.serving().run + "-" + std::to_string(sequence_);
  return out;
}

EvaluationService::Answer EvaluationService::segments() const {
  const std::scoped_lock lock(mutex_);
  return resource::document_of(segments_node(judge_.segments()), options(),
                               documents_.serving().place("evaluation/segments", "evaluation/"));
}

EvaluationService::Answer EvaluationService::calibration(const std::string& name) const {
  const auto id = source_of(name);
  if (!id) return pass(id);
  const std::scoped_lock lock(mutex_);
  const auto found = judge_.calibration(*id);
  if (!found) return pass(found);
  return resource::document_of(resource::inertial_calibration_node(*found), options(),
                               documents_.serving().place("calibrations/" + name));
}

EvaluationService::Answer EvaluationService::sources() const {
  const std::scoped_lock lock(mutex_);
  std::vector<resource::Ref> contains;
  for (const SensorId& id : judge_.sources()) contains.push_back({id.str()});
  return resource::document_of({"",
                                {"ldp:BasicContainer", "ldp:Container"},
                                {{"title", std::string("calibrations by inertial source")},
                                 {"contains", std::move(contains)}}},
                               options(), documents_.serving().place("calibrations/"),
                               resource::Kind::Container);
}

void EvaluationService::add_routes(http::Router& router) {
  documents_.add_routes(router);
  router.get("/", [this](const Request&, const PathParams&) -> Answer {
    return service::self_document(description(), documents_.serving(), "plain");
  });
  router.get("/evaluation/segments",
             [this](const Request&, const PathParams&) { return segments(); });
  router.get("/calibrations/", [this](const Request&, const PathParams&) { return sources(); });
  router.get("/calibrations/{source}", [this](const Request&, const PathParams& params) {
    return calibration(params.at("source"));
  });
  router.action(http::Method::Delete, "/calibrations/{source}",
                [this](const Request&, const PathParams& params) -> Result<http::ActionResult> {
                  const auto id = source_of(params.at("source"));
                  if (!id) return pass(id);
                  const std::scoped_lock lock(mutex_);
                  if (auto ok = judge_.forget_calibration(*id); !ok) return pass(ok);
                  return http::ActionResult{204, nullptr, ""};
                });
}

void EvaluationService::add_metrics(service::MetricsText& text) const {
  std::array<double, 4> states{};
  double segments = 0.0;
  {
    const std::scoped_lock lock(mutex_);
    for (const LimbJudgement& limb : judge_.limbs()) {
      states[static_cast<std::size_t>(limb.state)] += 1.0;
      segments += static_cast<double>(limb.segments);
    }
  }
  for (std::size_t i = 0; i < states.size(); ++i)
    text.gauge({"chorus_evaluation_limbs", "Limbs with a sensor, by state."}, states[i],
               {{"state", std::string(name_of(static_cast<LimbState>(i)))}});
  text.counter({"chorus_evaluation_segments_total", "Tracking errors found since the start."},
               segments);
}

}  // namespace chorus::evaluation_service
