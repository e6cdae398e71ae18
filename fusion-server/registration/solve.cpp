#include "fusion-server/registration/solve_work.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "common/base/units.h"
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

/// Each sensor's rows and columns times its own matrix.
template <class Of>
void transform(JointCovariance& together, const Of& of) {
  for (std::size_t i = 0; i < together.sensors.size(); ++i) {
    const Matrix6 own = of(together.sensors[i]);
    const auto at = static_cast<Eigen::Index>(6 * i);
    together.matrix.middleRows<6>(at) = (own * together.matrix.middleRows<6>(at)).eval();
    together.matrix.middleCols<6>(at) =
        (together.matrix.middleCols<6>(at) * own.transpose()).eval();
  }
}

/// Levels the world again.  Where no floor was measured, the world may have tilted while sensors
/// were adjusted.
void level_by_bodies(Work& work, const Places& places, std::map<SensorId, Placed>& all) {
  auto& together = work.result.together;
  const auto floor = floor_by_bodies(work, places);
  if (!floor) return;
  const Eigen::Isometry3d levelled = level(*floor);
  const Matrix6 turn = adjoint(levelled);
  for (auto& [sensor, place] : all) {
    place.world_from_sensor = levelled * place.world_from_sensor;
    place.covariance = (turn * place.covariance * turn.transpose()).eval();
  }
  if (together) transform(*together, [&](const SensorId&) { return turn; });
}

/// That no floor was measured is no doubt where no sensor could: then it is told once.
void note_guessed_floor(Work& work) {
  constexpr double kSigmas95 = 1.96;
  if (!work.config.cameras_alone)
    return work.doubt(
        "no usable floor plane: the floor was guessed from the upright body and its feet");
  work.tell(fmt::format(
      "no sensor measures the floor: it was guessed from the upright body and its feet, so that "
      "all "
      "places together may be tilted by {:.0f} deg and {:.1f} m too high or too low (95 %)",
      to_deg(kSigmas95 * kGuessedFloor.tilt), kSigmas95 * kGuessedFloor.height));
}

/// The places along the chains, on the common floor; then adjusted all together if configured.
std::map<SensorId, Placed> placed(Work& work, const std::map<SensorId, Chain>& chains) {
  std::optional<FloorPlane> guessed;
  std::optional<FloorPlane> floor = floor_in_master(work, chains);
  if (!floor) {
    note_guessed_floor(work);
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
  if (work.config.cameras_alone) {
    work.result.together = JointCovariance{{}, adjusted->together};
    for (const auto& [sensor, place] : adjusted->places)
      work.result.together->sensors.push_back(sensor);
  }
  if (guessed) level_by_bodies(work, adjusted->places, all);
  if (adjusted->found_bias) work.doubt(advice_on(adjusted->depth_bias));
  return all;
}

void place_sensors(Work& work) {
  const std::map<SensorId, Chain> chains = best_chains(work.result.master, work.result.edges);
  const std::map<SensorId, Placed> all = placed(work, chains);
  if (work.result.together)
    transform(*work.result.together, [&](const SensorId& sensor) {
      return at_point(all.at(sensor).world_from_sensor.translation());
    });
  for (const auto& [sensor, found] : all) {
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
