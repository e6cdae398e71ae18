#include "tests/bench/contest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "tests/bench/baselines/averaging.h"
#include "tests/bench/baselines/kalman.h"
#include "tests/bench/labelled_error.h"

namespace chorus::bench {
namespace {

using baselines::Body;

constexpr Duration kStart = std::chrono::milliseconds(500);  // tracks are confirmed by then
constexpr Duration kTail = std::chrono::milliseconds(200);   // frames still under way at the end
constexpr double kReach = 0.6;  // [m] horizontally: an answer further away is somebody else
constexpr Duration kFresh = std::chrono::milliseconds(100);  // of an answer stated at arrival
constexpr double kPercent = 100.0;
constexpr double kToMs = 1000.0;

constexpr std::array kMetrics{
    Metric{"mpjpe_mm", "mm", [](const Answers& a) { return to_mm(mpjpe(a, JointGroup::All)); }},
    Metric{"centre_mm", "mm", [](const Answers& a) { return to_mm(mpjpe(a, JointGroup::Centre)); }},
    Metric{"extremities_mm", "mm",
           [](const Answers& a) { return to_mm(mpjpe(a, JointGroup::Extremities)); }},
    Metric{"bias_free_mm", "mm",
           [](const Answers& a) { return to_mm(bias_free_mpjpe(a, JointGroup::All)); }},
    Metric{"jitter_core_mm", "mm",
           [](const Answers& a) { return to_mm(jitter_at_rest(a, JointGroup::Centre)); }},
    Metric{"jitter_extremity_mm", "mm",
           [](const Answers& a) { return to_mm(jitter_at_rest(a, JointGroup::Extremities)); }},
    Metric{"bone_cv_percent", "%", [](const Answers& a) { return kPercent * bone_variation(a); }},
    Metric{"jumps_per_minute", "1/min", jumps_per_minute},
    Metric{"flip_percent", "%", [](const Answers& a) { return kPercent * label_error_share(a); }},
    Metric{"latency_ms", "ms", [](const Answers& a) { return kToMs * latency(a); }},
    Metric{"missing_percent", "%", [](const Answers& a) { return kPercent * (1.0 - coverage(a)); }},
};

/// Mean of the seen core joints, of all views; not finite without any.
Eigen::Vector3d core_of(std::span<const Body* const> bodies) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const Body* body : bodies) {
    for (const JointId id : kCoreJoints) {
      if (!(*body)[id].seen()) continue;
      sum += (*body)[id].position;
      count += 1.0;
    }
  }
  return sum / count;
}

Eigen::Vector3d core_of(const Person& person) {
  std::vector<const Body*> bodies;
  for (const SensorView& view : person.views) bodies.push_back(&view.skeleton);
  return core_of(bodies);
}

double distance_to(const Eigen::Vector3d& core, const Body& exact) {
  const Body* const body = &exact;
  const Eigen::Vector3d off = core - core_of(std::span(&body, 1));
  return std::hypot(off.x(), off.z());
}

/// Of several candidates the one nearest to the truth and within reach.
template <class Candidates, class Core>
auto nearest(const Candidates& candidates, const Body& exact, const Core& core) {
  auto best = candidates.end();
  double least = kReach;
  for (auto each = candidates.begin(); each != candidates.end(); ++each) {
    const double distance = distance_to(core(*each), exact);
    if (!(distance <= least)) continue;
    best = each;
    least = distance;
  }
  return best;
}

Person with_true_labels(Person person, const Body& exact) {
  for (SensorView& view : person.views) {
    const LabelledError error = labelled_error(view.skeleton, exact);
    if (error.exchanged < error.as_given) view.skeleton = exchanged(view.skeleton);
  }
  return person;
}

/// A draw, its place in the world, and the views of everybody in it.
struct Stage {
  Workshop workshop;
  Registration registration;
  std::vector<Moment> moments;
  std::vector<Body> exact;  ///< Of the only person, at each moment.

  [[nodiscard]] Body truth_at(Timestamp instant) const {
    return true_body(workshop, 0, instant, registration.master);
  }
};

Stage stage_of(const Contest& contest) {
  Stage stage{draw_workshop(contest.setting), {}, {}, {}};
  const Workshop& workshop = stage.workshop;
  stage.registration = contest.own_registration
                           ? solve(workshop.tracks, workshop.begin, {})
                           : true_registration(workshop, workshop.tracks.front().sensor);
  if (stage.registration.sensors.empty()) return stage;
  const Timestamp end = workshop.begin + contest.setting.length;
  stage.moments = moments_of(workshop.tracks, stage.registration,
                             {workshop.begin + kStart, end - kTail}, contest.pipeline);
  for (const Moment& moment : stage.moments) stage.exact.push_back(stage.truth_at(moment.instant));
  return stage;
}

Answers answers_of(const Stage& stage, const Contender& contender) {
  std::map<PersonId, baselines::Method> methods;
  Answers answers;
  for (std::size_t i = 0; i < stage.moments.size(); ++i) {
    const Moment& moment = stage.moments[i];
    const Body& exact = stage.exact[i];
    Answer answer{moment.instant, {}, exact};
    const auto person =
        nearest(moment.people, exact, [](const Person& each) { return core_of(each); });
    if (person != moment.people.end()) {
      const Person given = contender.true_labels ? with_true_labels(*person, exact) : *person;
      baselines::Method& method = methods[person->id];
      if (!method && contender.told == nullptr) method = contender.begin();
      answer.body =
          contender.told != nullptr ? contender.told(given, exact) : method(given, moment.instant);
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

/// One sensor's views alone.
Answers answers_of_sensor(const Stage& stage, const SensorId& sensor) {
  const auto only = [&sensor](const Person& person, Timestamp) {
    const auto view = std::ranges::find(person.views, sensor, &SensorView::sensor);
    return view == person.views.end() ? Body{} : view->skeleton;
  };
  return answers_of(stage, {"one-sensor", [&] { return baselines::Method(only); }});
}

/// The sensor of least error, chosen knowing the truth: better than any that one could choose.
Answers answers_of_best_sensor(const Stage& stage) {
  Answers best;
  double least = std::numeric_limits<double>::infinity();
  for (const registration::WalkTrack& track : stage.workshop.tracks) {
    Answers answers = answers_of_sensor(stage, track.sensor);
    const double error = mpjpe(answers, JointGroup::All);
    if (!(error < least)) continue;
    least = error;
    best = std::move(answers);
  }
  return best;
}

/// At each instant the newest answer, held against the truth at the time that it states itself.
Answers answers_at_arrival(const Stage& stage) {
  const auto stated = baselines::arrival_kalman(stage.workshop.tracks, stage.registration);
  Answers answers;
  auto begin = stated.begin();
  for (std::size_t i = 0; i < stage.moments.size(); ++i) {
    const Timestamp instant = stage.moments[i].instant;
    while (begin != stated.end() && begin->instant < instant - kFresh) ++begin;
    auto end = begin;
    while (end != stated.end() && end->instant <= instant) ++end;
    const auto newest_first = std::span(begin, end);
    Answer answer{instant, {}, stage.exact[i]};
    for (auto each = newest_first.rbegin(); each != newest_first.rend(); ++each) {
      const Body* const body = &each->body;
      if (!(distance_to(core_of(std::span(&body, 1)), stage.exact[i]) <= kReach)) continue;
      answer = {each->instant, each->body, stage.truth_at(each->instant)};
      break;
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

Scored score(std::string method, const Answers& answers) {
  Scored scored{std::move(method), {}};
  for (const Metric& metric : kMetrics) scored.values.push_back(metric.of(answers));
  return scored;
}

}  // namespace

std::span<const Metric> metrics() { return kMetrics; }

Contender ours(const fusion::FusionConfig& config, std::string name) {
  return {std::move(name), [config] { return baselines::product(config); }};
}

std::vector<Contender> all_contenders() {
  std::vector<Contender> contenders{ours()};
  for (const baselines::Baseline& each : baselines::all()) {
    contenders.push_back({std::string(each.name), each.begin});
  }
  Contender labelled = ours({}, "ours-true-labels");
  labelled.true_labels = true;
  contenders.push_back(std::move(labelled));
  contenders.push_back({"oracle-weights", {}, true, baselines::error_weighted_mean});
  contenders.push_back({"bound", {}, true, baselines::nearest_mean});
  return contenders;
}

std::vector<Scored> hold(const Contest& contest, const std::vector<Contender>& contenders) {
  const Stage stage = stage_of(contest);
  std::vector<Scored> scores;
  for (const Contender& contender : contenders) {
    scores.push_back(score(contender.name, answers_of(stage, contender)));
  }
  if (contest.every_method) {
    scores.push_back(score("best-sensor", answers_of_best_sensor(stage)));
    scores.push_back(score("arrival-kalman", answers_at_arrival(stage)));
  }
  return scores;
}

Skeleton<WorldSpace> exchanged(const Skeleton<WorldSpace>& body) {
  Skeleton<WorldSpace> other = body;
  for (const auto& [left, right] : kMirrorPairs) std::swap(other[left], other[right]);
  return other;
}

}  // namespace chorus::bench
