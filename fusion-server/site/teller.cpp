#include "fusion-server/site/teller.h"

#include <algorithm>
#include <bit>

#include "fusion-server/site/site.h"

namespace chorus::site {
namespace {

constexpr double kLongestStep = 0.2;  // [s] that one instant counts in a build
/// How long somebody who is not published is remembered: as long as `since` and the build matter.
constexpr Duration kRemembered = std::chrono::seconds(60);

double views_of(const FusedBody& body) {
  int most = 1;
  for (const std::uint64_t each : body.contributors) most = std::max(most, std::popcount(each));
  return most;
}

/// The joints that sensors show now: lengths that are only expected are no evidence.
Located shown(const FusedBody& body) {
  Located points;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Joint& joint = body.skeleton.joints[i];
    if (joint.seen() && !(body.age[i] > 0)) points[i] = joint.position;
  }
  return points;
}

Eigen::Matrix3d stated_error(const FusedBody& body) {
  constexpr std::size_t kPelvis = index_of(JointId::SpineBase);
  const Covariance& covariance = body.skeleton.joints[kPelvis].covariance;
  if (covariance.known()) return covariance.matrix();
  return body.variance[kPelvis] * Eigen::Matrix3d::Identity();
}

Person person_of(const FusedBody& body) {
  Person person;
  person.body = body.id;
  person.joints = points_of(body.skeleton);
  person.place = body.skeleton[JointId::SpineBase].position;
  person.covariance = stated_error(body);
  if (body.motion) person.velocity = (*body.motion)[index_of(JointId::SpineBase)].velocity;
  person.sides = body.sides_confidence;
  if (body.carried_for) person.carried = from_seconds(*body.carried_for);
  return person;
}

}  // namespace

CellPeople Teller::tell(const Snapshot& snapshot) {
  CellPeople told{cell_, boot_, snapshot.sequence, snapshot.instant, {}};
  for (const FusedBody& body : snapshot.bodies) {
    if (!body.skeleton[JointId::SpineBase].seen()) continue;
    Person person = person_of(body);
    const auto [at, fresh] =
        known_.try_emplace(body.id, Known{snapshot.instant, snapshot.instant, {}});
    Known& known = at->second;
    const double elapsed = std::clamp(seconds(snapshot.instant - known.last), 0.0, kLongestStep);
    if (!body.carried_for && elapsed > 0)
      known.build.add(associate::spans_of(shown(body), views_of(body)), elapsed);
    known.last = snapshot.instant;
    person.since = known.since;
    person.lengths = associate::stated(known.build);
    told.people.push_back(std::move(person));
  }
  std::erase_if(
      known_, [&](const auto& each) { return snapshot.instant - each.second.last > kRemembered; });
  return told;
}

void name(CellPeople& people, const Decision& decision) {
  for (Person& person : people.people) {
    const auto named = std::ranges::find(decision.people, person.body, &Named::body);
    if (named == decision.people.end()) continue;
    person.site_id = named->id;
    person.site_certainty = named->certainty;
    person.named = named->since;
  }
}

}  // namespace chorus::site
