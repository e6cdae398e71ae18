// Worn sensors as witnesses: which side of a person is the left one, and who is who.  Simulated
// Kinects with true places, people who exercise while they walk, thirteen simulated sensors with
// skin on the first of them.
#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "common/body/bones.h"
#include "common/synthetic/exercise.h"
#include "common/synthetic/simulated_suit.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/judge/crowd.h"
#include "tests/judge/judge.h"

namespace chorus::bench {
namespace {

constexpr double kWornLength = 60.0;  // [s]
constexpr double kJudgedFrom = 25.0;  // [s]; until then sensors calibrate
constexpr double kHere = 0.6;         // [m] from a person's true place to a body that may be theirs

/// How the sensors take part.
enum class Wears { Nothing, Steering, Witness };

struct WitnessScore {
  double judged = 0.0;
  double wrong_sides = 0.0;
  double wrong_ids = 0.0;
  double changes = 0.0;  ///< Of the wearer's id.
};

pipeline::InertialLane suit_lane_of(const Workshop& workshop) {
  synthetic::SimulatedSuit suit{workshop.scene,        0, synthetic::limbs_of_suit(13), 50.0,
                                workshop.setting.seed, {}};
  suit.errors.skin = 1.0;
  return {"suit",
          [suit, begin = workshop.begin,
           next = std::uint64_t{0}]() mutable -> Result<std::optional<inertial::InertialFrame>> {
            const double time = static_cast<double>(next) / suit.rate_hz;
            if (time > kWornLength) return std::nullopt;
            auto frame = suit_at(suit, begin, begin + from_seconds(time), next++);
            frame.source = *SensorId::parse("suit");
            return frame;
          }};
}

pipeline::OfflineInput input_of_draw(const Workshop& workshop, Wears wears) {
  pipeline::OfflineInput input;
  for (const registration::WalkTrack& track : workshop.tracks) {
    input.sensors.push_back(track.sensor);
    input.lanes.push_back({track.sensor.str(),
                           [&frames = track.frames,
                            next = std::size_t{0}]() mutable -> Result<std::optional<SensorFrame>> {
                             if (next == frames.size()) return std::nullopt;
                             return frames[next++];
                           }});
  }
  if (wears != Wears::Nothing) input.inertial.push_back(suit_lane_of(workshop));
  return input;
}

Eigen::Vector2d on_floor(const Skeleton<WorldSpace>& body) {
  const Joint& neck = body[JointId::SpineShoulder];
  return neck.seen() ? Eigen::Vector2d(neck.position.x(), neck.position.z())
                     : Eigen::Vector2d::Constant(1e9);
}

/// Whether shoulders and hips are nearer to those of the other side.
bool has_sides_wrong(const Skeleton<WorldSpace>& body, const Skeleton<WorldSpace>& exact) {
  double straight = 0.0;
  double crossed = 0.0;
  for (const JointId left : {JointId::ShoulderLeft, JointId::HipLeft}) {
    for (const JointId id : {left, mirror(left)}) {
      if (!body[id].seen()) continue;
      straight += (body[id].position - exact[id].position).norm();
      crossed += (body[id].position - exact[mirror(id)].position).norm();
    }
  }
  return crossed < straight;
}

/// Judges the wearer, who is the first person.
class WitnessJudge {
 public:
  explicit WitnessJudge(const Workshop& workshop)
      : workshop_(workshop), master_(workshop.tracks.front().sensor) {}

  void take(const Snapshot& snapshot) {
    const double time = seconds(snapshot.instant - workshop_.begin);
    const auto exact = true_body(workshop_, 0, snapshot.instant, master_);
    const FusedBody* found = nullptr;
    double nearest = kHere;
    for (const FusedBody& body : snapshot.bodies) {
      const double off = (on_floor(body.skeleton) - on_floor(exact)).norm();
      if (off >= nearest) continue;
      nearest = off;
      found = &body;
    }
    if (found == nullptr || others_are_near(exact, snapshot.instant)) return;
    if (time < kJudgedFrom || !own_) {
      own_ = last_ = found->id;
      return;
    }
    score_.judged += 1.0;
    score_.wrong_sides += has_sides_wrong(found->skeleton, exact) ? 1.0 : 0.0;
    score_.wrong_ids += found->id != *own_ ? 1.0 : 0.0;
    score_.changes += found->id != *last_ ? 1.0 : 0.0;
    last_ = found->id;
  }
  [[nodiscard]] const WitnessScore& score() const { return score_; }

 private:
  /// Then it cannot be said whose body it is.
  [[nodiscard]] bool others_are_near(const Skeleton<WorldSpace>& exact, Timestamp instant) const {
    for (std::size_t p = 1; p < workshop_.scene.people.size(); ++p) {
      const auto other = true_body(workshop_, p, instant, master_);
      if ((on_floor(other) - on_floor(exact)).norm() < 2.0 * kHere) return true;
    }
    return false;
  }

  const Workshop& workshop_;
  SensorId master_;
  std::optional<PersonId> own_;
  std::optional<PersonId> last_;
  WitnessScore score_;
};

Result<WitnessScore> witness_score(const Workshop& workshop, Wears wears) {
  pipeline::OfflineConfig config;
  config.worn.enabled = config.pipeline.fusion.inertial.enabled = wears != Wears::Nothing;
  // With an even chance to mislead, a witness says nothing.
  if (wears == Wears::Steering) config.pipeline.sides.worn.misleads = 0.5;
  WitnessJudge judge(workshop);
  const Registration places = true_registration(workshop, workshop.tracks.front().sensor);
  const auto done = pipeline::fuse_recordings(input_of_draw(workshop, wears), places, config,
                                              [&](const Snapshot& snapshot) -> Result<void> {
                                                judge.take(snapshot);
                                                return {};
                                              });
  if (!done) return pass(done);
  return judge.score();
}

struct WitnessPlan {
  const char* name;
  std::vector<Eigen::Isometry3d> places;
  bool crossing;  ///< Two alike who meet, instead of one person.
};

Workshop witness_draw(const WitnessPlan& plan, std::uint64_t seed) {
  Setting setting;
  setting.seed = seed;
  setting.places = plan.places;
  setting.length = from_seconds(kWornLength);
  synthetic::WalkerScript script;
  script.seed = seed;
  setting.people =
      plan.crossing ? crossing_people(2, seed, 0.3) : synthetic::make_people(script, 1);
  // Each at a time of their own: nobody moves like another.
  for (std::size_t p = 0; p < setting.people.size(); ++p)
    setting.people[p] = [person = setting.people[p],
                         later = from_seconds(17.0 * static_cast<double>(p))](Duration at) {
      return synthetic::exercised(person(at), at + later);
    };
  return draw_workshop(std::move(setting));
}

void add_witness(WitnessScore& sum, const WitnessScore& more) {
  sum.judged += more.judged;
  sum.wrong_sides += more.wrong_sides;
  sum.wrong_ids += more.wrong_ids;
  sum.changes += more.changes;
}

Result<void> watch_witness(Report& report, const WitnessPlan& plan) {
  const std::map<Wears, const char*> kinds{
      {Wears::Nothing, "alone"}, {Wears::Steering, "steering"}, {Wears::Witness, "witness"}};
  std::map<Wears, WitnessScore> scores;
  for (std::uint64_t seed = 1; seed <= (report.quick() ? 1U : 4U); ++seed) {
    const Workshop workshop = witness_draw(plan, seed);
    for (const auto& [wears, kind] : kinds) {
      if (plan.crossing && wears == Wears::Steering) continue;
      const auto score = witness_score(workshop, wears);
      if (!score) return pass(score);
      add_witness(scores[wears], *score);
    }
  }
  for (const auto& [wears, score] : scores) {
    const std::string name = fmt::format("witness-{}-{}", plan.name, kinds.at(wears));
    const double judged = std::max(1.0, score.judged);
    report.row(name, "wrong_sides_percent", 100.0 * score.wrong_sides / judged, "%");
    report.row(name, "wrong_id_percent", 100.0 * score.wrong_ids / judged, "%");
    report.row(name, "id_changes", score.changes, "");
    report.row(name, "judged", score.judged, "instants");
  }
  const WitnessScore& without = scores.at(Wears::Nothing);
  const WitnessScore& with = scores.at(Wears::Witness);
  report.condition(fmt::format("witness-{}: sides no worse than without", plan.name),
                   with.wrong_sides * without.judged <= without.wrong_sides * with.judged + 1e-9);
  report.condition(fmt::format("witness-{}: ids no worse than without", plan.name),
                   with.wrong_ids * without.judged <= without.wrong_ids * with.judged + 1e-9);
  return {};
}

}  // namespace

Result<void> run_witness(Report& report) {
  const auto ring = ring_places(synthetic::Ring{});
  const std::array plans{WitnessPlan{"one-sensor", {ring[0]}, false},
                         WitnessPlan{"neighbours", {ring[0], ring[1]}, false},
                         WitnessPlan{"crossing", {ring[0], ring[1]}, true}};
  for (const WitnessPlan& plan : plans) {
    if (auto ok = watch_witness(report, plan); !ok) return ok;
  }
  return {};
}

}  // namespace chorus::bench
