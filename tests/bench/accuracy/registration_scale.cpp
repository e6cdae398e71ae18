#include "tests/bench/accuracy/registration_scale.h"

#include <ctime>
#include <memory>

#include "common/base/units.h"
#include "fusion-server/server/solver.h"
#include "tests/bench/methods/registration_methods.h"

namespace chorus::bench {

void measure_scale(Report& report) {
  constexpr std::size_t kMany = 64;
  constexpr double kMostSeconds = 5.0;
  Setting setting;
  setting.seed = report.seed();
  synthetic::Ring many;
  many.count = kMany;
  setting.places = ring_places(many);
  const Workshop workshop = draw_workshop(setting);
  core::SolveJob job;
  job.config.master = workshop.tracks.front().sensor;
  for (const registration::WalkTrack& track : workshop.tracks)
    job.walk.push_back(
        {track.sensor, {std::make_shared<const std::vector<SensorFrame>>(track.frames)}});
  const std::clock_t before = std::clock();
  const core::Solution solution = server::solve(job, workshop.begin);
  const double cpu = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  std::vector<SensorId> all;
  for (const registration::WalkTrack& track : workshop.tracks) all.push_back(track.sensor);
  const Score score = score_of(workshop, solution.registration, all);
  report.row(kScale, "seconds", seconds(solution.cost), "s");
  report.row(kScale, "cpu_seconds", cpu, "s");
  report.row(kScale, "edges", static_cast<double>(solution.registration.edges.size()), "");
  report.row(kScale, "workspace_centre_mm", to_mm(score.centre), "mm");
  report.row(kScale, "refused", static_cast<double>(score.refused), "");
  report.row(kScale, "over_100mm", static_cast<double>(score.lost), "");
  report.condition("scale-64: solved within 5 s of processor time, all placed within 100 mm",
                   cpu < kMostSeconds && score.refused == 0 && score.lost == 0);
}

}  // namespace chorus::bench
