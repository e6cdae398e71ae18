// Sensors that report what is not there: ghosts, shifted places, crowds, coat stands.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "tests/bench/faults/guest.h"
#include "tests/bench/faults/trial.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr int kHonest = 3;
constexpr int kRing = 4;
constexpr double kNear = 0.3;  // largest distance from the person to the nearest fused body [m]

Eigen::Vector3d truth_at(Timestamp instant) {
  return person_at(instant)[JointId::SpineBase].position;
}

/// Distance from the person to the nearest fused body [m].
double error_of(const FusedInstant& frame) {
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& place : frame.places)
    least = std::min(least, (place - truth_at(frame.instant)).norm());
  return least;
}

std::vector<double> errors(const std::vector<FusedInstant>& seen, Timestamp from, Timestamp to) {
  std::vector<double> out;
  for (const FusedInstant& each : seen) {
    if (each.received >= from && each.received < to) out.push_back(error_of(each));
  }
  return out;
}

BodyFrame moved(BodyFrame body, const Eigen::Vector3d& by) {
  for (Joint& joint : body.skeleton.joints) joint.position += by;
  return body;
}

/// Ids of the bodies that are less than kNear from the person.
std::set<std::uint64_t> ids_near_person(const std::vector<FusedInstant>& seen, Timestamp from,
                                        Timestamp to) {
  std::set<std::uint64_t> out;
  for (const FusedInstant& each : seen) {
    if (each.received < from || each.received >= to) continue;
    for (std::size_t i = 0; i < each.places.size(); ++i) {
      const double off = (each.places[i] - truth_at(each.instant)).norm();
      if (off < kNear) out.insert(each.bodies[i]);
    }
  }
  return out;
}

/// Turns the truth into what a liar reports, once the cell has settled.
using Lie = std::function<Guest::Said(Timestamp now, Guest::Said truth)>;

struct Liars {
  explicit Liars(int count, const Lie& lie) {
    for (int i = 0; i < count; ++i) {
      const auto place = place_of(kHonest + i, kHonest + count);
      guests.push_back(
          std::make_unique<Guest>(fmt::format("liar{}", i + 1), [this, place, lie](Timestamp when) {
            auto truth = honest(place, when);
            return lying ? lie(when, std::move(truth)) : truth;
          }));
    }
  }
  [[nodiscard]] CellPlan plan() const {
    CellPlan plan;
    plan.sensors = kHonest;
    for (std::size_t i = 0; i < guests.size(); ++i)
      plan.neighbours.push_back(
          {guests[i]->id(), guests[i]->port(), kHonest + static_cast<int>(i)});
    return plan;
  }

  std::atomic<bool> lying = false;
  std::vector<std::unique_ptr<Guest>> guests;
};

struct Lied {
  std::vector<FusedInstant> seen;
  Timestamp calm;
  Timestamp begun;
  Timestamp end;
};

Result<Lied> lie_to(Trial& trial, Liars& liars, double duration) {
  auto cell = Cell::start(liars.plan());
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(0.5);
  Lied out;
  out.calm = now();
  wait_for(1.5);
  out.begun = now();
  liars.lying = true;
  wait_for(duration);
  out.end = now();
  out.seen = watch.seen();
  trial.check_others(*cell, account_of(out.seen, out.begun, out.end), {"s1", "s2", "s3"});
  return out;
}

/// Checks that at most 1 % of the frames have a second person, and that the first person stays in
/// place and keeps the id.
Result<void> no_second_person(Trial& trial, const Lie& lie) {
  Liars liars(1, lie);
  const auto lied = lie_to(trial, liars, 6.0);
  if (!lied) return pass(lied);
  const double several = account_of(lied->seen, lied->begun, lied->end).several_percent;
  trial.check(several <= 1.0, fmt::format("a second person in {:.0f} % of the frames", several));
  const auto off = errors(lied->seen, lied->begun, lied->end);
  const auto astray = std::ranges::count_if(off, [](double e) { return !(e < kNear); });
  trial.check(astray == 0, fmt::format("frames without the person in its place: {}", astray));
  const auto ids = ids_near_person(lied->seen, lied->calm, lied->end);
  trial.check(ids.size() == 1, fmt::format("ids of the person: {}", ids.size()));
  return {};
}

/// The time, in the minute before `when`, at which the person was farthest from its position two
/// seconds after `when`.
Timestamp furthest_before(Timestamp when) {
  constexpr int kLookedBack = 60;  // [s]
  const Eigen::Vector3d soon = truth_at(when + std::chrono::seconds(2));
  Timestamp out = when;
  for (int i = 0; i < kLookedBack; ++i) {
    const Timestamp then = when - std::chrono::seconds(i);
    if ((truth_at(then) - soon).norm() > (truth_at(out) - soon).norm()) out = then;
  }
  return out;
}

Result<void> ghost_repeats(Trial& trial) {
  const auto old = std::make_shared<std::optional<Timestamp>>();
  return no_second_person(trial, [old](Timestamp when, Guest::Said truth) {
    if (!*old) *old = furthest_before(when);
    truth.bodies = honest(place_of(kHonest, kHonest + 1), **old).bodies;
    for (BodyFrame& body : truth.bodies) body.captured = when;
    return truth;
  });
}

Result<void> ghost_at(Trial& trial, const Eigen::Vector3d& by) {
  return no_second_person(trial, [by](Timestamp, Guest::Said truth) {
    for (BodyFrame& body : truth.bodies) body = moved(body, by);
    return truth;
  });
}

Result<void> ghost_beside(Trial& trial) { return ghost_at(trial, {1.0, 0, 0}); }

Result<void> ghost_far(Trial& trial) {
  return no_second_person(trial, [](Timestamp, Guest::Said truth) {
    for (BodyFrame& body : truth.bodies) {
      for (Joint& joint : body.skeleton.joints) joint.position = {0, 0, 9999.9};
    }
    return truth;
  });
}

Result<void> liar(Trial& trial, double by) {
  constexpr double kMaxWorse = 0.030;  // p95 [m]
  Liars liars(1, [by](Timestamp, Guest::Said truth) {
    for (BodyFrame& body : truth.bodies) body = moved(body, {by, 0, 0});
    return truth;
  });
  const auto lied = lie_to(trial, liars, 5.0);
  if (!lied) return pass(lied);
  const double before = percentile(errors(lied->seen, lied->calm, lied->begun), 0.95);
  const double after = percentile(errors(lied->seen, lied->begun, lied->end), 0.95);
  trial.check(after - before <= kMaxWorse,
              fmt::format("the pelvis is off by {:.0f} mm more (p95): {:.0f} to {:.0f}",
                          1e3 * (after - before), 1e3 * before, 1e3 * after));
  return {};
}

Result<void> liar_tenth(Trial& trial) { return liar(trial, 0.1); }

Result<void> crowds(Trial& trial) {
  constexpr int kBodies = 63;
  Liars liars(2, [](Timestamp, Guest::Said truth) {
    const BodyFrame first = truth.bodies.front();
    for (int i = 0; i < kBodies; ++i) {
      BodyFrame other = moved(first, {0.8 * (i % 8) - 3.2, 0, 0.8 * (i / 8) + 1.0});
      other.id = BodyId{static_cast<std::uint64_t>(i + 2)};
      truth.bodies.push_back(other);
    }
    return truth;
  });
  const auto lied = lie_to(trial, liars, 6.0);
  if (!lied) return pass(lied);
  const auto off = errors(lied->seen, lied->begun, lied->end);
  const auto astray = std::ranges::count_if(off, [](double e) { return !(e < kNear); });
  trial.check(astray == 0, fmt::format("frames without the person in its place: {}", astray));
  return {};
}

/// A sensor that sees a person who never moves: no registration can place it, however often one
/// tries.
Result<void> coat_stand(Trial& trial) {
  constexpr std::int64_t kMaxVersions = 3;
  const auto place = place_of(3, kRing);
  Guest guest("x", [&](Timestamp when) {
    // The person's pose at a fixed time.
    auto said = honest(place, Timestamp(std::chrono::hours(1)));
    said.captured = when;
    for (BodyFrame& body : said.bodies) body.captured = when;
    return said;
  });
  CellPlan plan{.sensors = kHonest, .neighbours = {{"x", guest.port()}}};
  plan.stored = true;
  plan.fusion = {"registration.seconds=8", "registration.good_duration_s=6"};
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(0.5);
  const Timestamp begun = now();
  const auto before = cell->json("/registration").value("version", std::int64_t{0});
  wait_for(14.0);
  const auto told = cell->json("/registration");
  const auto versions = told.value("version", std::int64_t{0}) - before;
  trial.check(told.value("verdict", "") == "Good",
              fmt::format("the verdict stays Good: {}", told.value("verdict", "none")));
  trial.check(versions <= kMaxVersions, fmt::format("versions in 14 s: {}", versions));
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), {"s1", "s2", "s3"});
  return {};
}

}  // namespace

FaultCases lie_cases() {
  return {
      {"ghost-repeats", "a fourth sensor repeats old coordinates", ghost_repeats},
      {"ghost-beside", "a fourth sensor sees the person a metre beside", ghost_beside},
      {"ghost-far", "a fourth sensor sees everything 9999.9 m away", ghost_far},
      {"liar-100mm", "a fourth sensor is off by 0.1 m", liar_tenth},
      {"crowds", "two more sensors see 64 people each", crowds},
      {"coat-stand", "a fourth sensor without a place sees a coat stand", coat_stand},
  };
}

}  // namespace chorus::bench
