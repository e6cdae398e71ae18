#include <algorithm>
#include <cmath>
#include <vector>

#include "common/importers/datasets/labanotation_csv.h"
#include "tests/bench/accuracy/recordings.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {

Result<void> time_labanotation(Report& report, const std::filesystem::path& folder) {
  std::vector<double> steps;  // [s]
  std::size_t frames = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder)) {
    if (file.path().extension() != ".csv") continue;
    const auto clip = importers::read_labanotation_csv(file.path());
    if (!clip) continue;
    frames += clip->frames.size();
    for (std::size_t i = 1; i < clip->frames.size(); ++i) {
      steps.push_back(seconds(clip->frames[i].captured - clip->frames[i - 1].captured));
    }
  }
  const auto doubled = std::count_if(steps.begin(), steps.end(), [](double s) { return s > 0.05; });
  const double lost =
      static_cast<double>(doubled) / static_cast<double>(std::max<std::size_t>(1, steps.size()));
  report.row("labanotation", "frames", static_cast<double>(frames), "frames");
  report.row("labanotation", "step_p50_ms", 1e3 * median(steps), "ms", "profile-A",
             median(steps) / (1.0 / 30.0));
  report.row("labanotation", "step_p99_ms", 1e3 * percentile(steps, 0.99), "ms");
  report.row("labanotation", "lost_percent", 100.0 * lost, "%");
  report.note("labanotation: profile A steps by 33.3 ms and loses 0.5 to 2 %.");
  report.condition("labanotation: steps are 30 Hz within 5 %",
                   std::abs(median(steps) * 30.0 - 1.0) < 0.05);
  return {};
}

}  // namespace chorus::bench
