#include "fusion-server/rest/inertial_resources.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/time/clock_estimate.h"

namespace chorus::rest {
namespace {

resource::Decimal in_ms(Duration d) {
  return {std::chrono::duration<double, std::milli>(d).count(), 3};
}

}  // namespace

resource::Node inertial_source_node(const client::FollowReport& source, Timestamp now,
                                    std::string id) {
  resource::Node node{std::move(id), {"InertialSource"}, {}};
  auto& out = node.properties;
  out.emplace_back("sensorId", source.service.id.str());
  out.emplace_back("url", resource::Ref{source.service.url});
  out.emplace_back("state", std::string(client::name_of(source.state)));
  out.emplace_back("transport", std::string(source.streaming ? "stream" : "poll"));
  if (source.newest) out.emplace_back("ageMilliseconds", in_ms(now - *source.newest));
  out.emplace_back("rateHz", resource::Decimal{source.rate_hz, 2});
  if (source.clock) {
    out.emplace_back("clockOffsetMilliseconds", in_ms(source.clock->ours_minus_theirs));
    out.emplace_back("clockUncertaintyMilliseconds", in_ms(source.clock->uncertainty));
    out.emplace_back("clockCorrected", correction(source.clock) != Duration{0});
  }
  out.emplace_back("framesReceived", static_cast<std::int64_t>(source.frames));
  out.emplace_back("framesMissed", static_cast<std::int64_t>(source.missed));
  out.emplace_back("framesRefused", static_cast<std::int64_t>(source.early + source.stale));
  if (!source.last_error.empty()) out.emplace_back("lastError", source.last_error);
  out.emplace_back("orientations",
                   resource::Ref{"/inertial/" + source.service.id.str() + "/orientations"});
  return node;
}

std::vector<std::string> worn_sentences(const WornReport& worn) {
  std::vector<std::string> all;
  if (!worn.wearer) all.push_back("nobody is known to wear it: " + worn.reason);
  for (const std::string& sensor : worn.unplaced)
    all.push_back("the limb of " + sensor +
                  " is not known; name it after its limb at its source (LeftLowerLeg)");
  for (const WornSensorReport& one : worn.sensors) {
    const auto limb = inertial::words_for(one.limb);
    if (one.slipped_ago)
      all.push_back(
          fmt::format("the sensor of the {} has turned on it by {:.0f} degrees {:.0f} s "
                      "ago{}",
                      limb, to_deg(one.slip), *one.slipped_ago,
                      one.calibrated ? "; it is calibrated again" : ""));
    if (one.silent_for)
      all.push_back(fmt::format(
          "the sensor of the {} has said nothing for {:.0f} s, while others of its suit do", limb,
          *one.silent_for));
    if (one.overstated)
      all.push_back(fmt::format(
          "the sensor of the {} states an error of {:.0f} degrees itself, so it has no say", limb,
          to_deg(*one.overstated)));
    if (!one.calibrated && !one.refusal.empty())
      all.push_back(fmt::format("the {} is not calibrated: {}", limb, one.refusal));
  }
  return all;
}

void add_worn(const WornReport& worn, resource::Node& node) {
  if (worn.wearer)
    node.properties.emplace_back("wearer", static_cast<std::int64_t>(worn.wearer->value));
  std::vector<std::string> limbs;
  for (const WornSensorReport& one : worn.sensors)
    if (one.calibrated) limbs.emplace_back(inertial::name_of(one.limb));
  if (!limbs.empty()) node.properties.emplace_back("knownLimbs", std::move(limbs));
  auto sentences = worn_sentences(worn);
  if (!sentences.empty()) node.properties.emplace_back("reasons", std::move(sentences));
}

InertialResources::InertialResources(service::Serving serving, const std::vector<SensorId>& sources)
    : serving_(std::make_shared<const service::Serving>(std::move(serving))),
      list_(std::make_shared<http::LiveDocument>()) {
  for (const SensorId& source : sources) live_[source] = std::make_shared<http::LiveDocument>();
}

void InertialResources::publish(const std::vector<client::FollowReport>& sources,
                                const std::vector<WornReport>& worn, Timestamp now) {
  resource::Node node{"", {"InertialSourceList", "ldp:BasicContainer", "ldp:Container"}, {}};
  std::vector<resource::Ref> contains;
  std::vector<resource::Node> members;
  for (const client::FollowReport& source : sources) {
    contains.push_back({source.service.id.str()});
    members.push_back(inertial_source_node(source, now, source.service.id.str()));
    const auto known = std::ranges::find(worn, source.service.id, &WornReport::source);
    if (known != worn.end()) add_worn(*known, members.back());
  }
  node.properties.emplace_back("title", std::string("followed inertial sources"));
  node.properties.emplace_back("contains", std::move(contains));
  node.properties.emplace_back("inertialSources", std::move(members));
  http::DocumentOptions options;
  {
    const std::scoped_lock lock(mutex_);
    options.version = serving_->run + "-" + std::to_string(++version_);
  }
  list_->publish(resource::document_of(std::move(node), std::move(options),
                                       serving_->place("inertial/"), resource::Kind::Container));
}

std::shared_ptr<http::LiveDocument> InertialResources::live_of(const SensorId& source) {
  const std::scoped_lock lock(mutex_);
  auto& live = live_[source];
  if (!live) live = std::make_shared<http::LiveDocument>();
  return live;
}

void InertialResources::relay(const SensorId& source,
                              std::shared_ptr<const resource::OrientationsResource> orientations) {
  live_of(source)->publish_lazily(
      [serving = serving_, source, orientations = std::move(orientations)] {
        const std::string folder = "inertial/" + source.str() + "/";
        auto options =
            resource::latest_options(resource::document_of_value(orientations), {}, serving->run);
        options.content_location.clear();
        return resource::orientations_document(
            orientations, serving->place(folder + "orientations", folder), std::move(options));
      });
}

Result<http::DocumentPtr> InertialResources::orientations_of(const std::string& id) const {
  const auto source = SensorId::parse(id);
  const std::scoped_lock lock(mutex_);
  const auto it = source ? live_.find(*source) : live_.end();
  if (it == live_.end())
    return fail(ErrorCode::NotFound, "inertial/" + id, "no inertial source of this id is followed");
  if (auto document = it->second->current()) return document;
  return fail(ErrorCode::Unavailable, "inertial/" + id + "/orientations",
              "this source has not said anything yet");
}

void InertialResources::add_routes(http::Router& router) {
  router.live("/inertial/", list_);
  router.get("/inertial/{id}/orientations",
             [this](const http::Request&, const http::PathParams& params) {
               return orientations_of(params.at("id"));
             });
  for (const auto& [source, live] : live_)
    router.live("/inertial/" + source.str() + "/orientations", live);
}

}  // namespace chorus::rest
