#include "tests/bench/methods/contest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "common/body/bones.h"
#include "tests/bench/methods/averaging.h"
#include "tests/bench/methods/kalman.h"
#include "tests/judge/labelled_error.h"
#include "tests/judge/measures.h"

namespace chorus::bench {
namespace {

using baselines::Body;

constexpr Duration kStart = std::chrono::milliseconds(500);  // tracks are confirmed by then
constexpr Duration kTail = std::chrono::milliseconds(200);   // frames still under way at the end
constexpr double kReach = 0.6;  // [m] horizontally: a body farther away belongs to another person
constexpr Duration kFresh = std::chrono::milliseconds(100);  // largest age of a reported body

/// Mean of the seen core joints of all views; not finite without any.
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

/// The candidate whose core is nearest to the truth's, within kReach; end() if there is none.
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

/// A draw, the registration that is used for it, and the views of all people in it.
struct Stage {
  Workshop workshop;
  Registration registration;
  std::vector<Moment> moments;
  std::vector<Body> exact;       ///< The true body of the only person, at each moment.
  std::vector<Moment> confided;  ///< The same moments; joints carry their true mean squares.
  baselines::SharedErrors shared;
  std::vector<Snapshot> smoothed;  ///< Of the same moments, if asked for.

  [[nodiscard]] Body truth_at(Timestamp instant) const {
    return true_body(workshop, 0, instant, registration.master);
  }
};

/// Builds the same views again, with the true error covariances, for the lower bounds.
void confide(Stage& stage, const Period& period, const pipeline::PipelineConfig& config) {
  const Confided known = confided(stage.workshop);
  if (known.tracks.empty()) return;
  stage.confided = moments_of(known.tracks, stage.registration, period, config);
  stage.shared = {known.coloured.sensor_correlation, known.coloured.neck_correlation,
                  known.coloured.view_twice};
}

/// The draw, without the frames that a silent sensor does not send.
Workshop workshop_of(const Contest& contest) {
  Workshop workshop = draw_workshop(contest.setting);
  if (!contest.silence) return workshop;
  const Timestamp from = workshop.begin + contest.silence->after;
  std::erase_if(workshop.tracks.at(contest.silence->sensor).frames,
                [&](const SensorFrame& frame) { return frame.captured >= from; });
  return workshop;
}

/// What is made only for contenders that need it.
struct Wanted {
  bool bound = false;
  bool smoothed = false;
};

Stage stage_of(const Contest& contest, const Wanted& wanted) {
  Stage stage{workshop_of(contest), {}, {}, {}, {}, {}, {}};
  const Workshop& workshop = stage.workshop;
  stage.registration = contest.own_registration
                           ? solve(workshop.tracks, workshop.begin, {})
                           : true_registration(workshop, workshop.tracks.front().sensor);
  if (stage.registration.sensors.empty()) return stage;
  const Period period{workshop.begin + kStart, workshop.begin + contest.setting.length - kTail};
  stage.moments = moments_of(workshop.tracks, stage.registration, period, contest.pipeline);
  if (wanted.bound) confide(stage, period, contest.pipeline);
  if (wanted.smoothed)
    stage.smoothed =
        smoothed_moments(workshop.tracks, stage.registration, period, contest.pipeline);
  for (const Moment& moment : stage.moments) stage.exact.push_back(stage.truth_at(moment.instant));
  return stage;
}

/// The person at that moment, with the views as the contender gets them; none if association found
/// nobody there.
std::optional<Person> given_at(const Stage& stage, std::size_t at, const Contender& contender) {
  const Body& exact = stage.exact[at];
  if (contender.bound && stage.confided.empty()) return std::nullopt;
  const auto& people = (contender.bound ? stage.confided : stage.moments)[at].people;
  const auto person = nearest(people, exact, [](const Person& each) { return core_of(each); });
  if (person == people.end()) return std::nullopt;
  return contender.true_labels ? with_true_labels(*person, exact) : *person;
}

/// Number of views that have each joint.
std::array<std::size_t, kJointCount> views_of(const Person& person) {
  std::array<std::size_t, kJointCount> views{};
  for (const SensorView& view : person.views) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
      views[i] += view.skeleton.joints[i].seen() ? 1U : 0U;
    }
  }
  return views;
}

/// The smoothed body at that moment.
Body smoothed_at(const Stage& stage, std::size_t at) {
  const auto& bodies = stage.smoothed[at].bodies;
  const auto body = nearest(bodies, stage.exact[at], [](const FusedBody& each) {
    const Body* const only = &each.skeleton;
    return core_of(std::span(&only, 1));
  });
  return body == bodies.end() ? Body{} : body->skeleton;
}

Answers answers_of(const Stage& stage, const Contender& contender) {
  std::map<PersonId, baselines::Method> methods;
  Answers answers;
  for (std::size_t i = 0; i < stage.moments.size(); ++i) {
    Answer answer{stage.moments[i].instant, {}, stage.exact[i], {}};
    if (const auto given = given_at(stage, i, contender)) {
      answer.views = views_of(*given);
      if (contender.smoothed) {
        answer.body = smoothed_at(stage, i);
      } else if (contender.bound) {
        answer.body = baselines::linear_bound(*given, stage.shared);
      } else if (contender.told != nullptr) {
        answer.body = contender.told(*given, stage.exact[i]);
      } else {
        baselines::Method& method = methods[given->id];
        if (!method) method = contender.begin();
        answer.body = method(*given, answer.instant);
      }
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

/// Results from one sensor's views alone.
Answers answers_of_sensor(const Stage& stage, const SensorId& sensor) {
  const auto only = [&sensor](const Person& person, Timestamp) {
    const auto view = std::ranges::find(person.views, sensor, &SensorView::sensor);
    return view == person.views.end() ? Body{} : view->skeleton;
  };
  return answers_of(stage, {"one-sensor", [&] { return baselines::Method(only); }});
}

/// The sensor with the least error, chosen by the truth: better than any choice in practice.
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

/// At each instant the newest result near the person, if it is fresh, compared with the truth at
/// the time that the result states.
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
    Answer answer{instant, {}, stage.exact[i], {}};
    for (auto each = newest_first.rbegin(); each != newest_first.rend(); ++each) {
      const Body* const body = &each->body;
      if (!(distance_to(core_of(std::span(&body, 1)), stage.exact[i]) <= kReach)) continue;
      answer = {each->instant, each->body, stage.truth_at(each->instant), {}};
      break;
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

/// Mean error of each joint where it is seen [m].
auto joint_errors(const Answers& answers) {
  std::array<double, kJointCount> errors{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Mean mean;
    for (const auto& [at, body, exact, views] : answers) {
      const Joint& joint = body.joints[j];
      if (joint.seen()) mean.add((joint.position - exact.joints[j].position).norm());
    }
    errors[j] = mean.value();
  }
  return errors;
}

Scored score(std::string method, const Answers& answers) {
  Scored scored{std::move(method), {}, kNothing, joint_errors(answers)};
  for (const Metric& metric : metrics()) scored.values.push_back(metric.of(answers));
  return scored;
}

/// Scores again, only over joints that every contender reports.  A contender that reports nothing
/// in the whole draw does not count.
void score_common(std::vector<Scored>& scores, std::vector<Answers>& all) {
  const auto answers_nothing = [](const Answers& answers) { return !(coverage(answers) > 0); };
  const std::size_t count = all.empty() ? 0 : all.front().size();
  for (std::size_t at = 0; at < count; ++at) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const bool everybody = std::ranges::all_of(all, [&](const Answers& answers) {
        return answers[at].body.joints[j].seen() || answers_nothing(answers);
      });
      if (everybody) continue;
      for (Answers& answers : all) answers[at].body.joints[j] = Joint{};
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) scores[i].common = mpjpe(all[i], JointGroup::All);
}

}  // namespace

Contender ours(const fusion::FusionConfig& config, std::string name) {
  return {std::move(name), [config] { return baselines::product(config); }};
}

Contender ours_smoothed() {
  Contender contender{"ours-smoothed", {}};
  contender.smoothed = true;
  return contender;
}

Contender labelled(Contender contender) {
  contender.name += "-true-labels";
  contender.true_labels = true;
  return contender;
}

std::vector<Contender> all_contenders() {
  fusion::FusionConfig instant;
  instant.method = fusion::Method::InverseVariance;
  std::vector<Contender> contenders{ours(), ours_smoothed(), ours(instant, "inverse-variance")};
  for (const baselines::Baseline& each : baselines::all()) {
    contenders.push_back({std::string(each.name), each.begin});
  }
  contenders.push_back(labelled(ours({}, "ours")));
  for (const baselines::Baseline& each : baselines::all()) {
    const bool kept =
        each.name == "flip-fixed-mean" || each.name == "otto" || each.name == "otto-kalman";
    if (kept) contenders.push_back(labelled({std::string(each.name), each.begin}));
  }
  contenders.push_back({"oracle-weights", {}, true, baselines::error_weighted_mean});
  contenders.push_back({"bound", {}, true, nullptr, true});
  return contenders;
}

std::vector<Scored> hold(const Contest& contest, const std::vector<Contender>& contenders) {
  const Stage stage = stage_of(contest, {std::ranges::any_of(contenders, &Contender::bound),
                                         std::ranges::any_of(contenders, &Contender::smoothed)});
  std::vector<Answers> answers;
  std::vector<Scored> scores;
  for (const Contender& contender : contenders) {
    answers.push_back(answers_of(stage, contender));
    scores.push_back(score(contender.name, answers.back()));
  }
  score_common(scores, answers);
  if (contest.every_method) {
    scores.push_back(score("best-sensor", answers_of_best_sensor(stage)));
    scores.push_back(score("arrival-kalman", answers_at_arrival(stage)));
  }
  return scores;
}

Course course_of(const Contest& contest) {
  const auto stage = std::make_shared<const Stage>(stage_of(contest, {}));
  Course course;
  for (std::size_t i = 0; i < stage->moments.size(); ++i) {
    course.instants.push_back(stage->moments[i].instant);
    course.given.push_back(given_at(*stage, i, {}));
  }
  course.exact = stage->exact;
  course.truth_at = [stage](Timestamp instant) { return stage->truth_at(instant); };
  return course;
}

Skeleton<WorldSpace> exchanged(const Skeleton<WorldSpace>& body) {
  Skeleton<WorldSpace> other = body;
  for (const auto& [left, right] : kMirrorPairs) std::swap(other[left], other[right]);
  return other;
}

}  // namespace chorus::bench
