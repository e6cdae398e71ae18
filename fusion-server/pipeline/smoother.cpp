#include "fusion-server/pipeline/smoother.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "fusion-server/facing/later_sides.h"
#include "fusion-server/fusion/smoothing.h"

namespace chorus::pipeline {
namespace {

using Perceptions = std::deque<Perception>;

/// What happened to the sides of somebody at the oldest instant and after it, as far as it is
/// waiting; none if their sides were not resolved then.
std::vector<facing::SidesStep> course_of_sides(const Perceptions& waiting, PersonId person) {
  std::vector<facing::SidesStep> steps;
  for (const Perception& each : waiting) {
    const auto step = each.sides.find(person);
    if (step != each.sides.end()) steps.push_back(step->second);
    if (steps.empty() || !each.tracked.contains(person)) break;
  }
  return steps;
}

std::vector<fusion::BodyAt> course_of(const std::deque<Step>& fused, PersonId person) {
  std::vector<fusion::BodyAt> course;
  for (const Step& step : fused) {
    const auto& bodies = step.snapshot.bodies;
    const auto body = std::ranges::find(bodies, person, &FusedBody::id);
    if (body == bodies.end()) break;
    course.push_back({step.snapshot.instant, &*body});
  }
  return course;
}

}  // namespace

Perception perception_of(const Inputs& in, std::vector<SensorId> sensors, const Perceived& seen) {
  Perception now{in, std::move(sensors), seen.people, seen.reports, {}, {}};
  now.registration_version = seen.registration_version;
  now.corrections = seen.corrections;
  now.hands = seen.hands;
  for (const associate::Track& track : seen.memory.tracks.people) now.tracked.insert(track.id);
  for (const auto& [person, sides] : seen.memory.sides.people) {
    if (sides.seen == in.instant) now.sides.emplace(person, sides.filter.step());
  }
  return now;
}

std::vector<Step> Smoother::take(Perception now, const PipelineConfig& config) {
  const Timestamp instant = now.in.instant;
  if (instant <= newest_) *this = Smoother();  // the clock was set back
  newest_ = instant;
  waiting_.push_back(std::move(now));
  while (!waiting_.empty() && instant - waiting_.front().in.instant >= config.smoothing.sides)
    fuse_oldest(config);
  std::vector<Step> done;
  while (!fused_.empty() && fused_.back().snapshot.instant - fused_.front().snapshot.instant >=
                                config.smoothing.bodies)
    done.push_back(smooth_oldest());
  return done;
}

void Smoother::amend(Perception better) {
  const auto found = std::ranges::find(waiting_, better.in.instant,
                                       [](const Perception& each) { return each.in.instant; });
  if (found != waiting_.end()) *found = std::move(better);
}

std::vector<Step> Smoother::finish(const PipelineConfig& config) {
  while (!waiting_.empty()) fuse_oldest(config);
  std::vector<Step> done;
  while (!fused_.empty()) done.push_back(smooth_oldest());
  return done;
}

void Smoother::settle_sides(Person& person, double change_odds) {
  const auto steps = course_of_sides(waiting_, person.id);
  if (steps.empty()) return;
  const double right = facing::right_afterwards(steps).front();
  const auto known = exchanged_.find(person.id);
  const auto before = known == exchanged_.end() ? std::nullopt : std::optional(known->second);
  const bool wrong = facing::exchanged_afterwards(steps.front(), right, before, change_odds);
  if (wrong) facing::exchange_sides(person);
  person.sides_confidence = wrong ? 1.0 - right : right;
  exchanged_[person.id] = wrong;
}

void Smoother::fuse_oldest(const PipelineConfig& config) {
  Perceived seen;
  for (Person& person : waiting_.front().people) settle_sides(person, config.sides.change_odds);
  std::erase_if(exchanged_,
                [&](const auto& each) { return !waiting_.front().tracked.contains(each.first); });
  Perception now = std::move(waiting_.front());
  waiting_.pop_front();
  seen.people = std::move(now.people);
  weigh(seen.people, config.quality);
  seen.reports = std::move(now.reports);
  seen.registration_version = now.registration_version;
  seen.hands = std::move(now.hands);
  seen.memory = std::move(memory_);
  seen.memory.fusion.keep_only(now.tracked);
  forget(now.corrections, seen.memory);
  fused_.push_back(fuse(std::move(seen), now.in, std::move(now.sensors), config));
  memory_ = std::exchange(fused_.back().memory, {});
}

Step Smoother::smooth_oldest() {
  Step step = fused_.front();
  for (FusedBody& body : step.snapshot.bodies) {
    body = fusion::smoothed(course_of(fused_, body.id));
    body.smoothed_over = seconds(newest_ - step.snapshot.instant);
  }
  fused_.pop_front();
  return step;
}

}  // namespace chorus::pipeline
