#include "fusion-server/server/solver.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "fusion-server/registration/guessed_depth.h"
#include "fusion-server/registration/latency.h"
#include "fusion-server/registration/pair_registration.h"
#include "fusion-server/registration/partners.h"
#include "fusion-server/registration/ray_depths.h"
#include "fusion-server/registration/ray_places.h"
#include "fusion-server/registration/time_offset.h"

namespace chorus::server {
namespace {

using registration::Walker;
using registration::WalkTrack;

/// Gives solving a lower priority than pipeline and network, which have deadlines.
constexpr int kNiceness = 10;

struct Pair {
  const Walker* target;
  const Walker* source;
  std::optional<Result<PairwiseRegistration>> edge;
};

/// Calls work(i) for each i below `count`, on all cores; rethrows the first exception.
template <class Work>
void on_all_cores(std::size_t count, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < std::min(cores, count); ++i) {
      others.emplace_back([&] {
        [[maybe_unused]] const int niceness = ::nice(kNiceness);  // Applies to this thread alone.
        run();
      });
    }
    run();
  }
  if (failure) std::rethrow_exception(failure);
}

std::vector<Pair> pairs_of(const std::map<SensorId, Walker>& walkers) {
  std::vector<Pair> pairs;
  for (const auto& [target, source] : registration::partners_of(walkers))
    pairs.push_back({&walkers.at(target), &walkers.at(source), std::nullopt});
  return pairs;
}

std::map<SensorId, Walker> walkers_of(const std::vector<WalkTrack>& walk,
                                      const registration::RegistrationConfig& config) {
  std::map<SensorId, Walker> walkers;
  for (const WalkTrack& track : walk) {
    if (!walkers.contains(track.sensor))
      walkers.emplace(track.sensor, registration::walker_of(track, config));
  }
  return walkers;
}

/// What a walk is solved with.
struct Moment {
  const registration::RegistrationConfig& config;
  const registration::WalkClocks& clocks;
  const registration::PairSearch& search;
  Timestamp now;
};

/// Searches all pairs on all cores, and then solves the walk with what they gave.
Registration solve_pairs_first(const std::vector<WalkTrack>& walk, const Moment& moment) {
  const registration::RegistrationConfig& config = moment.config;
  const auto walkers = walkers_of(walk, config);
  std::vector<Pair> pairs = pairs_of(walkers);
  moment.search.for_each(pairs.size(), [&](std::size_t i) {
    if (moment.search.stopped()) return;
    pairs[i].edge = registration::register_walkers(*pairs[i].target, *pairs[i].source, config);
  });
  std::map<std::pair<SensorId, SensorId>, const Pair*> solved;
  for (const Pair& pair : pairs)
    solved[{pair.target->trail.sensor, pair.source->trail.sensor}] = &pair;
  const registration::PairEstimator look_up = [&](const Walker& target, const Walker& source) {
    const auto found = solved.find({target.trail.sensor, source.trail.sensor});
    if (found != solved.end() && found->second->edge) return *found->second->edge;
    if (found == solved.end() && !moment.search.stopped())
      return registration::register_walkers(target, source, config);
    return Result<PairwiseRegistration>(fail(ErrorCode::Unavailable, "registration", "given up"));
  };
  return registration::solve_with(registration::unless_open(look_up, moment.clocks), walk,
                                  moment.now, config, moment.search.stopped);
}

Registration solve_walk(const core::SolveJob& job, Timestamp now) {
  std::vector<WalkTrack> walk =
      registration::with_ray_depths(core::assembled(job.walk), job.config);
  const registration::RegistrationConfig config = registration::suited_to(walk, job.config);
  const registration::PairSearch search{
      [&] { return job.stop.stop_requested(); },
      [](std::size_t count, const auto& work) { on_all_cores(count, work); }};
  const registration::WalkClocks clocks = registration::clocks_of(walk, config, search);
  registration::bring_in_step(walk, clocks);
  const Moment moment{config, clocks, search, now};
  Registration found = registration::without_latencies(
      walk, [&] { return solve_pairs_first(walk, moment); }, config, search);
  found.clocks = clocks.offsets;
  return registration::settled(std::move(found), walk, config);
}

}  // namespace

core::Solution solve(const core::SolveJob& job, Timestamp now) {
  core::Solution solution{job.session, job.kind, {}, Duration{0}, false};
  const auto begun = std::chrono::steady_clock::now();
  try {
    solution.registration = solve_walk(job, now);
  } catch (const std::exception& thrown) {
    solution.registration.verdict = Verdict::Refused;
    solution.registration.reasons = {std::string("the walk could not be solved: ") + thrown.what()};
  }
  solution.cost = std::chrono::steady_clock::now() - begun;
  solution.given_up = job.stop.stop_requested();
  return solution;
}

}  // namespace chorus::server
