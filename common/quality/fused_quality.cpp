#include "common/quality/fused_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/quality/joint_judge.h"
#include "common/quality/sample.h"

namespace chorus::quality {
namespace {

using resource::BodyResource;
using resource::FrameResource;

constexpr double kSureSides = 0.9;
constexpr double kSamePlace = 0.25;    // [m] between two bodies that are one person
constexpr double kDoubled = 0.5;       // [s] for so long
constexpr double kHandedOn = 0.7;      // [m] a new id begins so near to where another one ended
constexpr double kHandedWithin = 1.0;  // [s] and so soon after it
constexpr double kTurnWithin = 0.2;    // [s]; nobody turns by more than 120 deg in it
constexpr std::size_t kMostMoments = 200;

double seconds_between(Timestamp from, Timestamp to) {
  return std::chrono::duration<double>(to - from).count();
}

// Mean and variance of a bone's length (Welford's recurrence).
struct Spread {
  std::size_t count = 0;
  double mean = 0.0;
  double squares = 0.0;

  void add(double value) {
    ++count;
    const double off = value - mean;
    mean += off / static_cast<double>(count);
    squares += off * (value - mean);
  }
  [[nodiscard]] BoneQuality quality() const {
    if (count < 2 || !(mean > 0.0)) return {mean, std::numeric_limits<double>::quiet_NaN()};
    return {mean, std::sqrt(squares / static_cast<double>(count - 1)) / mean};
  }
};

// From the right to the left side, on the floor.
std::optional<Eigen::Vector2d> across(const BodyResource& body) {
  const auto& joint = [&](JointId id) -> const auto& { return body.joints[index_of(id)]; };
  for (const auto& [left, right] : {MirrorPair{JointId::HipLeft, JointId::HipRight},
                                    MirrorPair{JointId::ShoulderLeft, JointId::ShoulderRight}}) {
    if (!joint(left).seen() || !joint(right).seen()) continue;
    const Eigen::Vector3d line = joint(left).position - joint(right).position;
    const Eigen::Vector2d flat(line.x(), line.z());
    if (flat.norm() > 0.05) return flat.normalized();
  }
  return std::nullopt;
}

struct Person {
  PersonQuality quality;
  std::array<JointJudge, kJointCount> joints;
  std::array<Spread, kBones.size()> bones;
  std::size_t frames = 0;
  std::size_t uncertain = 0;
  double last = 0.0;
  std::optional<Eigen::Vector3d> place;
  std::optional<Eigen::Vector2d> across;
  double across_at = 0.0;
};

// How long each pair of bodies has been in one place.
using Pairs = std::map<std::pair<std::uint64_t, std::uint64_t>, double>;

}  // namespace

struct FusedJudge::Impl {
  FusedQuality out;
  std::array<JointCounts, kJointCount> joints;
  std::map<std::uint64_t, Person> people;
  std::vector<std::uint64_t> order;
  std::map<std::string, std::size_t> contributed;
  std::size_t contributions = 0;
  std::optional<Timestamp> first;
  double last = 0.0;
  std::vector<double> steps;  // the first ten thousand tell the usual one
  std::vector<double> long_steps;
  std::size_t with_people = 0;
  Pairs pairs;

  void add(const FrameResource& frame);
  void step(double at);
  void body(const BodyResource& body, double at);
  void sides(Person& person, const BodyResource& body, double at);
  void handed_on(const Person& person, double at);
  void doubled(const FrameResource& frame, double at);
  void contributors(const FrameResource& frame);
  void moment(std::vector<Moment>& moments, Moment moment) const {
    if (moments.size() < kMostMoments) moments.push_back(std::move(moment));
  }
};

void FusedJudge::Impl::step(double at) {
  if (out.frames == 0) return;
  const double step = at - last;
  if (steps.size() < 10'000) steps.push_back(step);
  if (step > 0.1) long_steps.push_back(step);
}

void FusedJudge::Impl::add(const FrameResource& frame) {
  if (!first) first = frame.captured;
  const double at = seconds_between(*first, frame.captured);
  if (out.frames > 0 && !(at > last)) return;
  step(at);
  ++out.frames;
  if (!frame.bodies.empty()) ++with_people;
  for (const BodyResource& each : frame.bodies) body(each, at);
  for (auto& [id, person] : people)
    if (person.last < at)
      for (JointJudge& joint : person.joints) joint.absent();
  doubled(frame, at);
  contributors(frame);
  last = at;
}

void FusedJudge::Impl::body(const BodyResource& body, double at) {
  const auto [found, is_new] = people.try_emplace(body.id);
  Person& person = found->second;
  const auto& centre = body.joints[index_of(JointId::SpineBase)];
  if (centre.seen()) person.place = centre.position;
  if (is_new) {
    order.push_back(body.id);
    person.quality.id = body.id;
    person.quality.from = at;
    handed_on(person, at);
  }
  if (person.frames > 0 && at - person.last < 1.0) person.quality.seconds += at - person.last;
  person.last = person.quality.to = at;
  ++person.frames;
  const bool carried = body.carried_for.has_value();
  for (std::size_t j = 0; j < kJointCount; ++j)
    person.joints[j].add(body.joints[j], at, carried, joints[j]);
  for (std::size_t b = 0; b < kBones.size() && !carried; ++b) {
    const auto& parent = body.joints[index_of(kBones[b].parent)];
    const auto& child = body.joints[index_of(kBones[b].child)];
    if (parent.seen() && child.seen())
      person.bones[b].add((parent.position - child.position).norm());
  }
  sides(person, body, at);
}

void FusedJudge::Impl::sides(Person& person, const BodyResource& body, double at) {
  if (body.sides_confidence) {
    person.quality.least_certain_sides =
        std::min(person.quality.least_certain_sides, *body.sides_confidence);
    if (*body.sides_confidence < kSureSides) ++person.uncertain;
  }
  const auto now = across(body);
  if (!now) return;
  if (person.across && at - person.across_at < kTurnWithin && now->dot(*person.across) < -0.5)
    moment(out.turned, {at, body.id, "left and right were exchanged"});
  person.across = now;
  person.across_at = at;
}

void FusedJudge::Impl::handed_on(const Person& person, double at) {
  for (const auto& [id, other] : people) {
    const bool ended =
        id != person.quality.id && other.last < at && at - other.last < kHandedWithin;
    if (ended && other.place && person.place && (*other.place - *person.place).norm() < kHandedOn)
      moment(out.switches,
             {at, person.quality.id, "begins where person " + std::to_string(id) + " ended"});
  }
}

void FusedJudge::Impl::doubled(const FrameResource& frame, double at) {
  Pairs now;
  for (std::size_t i = 0; i < frame.bodies.size(); ++i)
    for (std::size_t k = i + 1; k < frame.bodies.size(); ++k) {
      const auto& a = frame.bodies[i].joints[index_of(JointId::SpineBase)];
      const auto& b = frame.bodies[k].joints[index_of(JointId::SpineBase)];
      if (!a.seen() || !b.seen() || (a.position - b.position).norm() > kSamePlace) continue;
      const auto pair = std::minmax(frame.bodies[i].id, frame.bodies[k].id);
      const auto before = pairs.find(pair);
      const double since = before == pairs.end() ? at : before->second;
      now[pair] = since;
      if (at - since >= kDoubled && last - since < kDoubled)
        moment(out.doubles,
               {since, pair.first, "stands in the place of person " + std::to_string(pair.second)});
    }
  pairs = std::move(now);
}

void FusedJudge::Impl::contributors(const FrameResource& frame) {
  for (const BodyResource& body : frame.bodies)
    for (const auto& joint : body.joints) {
      if (!joint.seen()) continue;
      ++contributions;
      for (std::size_t s = 0; s < frame.sensors.size() && s < 64; ++s)
        if ((joint.contributors >> s & 1U) != 0) ++contributed[frame.sensors[s]];
    }
}

FusedJudge::FusedJudge() : impl_(std::make_unique<Impl>()) {}
FusedJudge::~FusedJudge() = default;
FusedJudge::FusedJudge(FusedJudge&&) noexcept = default;

void FusedJudge::add(const FrameResource& frame) { impl_->add(frame); }

FusedQuality FusedJudge::finish() {
  Impl& all = *impl_;
  FusedQuality out = std::move(all.out);
  out.seconds = all.last;
  const double usual = all.steps.empty() ? 0.0 : quantile(all.steps, 0.5);
  out.rate = usual > 0.0 ? 1.0 / usual : 0.0;
  for (const double step : all.long_steps) {
    if (step <= 3.0 * usual) continue;
    ++out.pauses;
    out.longest_pause = std::max(out.longest_pause, step);
  }
  if (out.frames > 0)
    out.with_people = static_cast<double>(all.with_people) / static_cast<double>(out.frames);
  for (std::size_t j = 0; j < kJointCount; ++j) out.joints[j] = all.joints[j].quality();
  for (const std::uint64_t id : all.order) {
    Person& person = all.people.at(id);
    person.quality.uncertain_sides =
        static_cast<double>(person.uncertain) / static_cast<double>(person.frames);
    for (std::size_t b = 0; b < kBones.size(); ++b)
      person.quality.bones[b] = person.bones[b].quality();
    out.people.push_back(person.quality);
  }
  for (const auto& [sensor, count] : all.contributed)
    out.shares[sensor] = static_cast<double>(count) / static_cast<double>(all.contributions);
  return out;
}

}  // namespace chorus::quality
