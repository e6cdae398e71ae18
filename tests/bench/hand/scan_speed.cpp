// How long a scan takes: processor time of this process, and of the network's.
#include <sys/resource.h>

#include <ctime>

#include <fmt/format.h>

#include "tests/bench/hand/hand_cases.h"
#include "tests/bench/hand/hand_methods.h"
#include "tests/support/hands/hand_scene.h"

namespace chorus::bench {
namespace {

double own_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double ended_children_seconds() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto of = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return of(used.ru_utime) + of(used.ru_stime);
}

/// Processor time that the network takes for `count` pictures, its start included [s].
double network_seconds(Report& report, const cv::Mat& picture, int count) {
  const double before = ended_children_seconds();
  {
    HandEyes eyes(report);
    if (!eyes.there()) return kNoRatio;
    for (int i = 0; i < count; ++i) (void)eyes.look(picture);
  }
  return ended_children_seconds() - before;
}

}  // namespace

Result<void> scan_speed(Report& report) {
  constexpr int kPictures = 12;
  std::vector<testing::DrawnHand> drawn;
  for (std::uint64_t i = 0; i < kPictures; ++i) {
    testing::HandScene scene;
    scene.seed = report.seed() + i;
    scene.upright = true;
    drawn.push_back(testing::drawn_hand(scene));
  }
  HandEyes none(report);
  for (const HandMethod method : {HandMethod::Outline, HandMethod::Paper}) {
    const double before = own_seconds();
    for (const auto& each : drawn) (void)hand_by(method, each.picture, each.back, none);
    report.row(fmt::format("speed ({})", name_of(method)), "cpu_s_per_picture",
               (own_seconds() - before) / kPictures, "s");
  }
  const double few = network_seconds(report, drawn[0].picture, 1),
               many = network_seconds(report, drawn[0].picture, 1 + kPictures);
  report.row("speed (network)", "cpu_s_per_picture", (many - few) / kPictures, "s");
  report.row("speed (network)", "cpu_s_start_and_first", few, "s");
  report.note("speed: A4 at 1200 pixels; all cores' processor time, so at most that on one core");
  return {};
}

}  // namespace chorus::bench
