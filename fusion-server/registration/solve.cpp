#include "fusion-server/registration/registration.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include <fmt/format.h>

#include "common/geometry/error_radius.h"
#include "fusion-server/registration/adjoint.h"
#include "fusion-server/registration/adjustment.h"
#include "fusion-server/registration/consensus.h"
#include "fusion-server/registration/guessed_depth.h"
#include "fusion-server/registration/impossible_place.h"
#include "fusion-server/registration/known_places.h"
#include "fusion-server/registration/pair_registration.h"
#include "fusion-server/registration/partners.h"
#include "fusion-server/registration/transform_graph.h"

namespace chorus::registration {
namespace {

/// Why two sensors have no edge.
struct Refusal {
  SensorId target;
  SensorId source;
  Error error;
};

/// All intermediate results between the walk and the verdict.
struct Work {
  const std::vector<WalkTrack>& walk;
  const RegistrationConfig& config;
  const Stopped& stopped;
  std::map<SensorId, Walker> walkers;
  std::map<SensorId, const WalkTrack*> tracks;
  std::vector<Refusal> refusals;
  std::set<SensorId> outcasts;  ///< They contradict the others; the reason is noted.
  Registration result;
  bool doubtful = false;  ///< True if there is a doubt that concerns all places.
  bool floor_guessed = false;

  void doubt(std::string reason) {
    doubtful = true;
    note(std::move(reason));
  }
  /// Adds a doubt about the place of one sensor, or why it has none; the others stay good.
  void doubt(const SensorId& sensor, std::string reason) {
    result.verdicts[sensor].reasons.push_back(reason);
    note(std::move(reason));
  }

 private:
  void note(std::string reason) {
    if (std::ranges::find(result.reasons, reason) == result.reasons.end())
      result.reasons.push_back(std::move(reason));
  }
};

void reduce_tracks(Work& work) {
  for (const WalkTrack& track : work.walk) {
    if (!work.tracks.emplace(track.sensor, &track).second) continue;
    work.walkers.emplace(track.sensor, walker_of(track, work.config));
  }
}

void register_pairs(Work& work, const PairEstimator& estimate) {
  const auto attempt = [&](const SensorPair& pair) {
    auto edge = estimate(work.walkers.at(pair.first), work.walkers.at(pair.second));
    if (!edge) return work.refusals.push_back({pair.first, pair.second, edge.error()});
    work.result.edges.push_back(std::move(*edge));
  };
  const auto partners = partners_of(work.walkers);
  std::ranges::for_each(partners, attempt);
  std::ranges::for_each(untried_links(work.walkers, partners, work.result.edges), attempt);
}

/// Leaves out the sensors that contradict the others, and notes why.
void refuse_outcasts(Work& work) {
  if (work.config.method != PairMethod::TimedRobust) return;
  Evidence evidence;
  evidence.edges = work.result.edges;
  for (const Refusal& refusal : work.refusals) {
    if (refusal.error.code != ErrorCode::Conflict) continue;
    evidence.contradictions.push_back({refusal.target, refusal.source});
  }
  for (const auto& [sensor, walker] : work.walkers)
    evidence.middles[sensor] = middle_of(walker.trail);
  for (const Outcast& outcast : cast_out(evidence)) {
    work.outcasts.insert(outcast.sensor);
    work.doubt(outcast.sensor, outcast.reason);
  }
  work.result.edges = std::move(evidence.edges);
}

/// The sensor that reaches the most others; of equal ones that of least total error, then least id.
SensorId best_master(const Work& work) {
  SensorId best;
  std::size_t most = 0;
  double least = 0.0;
  for (const auto& [sensor, walker] : work.walkers) {
    if (work.outcasts.contains(sensor)) continue;
    const auto chains = best_chains(sensor, work.result.edges);
    double total = 0.0;
    for (const auto& [other, chain] : chains) total += chain.error;
    if (chains.size() < most || (chains.size() == most && total >= least)) continue;
    best = sensor;
    most = chains.size();
    least = total;
  }
  return best;
}

void choose_master(Work& work) {
  const auto& wanted = work.config.master;
  const bool there = wanted && work.walkers.contains(*wanted);
  if (there && !work.outcasts.contains(*wanted)) {
    work.result.master = *wanted;
    return;
  }
  if (wanted && !there) {
    work.doubt(fmt::format("the configured master {} took no part in the walk", wanted->str()));
  }
  work.result.master = best_master(work);
  if (there) {
    work.doubt(fmt::format("the configured master {} was refused: the world stands on {}",
                           wanted->str(), work.result.master.str()));
  }
}

/// The common floor of all linked sensors; none if none has one.
std::optional<FloorPlane> floor_in_master(const Work& work,
                                          const std::map<SensorId, Chain>& chains) {
  std::vector<PlacedFloor> floors;
  for (const auto& [sensor, chain] : chains) {
    const WalkFloor& own = work.walkers.at(sensor).floor;
    if (!work.config.use_floor || !own.floor) continue;
    const Eigen::Isometry3d& master_from_sensor = chain.master_from_sensor;
    const Eigen::Vector3d normal = master_from_sensor.linear() * own.floor->normal;
    const Eigen::Vector3d eye = master_from_sensor.translation();
    floors.push_back({{normal, own.floor->offset - normal.dot(eye)}, eye});
  }
  if (floors.empty()) return std::nullopt;
  return common_floor(floors);
}

/// The floor from the bodies that all sensors saw from these places, in the space of the places.
std::optional<FloorPlane> floor_by_bodies(const Work& work, const Places& places) {
  std::vector<PlacedWalk> walks;
  for (const auto& [sensor, place] : places) walks.push_back({work.tracks.at(sensor), place});
  return floor_from_bodies(walks);
}

/// A sensor in the world, with the covariance of (omega, tau) applied on the world's side.
struct Placed {
  Eigen::Isometry3d world_from_sensor = Eigen::Isometry3d::Identity();
  Matrix6 covariance = Matrix6::Zero();
};

/// Levels the world again.  Where no floor was measured, the world may have tilted while sensors
/// were adjusted.
void level_by_bodies(const Work& work, const Places& places, std::map<SensorId, Placed>& all) {
  const auto floor = floor_by_bodies(work, places);
  if (!floor) return;
  const Eigen::Isometry3d levelled = level(*floor);
  const Matrix6 turn = adjoint(levelled);
  for (auto& [sensor, place] : all) {
    place.world_from_sensor = levelled * place.world_from_sensor;
    place.covariance = (turn * place.covariance * turn.transpose()).eval();
  }
}

/// The places along the chains, on the common floor; then adjusted all together if configured.
std::map<SensorId, Placed> placed(Work& work, const std::map<SensorId, Chain>& chains) {
  std::optional<FloorPlane> guessed;
  std::optional<FloorPlane> floor = floor_in_master(work, chains);
  if (!floor) {
    work.doubt("no usable floor plane: the floor was guessed from the upright body and its feet");
    Places in_master;
    for (const auto& [sensor, chain] : chains) in_master[sensor] = chain.master_from_sensor;
    floor = guessed = floor_by_bodies(work, in_master).value_or(FloorPlane{});
    work.floor_guessed = true;
  }
  const Eigen::Isometry3d in_world = world_from_master(*floor);
  const Matrix6 turn = adjoint(in_world);
  std::map<SensorId, Placed> all;
  Places places;
  for (const auto& [sensor, chain] : chains) {
    places[sensor] = in_world * chain.master_from_sensor;
    all[sensor] = {places[sensor], turn * chain.covariance * turn.transpose()};
  }
  const bool timed = work.config.method == PairMethod::TimedRobust;
  if (chains.size() < 2 || !timed || !work.config.adjust_together) return all;
  const auto adjusted = adjust_together(
      places, {work.walkers, work.result.master, guessed, work.stopped}, work.config);
  if (!adjusted) return all;
  if (work.config.depth_bias_sigma > 0.0 || adjusted->found_bias)
    work.result.depth_bias = adjusted->depth_bias;
  for (auto& [sensor, place] : all) {
    place.world_from_sensor = adjusted->places.at(sensor);
    if (adjusted->covariances.contains(sensor)) place.covariance = adjusted->covariances.at(sensor);
  }
  if (guessed) level_by_bodies(work, adjusted->places, all);
  if (adjusted->found_bias) work.doubt(advice_on(adjusted->depth_bias));
  return all;
}

void place_sensors(Work& work) {
  const std::map<SensorId, Chain> chains = best_chains(work.result.master, work.result.edges);
  for (const auto& [sensor, found] : placed(work, chains)) {
    Extrinsics place;
    place.world_from_sensor = found.world_from_sensor;
    place.chain = chains.at(sensor).sensors;
    place.error = chains.at(sensor).error;
    const Matrix6 shift = at_point(place.world_from_sensor.translation());
    place.covariance = shift * found.covariance * shift.transpose();
    const auto up = upright(*work.tracks.at(sensor));
    const auto why = impossible(place.world_from_sensor, up, work.floor_guessed);
    if (why && sensor != work.result.master) {
      work.doubt(sensor,
                 fmt::format("sensor {} {}: its registration was refused", sensor.str(), *why));
    } else {
      work.result.sensors.emplace(sensor, std::move(place));
    }
  }
}

/// Refuses sensors whose place is too uncertain.
void refuse_wide(Work& work) {
  const std::map<SensorId, Extrinsics> all = work.result.sensors;
  for (const auto& [sensor, place] : all) {
    const double radius = radius_on_floor(place.covariance);
    if (radius <= work.config.max_position || place.chain.size() < 2) continue;
    const SensorId& neighbour = place.chain[place.chain.size() - 2];
    work.doubt(sensor,
               fmt::format("sensor {} would be placed only to within {:.2f} m, of {:.2f} m "
                           "allowed: walk where {} and {} both see you, and further to and fro",
                           sensor.str(), radius, work.config.max_position,
                           std::min(neighbour, sensor).str(), std::max(neighbour, sensor).str()));
    work.result.sensors.erase(sensor);
  }
}

bool linked(const Work& work, const SensorId& sensor) {
  return work.result.sensors.contains(sensor);
}

/// Notes why this sensor is left out: why its pairs with linked sensors were refused.
void explain_unlinked(Work& work, const SensorId& sensor) {
  if (!work.result.verdicts[sensor].reasons.empty()) return;
  std::vector<std::string> strangers;
  std::vector<std::string> reasons;
  for (const Refusal& refusal : work.refusals) {
    if (refusal.target != sensor && refusal.source != sensor) continue;
    const SensorId& other = refusal.target == sensor ? refusal.source : refusal.target;
    if (!linked(work, other)) continue;
    if (refusal.error.code == ErrorCode::NotFound) {
      strangers.push_back(other.str());
    } else {
      reasons.push_back(refusal.error.message);
    }
  }
  if (work.walkers.at(sensor).trail.frames.empty()) {
    reasons = {why_empty(work.walkers.at(sensor).trail)};
  } else if (strangers.size() == 1 && reasons.empty()) {
    const auto [first, second] = std::minmax(sensor.str(), strangers.front());
    reasons = {fmt::format("sensors {} and {} never saw the person together", first, second)};
  } else if (reasons.empty() && strangers.empty()) {
    reasons = {fmt::format("sensor {}'s pairs are all with sensors without a place", sensor.str())};
  } else if (reasons.empty()) {
    reasons = {fmt::format("sensor {} never saw the person together with any of {}", sensor.str(),
                           fmt::join(strangers, ", "))};
  }
  for (std::string& reason : reasons) work.doubt(sensor, std::move(reason));
}

void explain_floor(Work& work, const SensorId& sensor) {
  const WalkFloor& floor = work.walkers.at(sensor).floor;
  if (!work.config.use_floor || floor.floor) return;
  work.doubt(sensor,
             fmt::format("sensor {}: {}, so its pitch, roll and height come from the walk alone",
                         sensor.str(), floor.objection));
}

/// Length of the walk as seen by the sensor that watched it longest.
Duration duration_of(const Work& work) {
  Duration longest{};
  for (const auto& [sensor, walker] : work.walkers) {
    const auto& frames = walker.trail.frames;
    if (!frames.empty()) {
      longest = std::max(longest, frames.back().captured - frames.front().captured);
    }
  }
  return longest;
}

/// Adds a doubt if the chain of a sensor contains pairs that do not agree well.
void judge_chain(Work& work, const SensorId& sensor, const std::vector<SensorId>& chain) {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const PairwiseRegistration* edge = edge_between(work.result.edges, chain[i - 1], chain[i]);
    if (edge == nullptr || edge->rms <= work.config.good_rms) continue;
    work.doubt(
        sensor,
        fmt::format(
            "sensors {} and {} differ by {:.3f} m rms along the walk; {:.3f} m would be good",
            edge->target.str(), edge->source.str(), edge->rms, work.config.good_rms));
  }
}

void judge_accuracy(Work& work) {
  for (const auto& [sensor, place] : work.result.sensors) judge_chain(work, sensor, place.chain);
  for (const auto& [sensor, place] : work.result.sensors) {
    const double radius = radius_on_floor(place.covariance);
    if (radius <= work.config.good_position) continue;
    work.doubt(
        sensor,
        fmt::format("sensor {} is placed only to within {:.3f} m; walk longer or further out",
                    sensor.str(), radius));
  }
  // The time from the first frame to the last is always slightly less than requested.
  const Duration walked = std::chrono::round<std::chrono::seconds>(duration_of(work));
  if (walked < work.config.good_duration) {
    work.doubt(fmt::format("the walk lasted only {:.0f} s; {:.0f} s make a good registration",
                           seconds(walked), seconds(work.config.good_duration)));
  }
}

/// What few sensors agree on is no good registration of all.
void judge_majority(Work& work) {
  const std::size_t placed = work.result.sensors.size();
  if (2 * placed <= work.walkers.size())
    work.doubt(fmt::format("only {} of {} sensors have a place", placed, work.walkers.size()));
}

/// Sets the verdict of each sensor by the doubts about it, and that of all placed ones together.
void pass_sentence(Work& work) {
  work.result.verdict = work.doubtful ? Verdict::Provisional : Verdict::Good;
  for (const auto& [sensor, walker] : work.walkers) {
    SensorVerdict& own = work.result.verdicts[sensor];
    const bool doubtful = work.doubtful || !own.reasons.empty();
    own.verdict = doubtful ? Verdict::Provisional : Verdict::Good;
    if (!linked(work, sensor)) {
      own.verdict = Verdict::Refused;
    } else if (doubtful) {
      work.result.verdict = Verdict::Provisional;
    }
  }
}

void judge(Work& work) {
  const std::size_t sensors = work.walkers.size();
  for (const auto& [sensor, walker] : work.walkers) {
    if (linked(work, sensor)) {
      explain_floor(work, sensor);
    } else {
      explain_unlinked(work, sensor);
    }
  }
  const bool nothing_linked = sensors > 1 && work.result.sensors.size() < 2;
  if (nothing_linked) {
    for (const auto& [sensor, walker] : work.walkers)
      work.result.verdicts[sensor].verdict = Verdict::Refused;
    work.result.verdict = Verdict::Refused;
    return;
  }
  if (sensors > 1) judge_majority(work);
  if (sensors > 1) judge_accuracy(work);
  pass_sentence(work);
}

}  // namespace

Registration solve_with(const PairEstimator& estimate, const std::vector<WalkTrack>& walk,
                        Timestamp now, const RegistrationConfig& config, const Stopped& stopped) {
  Work work{walk, config, stopped, {}, {}, {}, {}, {}, false};
  work.result.solved = now;
  reduce_tracks(work);
  if (nothing_to_solve(walk, work.result)) return work.result;
  register_pairs(work, estimate);
  refuse_outcasts(work);
  choose_master(work);
  place_sensors(work);
  refuse_wide(work);
  judge(work);
  return work.result;
}

}  // namespace chorus::registration
