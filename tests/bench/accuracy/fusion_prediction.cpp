#include "tests/bench/accuracy/fusion_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "common/base/units.h"
#include "fusion-server/fusion/prediction.h"
#include "fusion-server/outlet/tracker_frame.h"
#include "tests/bench/accuracy/fusion_cases.h"
#include "tests/bench/methods/comparison.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/judge/measures.h"

namespace chorus::bench {
namespace {

using Body = Skeleton<WorldSpace>;

constexpr std::size_t kQuickTakes = 2;
constexpr Duration kQuickTake = std::chrono::seconds(10);
constexpr std::size_t kSettled = 30;     // instants before the first prediction that counts
constexpr std::size_t kBlindEvery = 45;  // instants from one blindness to the next
constexpr Duration kWithin = std::chrono::seconds(1);  // after a sensor has fallen silent
constexpr double kAxes = 3.0;

struct Figure {
  std::string metric;
  std::string unit;
  std::string method;
  auto operator<=>(const Figure&) const = default;
};
using Figures = std::map<Figure, double>;

/// Means of figures.
class Tally {
 public:
  void error(const std::string& metric, const std::string& method, const Body& body,
             const Body& exact) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!body.joints[j].seen()) continue;
      const double off = (body.joints[j].position - exact.joints[j].position).norm();
      means_[{metric, "mm", method}].add(to_mm(off));
    }
  }
  void nees(const std::string& metric, const Body& body, const Body& exact) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Joint& joint = body.joints[j];
      if (!joint.seen() || !joint.covariance.known()) continue;
      const Eigen::Vector3d off = joint.position - exact.joints[j].position;
      const Eigen::Matrix3d stated = joint.covariance.matrix();
      means_[{metric, "", kOurs}].add(off.dot(stated.inverse() * off) / kAxes);
    }
  }
  [[nodiscard]] Figures figures() const {
    Figures all;
    for (const auto& [figure, mean] : means_) all[figure] = mean.value();
    return all;
  }

 private:
  std::map<Figure, Mean> means_;
};

/// Fuses the instants of a course in order.
class Fusing {
 public:
  [[nodiscard]] FusedBody at(const Person& person, Timestamp instant) {
    static const std::vector<SensorId> kNobody;
    return memory_.fuse({person}, {instant, kNobody}, {}).front();
  }

 private:
  fusion::Memory memory_;
};

Body moved(Body body, const outlet::TrackerBody& velocities, double passed) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    body.joints[j].position += passed * velocities.joints[j].velocity;
  }
  return body;
}

/// The body with velocities from instant to instant, as outputs state them if the method states
/// none.
outlet::TrackerBody steps_of(outlet::TrackerState& state, FusedBody body, Timestamp instant) {
  body.motion.reset();
  body.slot = 0;
  Snapshot snapshot;
  snapshot.instant = instant;
  snapshot.bodies = {std::move(body)};
  return state.advance(snapshot).bodies.front();
}

/// What becomes of the person while no sensor sees them.
void go_blind(Fusing fusing, const Course& course, std::size_t from, const FusedBody& last,
              Tally& tally) {
  Person unseen;
  unseen.id = last.id;
  unseen.carried = last.skeleton[JointId::SpineMid].position;
  for (std::size_t i = from + 1; i < course.instants.size(); ++i) {
    const Duration blind = course.instants[i] - course.instants[from];
    const FusedBody body = fusing.at(unseen, course.instants[i]);
    for (const int ms : {100, 500, 1000}) {
      const Duration asked = std::chrono::milliseconds(ms);
      const Duration before = course.instants[i - 1] - course.instants[from];
      if (blind < asked || before >= asked) continue;
      const std::string metric = fmt::format("blind_{}ms_mm", ms);
      tally.error(metric, kOurs, body.skeleton, course.exact[i]);
      tally.error(metric, "hold", last.skeleton, course.exact[i]);
      tally.nees(fmt::format("blind_{}ms_nees", ms), body.skeleton, course.exact[i]);
    }
    if (blind >= kWithin) return;
  }
}

Figures foreseen(const Course& course) {
  Fusing fusing;
  outlet::TrackerState state(1);
  Tally tally;
  for (std::size_t i = 0; i < course.instants.size(); ++i) {
    if (!course.given[i]) continue;
    const Timestamp instant = course.instants[i];
    const FusedBody body = fusing.at(*course.given[i], instant);
    const outlet::TrackerBody steps = steps_of(state, body, instant);
    if (i < kSettled) continue;
    tally.error("now_mm", kOurs, body.skeleton, course.exact[i]);
    tally.nees("now_nees", body.skeleton, course.exact[i]);
    for (const int ms : {50, 100}) {
      const Duration ahead = std::chrono::milliseconds(ms);
      const Body exact = course.truth_at(instant + ahead);
      const FusedBody later = fusion::predicted(body, ahead);
      const std::string metric = fmt::format("ahead_{}ms_mm", ms);
      tally.error(metric, kOurs, later.skeleton, exact);
      tally.error(metric, "hold", body.skeleton, exact);
      tally.error(metric, "steps", moved(body.skeleton, steps, seconds(ahead)), exact);
      tally.nees(fmt::format("ahead_{}ms_nees", ms), later.skeleton, exact);
    }
    if (i % kBlindEvery == 0) go_blind(fusing, course, i, body, tally);
  }
  return tally.figures();
}

std::vector<Body> bodies_of(const Course& course) {
  Fusing fusing;
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < course.instants.size(); ++i) {
    bodies.push_back(course.given[i] ? fusing.at(*course.given[i], course.instants[i]).skeleton
                                     : Body{});
  }
  return bodies;
}

/// The largest difference between a joint's change and the same joint's in `other`, within a second
/// after `from` [m].
double largest_step(const Course& course, Timestamp from, const std::vector<Body>& bodies,
                    const std::vector<Body>& other) {
  double largest = 0.0;
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    if (course.instants[i] < from || course.instants[i] > from + kWithin) continue;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto change = [&](const std::vector<Body>& of) {
        return Eigen::Vector3d(of[i].joints[j].position - of[i - 1].joints[j].position);
      };
      const bool seen = bodies[i].joints[j].seen() && bodies[i - 1].joints[j].seen() &&
                        other[i].joints[j].seen() && other[i - 1].joints[j].seen();
      if (seen) largest = std::max(largest, (change(bodies) - change(other)).norm());
    }
  }
  return largest;
}

Figures silenced(Contest contest, std::size_t draw) {
  const Course living = course_of(contest);
  contest.silence = {draw % contest.setting.places.size(), contest.setting.length / 2};
  const Course dying = course_of(contest);
  const Timestamp from = begin_of(contest.setting.seed) + contest.setting.length / 2;
  const std::vector<Body> before = bodies_of(living);
  const std::vector<Body> after = bodies_of(dying);
  return {{{"step_mm", "mm", kOurs}, to_mm(largest_step(dying, from, after, dying.exact))},
          {{"step_mm", "mm", "living"}, to_mm(largest_step(living, from, before, living.exact))},
          {{"caused_mm", "mm", kOurs}, to_mm(largest_step(dying, from, after, before))}};
}

}  // namespace

std::vector<PredictionCase> prediction_cases() {
  std::vector<PredictionCase> cases;
  for (const char* profile : {"A", "B", "C", "D"}) {
    const auto walking = [&](std::size_t sensors) {
      return contest_of(profile, sensors, synthetic::PathKind::Random);
    };
    cases.push_back({fmt::format("prediction-{}", profile), walking(6)});
    for (const std::size_t sensors : {6U, 3U}) {
      cases.push_back({fmt::format("silence-{}-{}", sensors, profile), walking(sensors), true});
    }
  }
  return cases;
}

void measure_prediction(Report& report, const PredictionCase& each) {
  const std::size_t count = report.quick() ? kQuickTakes : each.draws;
  const auto draws = over_draws(count, [&](std::size_t draw) {
    Contest contest = each.contest;
    contest.setting.seed = report.seed() + draw;
    if (report.quick()) contest.setting.length = std::min(contest.setting.length, kQuickTake);
    return each.silence ? silenced(contest, draw) : foreseen(course_of(contest));
  });
  for (const auto& [figure, unused] : draws.front()) {
    Comparison comparison(each.name, figure.metric, figure.unit);
    for (std::size_t draw = 0; draw < draws.size(); ++draw) {
      const auto found = draws[draw].find(figure);
      const double value = found == draws[draw].end() ? kNoRatio : found->second;
      comparison.add(figure.method, draw, value);
    }
    const Spread spread = comparison.spread_of(figure.method);
    report.row(
        {each.name, figure.metric, spread.median, figure.unit, figure.method, kNoRatio, spread});
  }
}

}  // namespace chorus::bench
