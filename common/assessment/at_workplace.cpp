#include "common/assessment/at_workplace.h"

#include <cmath>
#include <limits>
#include <map>

#include <nlohmann/json.hpp>

#include "common/base/duration.h"
#include "common/workplace/reach.h"
#include "common/workplace/view.h"

namespace chorus::assessment {
namespace {

using nlohmann::json;
using workplace::Scene;

double shared(double sum, double count) { return count > 0.0 ? sum / count : 0.0; }

double rounded_to(double value, double step) { return std::round(value / step) * step; }

PointReached reached_by(const WorkplaceInput& person, bool left, const workplace::ScenePoint& point,
                        const Scene& scene) {
  PointReached out{point.name, left};
  out.nearest = std::numeric_limits<double>::infinity();
  double count = 0.0;
  std::map<std::string, double> blocked;
  for (const ergonomics::BodyAt& body : person.bodies) {
    if (body.carried) continue;
    const auto reach = reach_of({body.body, left, nullptr}, point.at, scene);
    if (!reach.known) continue;
    ++count;
    out.nearest = std::min(out.nearest, reach.distance);
    out.arm += reach.arm.probability > 0.5 ? 1.0 : 0.0;
    out.leaning += reach.leaning.probability > 0.5 ? 1.0 : 0.0;
    if (!reach.blocked_by.empty()) ++blocked[reach.blocked_by];
  }
  out.arm = shared(out.arm, count);
  out.leaning = shared(out.leaning, count);
  for (const auto& [name, times] : blocked) {
    if (times > 0.5 * count) out.blocked_by = name;
  }
  return out;
}

void watch_targets(const WorkplaceInput& person, const Scene& scene, AtWorkplace& out) {
  std::vector<Eigen::Vector3d> places;
  for (const auto& point : scene.points) {
    out.seen.push_back({point.name});
    places.push_back(point.at);
  }
  for (const auto& box : scene.boxes) {
    if (box.obstacle) continue;
    out.seen.push_back({box.name});
    places.push_back(box.centre);
  }
  double count = 0.0;
  for (const ergonomics::BodyAt& body : person.bodies) {
    const auto gaze = body.carried ? workplace::Gaze{} : workplace::gaze_of(body.body);
    if (!gaze.known) continue;
    ++count;
    out.gaze_assumed += gaze.assumed ? 1.0 : 0.0;
    for (std::size_t t = 0; t < places.size(); ++t) {
      const auto sight = sight_of(gaze, places[t], scene);
      out.seen[t].in_view += sight.probability;
      out.seen[t].hidden += sight.hidden_by.empty() ? 0.0 : 1.0;
    }
  }
  out.gaze_assumed = shared(out.gaze_assumed, count);
  for (TargetSeen& target : out.seen) {
    target.in_view = shared(target.in_view, count);
    target.hidden = shared(target.hidden, count);
  }
}

PropPath carried(const WorkplaceInput& person, const workplace::HeldMark& mark,
                 const workplace::Prop& prop) {
  PropPath path{prop.name, {}};
  workplace::HeldProp held(prop);
  for (const ergonomics::BodyAt& body : person.bodies) {
    const double at = seconds(body.at - person.start);
    if (body.carried || at < mark.from || at > mark.until) continue;
    if (const auto pose = held.follow(body.at, body.body)) path.places.push_back({at, *pose});
  }
  return path;
}

json place_json(const PropPath::At& at) {
  const Eigen::Vector3d& place = at.pose.world_from_prop.translation();
  return {{"seconds", rounded_to(at.seconds, 1e-3)},
          {"metres",
           {rounded_to(place.x(), 1e-4), rounded_to(place.y(), 1e-4), rounded_to(place.z(), 1e-4)}},
          {"sigmaMetres", rounded_to(at.pose.sigma, 1e-4)}};
}

}  // namespace

AtWorkplace at_workplace(const WorkplaceInput& person, const Scene& scene) {
  AtWorkplace out;
  for (const workplace::ScenePoint& point : scene.points) {
    for (const bool left : {true, false})
      out.reached.push_back(reached_by(person, left, point, scene));
  }
  watch_targets(person, scene, out);
  for (const workplace::HeldMark& mark : scene.held) {
    if (mark.person && *mark.person != person.id) continue;
    out.props.push_back(carried(person, mark, scene.props[mark.prop]));
  }
  return out;
}

json workplace_json(const AtWorkplace& found) {
  json out{{"reach", json::array()}, {"view", json::array()}, {"props", json::array()}};
  for (const PointReached& point : found.reached) {
    json one{{"target", point.name},
             {"hand", point.left ? "left" : "right"},
             {"armShare", rounded_to(point.arm, 1e-3)},
             {"leaningShare", rounded_to(point.leaning, 1e-3)}};
    if (std::isfinite(point.nearest)) one["nearestMetres"] = rounded_to(point.nearest, 1e-3);
    if (!point.blocked_by.empty()) one["blockedBy"] = point.blocked_by;
    out["reach"].push_back(std::move(one));
  }
  for (const TargetSeen& target : found.seen)
    out["view"].push_back({{"target", target.name},
                           {"inView", rounded_to(target.in_view, 1e-3)},
                           {"hiddenShare", rounded_to(target.hidden, 1e-3)}});
  for (const PropPath& path : found.props) {
    json one{{"prop", path.name}, {"instants", path.places.size()}};
    if (!path.places.empty()) {
      one["takenUp"] = place_json(path.places.front());
      one["putDown"] = place_json(path.places.back());
    }
    out["props"].push_back(std::move(one));
  }
  out["gazeAssumed"] = rounded_to(found.gaze_assumed, 1e-3);
  return out;
}

}  // namespace chorus::assessment
