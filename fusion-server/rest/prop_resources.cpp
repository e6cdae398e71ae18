#include "fusion-server/rest/prop_resources.h"

#include <algorithm>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/units.h"
#include "common/body/bones.h"

namespace chorus::rest {
namespace {

using resource::Decimal;

void add_pose(const workplace::PropPose& pose, resource::Node& out) {
  constexpr int kPlaceDigits = 4;
  constexpr int kTurnDigits = 6;
  const Eigen::Vector3d& at = pose.world_from_prop.translation();
  const Eigen::Quaterniond turn(pose.world_from_prop.linear());
  out.properties.insert(out.properties.end(), {{"x", Decimal{at.x(), kPlaceDigits}},
                                               {"y", Decimal{at.y(), kPlaceDigits}},
                                               {"z", Decimal{at.z(), kPlaceDigits}},
                                               {"qx", Decimal{turn.x(), kTurnDigits}},
                                               {"qy", Decimal{turn.y(), kTurnDigits}},
                                               {"qz", Decimal{turn.z(), kTurnDigits}},
                                               {"qw", Decimal{turn.w(), kTurnDigits}}});
  if (!(pose.sigma > 0.0)) return;
  out.properties.emplace_back("placeSigma", Decimal{pose.sigma, kPlaceDigits});
  out.properties.emplace_back("turnSigmaDegrees", Decimal{to_deg(pose.turn_sigma), 1});
}

resource::Node prop_node(const workplace::Prop& prop, const workplace::PropAt& place) {
  std::vector<std::string> joints{std::string(name_of(prop.joint))};
  if (prop.other) joints.emplace_back(name_of(*prop.other));
  resource::Node node{"#" + prop.name,
                      {"Prop"},
                      {{"propName", prop.name},
                       {"holdingJoints", std::move(joints)},
                       {"propTracked", place.tracked}}};
  if (place.holding.person)
    node.properties.emplace_back("heldBy", static_cast<std::int64_t>(*place.holding.person));
  if (prop.size.minCoeff() > 0.0)
    node.properties.emplace_back(
        "propSize",
        std::vector<Decimal>{{prop.size.x(), 4}, {prop.size.y(), 4}, {prop.size.z(), 4}});
  if (place.pose) add_pose(*place.pose, node);
  return node;
}

}  // namespace

resource::Node props_node(Timestamp instant, const std::vector<workplace::Prop>& props,
                          const std::vector<workplace::PropAt>& places) {
  std::vector<resource::Node> nodes;
  for (std::size_t i = 0; i < props.size(); ++i) nodes.push_back(prop_node(props[i], places[i]));
  return {"", {"PropList"}, {{"captured", instant}, {"props", std::move(nodes)}}};
}

Result<std::uint64_t> parse_holder(std::string_view body, const std::vector<std::uint64_t>& here) {
  std::string known;
  for (const std::uint64_t person : here)
    known += (known.empty() ? "" : ", ") + std::to_string(person);
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    if (here.empty()) return fail(ErrorCode::NotFound, "person", "nobody is seen");
    if (here.size() == 1) return here.front();
    return fail(ErrorCode::Conflict, "person",
                "several people are seen; name one, as {\"person\": " +
                    std::to_string(here.front()) + "} does; there are: " + known);
  }
  const auto json = parse_json(body, {4096, 4});
  if (!json) return pass(json);
  const auto person = json->is_object() && json->size() == 1 ? json->find("person") : json->end();
  if (person == json->end() || !person->is_number_unsigned())
    return fail(ErrorCode::InvalidArgument, "person",
                "send {\"person\": NUMBER}, or nothing if one person is seen");
  const auto id = person->get<std::uint64_t>();
  if (std::ranges::find(here, id) != here.end()) return id;
  return fail(ErrorCode::NotFound, "person " + std::to_string(id),
              known.empty() ? "is not seen; nobody is" : "is not seen; there are: " + known);
}

PropResources::PropResources(service::Serving serving, std::shared_ptr<workplace::PropBoard> board)
    : serving_(std::move(serving)), board_(std::move(board)), held_(board_), things_(board_) {}

void PropResources::publish(std::shared_ptr<const Snapshot> snapshot) {
  std::vector<workplace::Holder> people;
  std::vector<std::uint64_t> here;
  for (const FusedBody& body : snapshot->bodies) {
    people.push_back({body.id.value, &body.skeleton});
    here.push_back(body.id.value);
  }
  {
    const std::scoped_lock lock(mutex_);
    here_ = std::move(here);
  }
  if (board_->props().empty()) return;
  live_->publish_lazily([serving = serving_, board = board_, at = snapshot->instant,
                         sequence = snapshot->sequence,
                         places = held_.follow(snapshot->instant, people)] {
    http::DocumentOptions options;
    options.version = serving.run + "-" + std::to_string(sequence);
    options.captured = at;
    return resource::document_of(props_node(at, board->props(), places), std::move(options),
                                 serving.place("props/"));
  });
}

Result<http::ActionResult> PropResources::take_up(const http::Request& request,
                                                  const http::PathParams& params) {
  if (const auto known = board_->index_of(params.at("prop")); !known) return pass(known);
  std::vector<std::uint64_t> here;
  {
    const std::scoped_lock lock(mutex_);
    here = here_;
  }
  const auto person = parse_holder(request.body, here);
  if (!person) return pass(person);
  if (auto ok = board_->take_up(params.at("prop"), *person); !ok) return pass(ok);
  return http::ActionResult{204, nullptr, ""};
}

void PropResources::add_routes(http::Router& router) {
  using http::Method;
  if (board_->props().empty()) {
    http::DocumentOptions options;
    options.version = serving_.run;
    live_->publish(resource::document_of(props_node(Timestamp{}, {}, {}), std::move(options),
                                         serving_.place("props/")));
  }
  router.live("/props/", live_);
  router.action(Method::Post, "/props/{prop}/take-up",
                [this](const http::Request& request, const http::PathParams& params) {
                  return take_up(request, params);
                });
  router.action(
      Method::Post, "/props/{prop}/put-down",
      [this](const http::Request&, const http::PathParams& params) -> Result<http::ActionResult> {
        if (auto ok = board_->put_down(params.at("prop")); !ok) return pass(ok);
        return http::ActionResult{204, nullptr, ""};
      });
}

}  // namespace chorus::rest
