#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "services/sensor/device/camera/looker.h"
#include "tests/bench/camera/camera_cases.h"

namespace chorus::bench {
namespace {

/// Processor time of children that have ended [s].
double children_seconds() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto of = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return of(used.ru_utime) + of(used.ru_stime);
}

Result<std::vector<cv::Mat>> pictures() {
  cv::VideoCapture video(fmt::format("{}/cam01.mp4", kFourVideos));
  std::vector<cv::Mat> all;
  for (cv::Mat picture; video.read(picture);) all.push_back(picture.clone());
  if (all.empty()) return fail(ErrorCode::NotFound, kFourVideos, "has no pictures");
  return all;
}

/// A picture of six copies of `one`, three by two.
cv::Mat six_times(const cv::Mat& one) {
  cv::Mat row;
  cv::hconcat(std::vector<cv::Mat>{one, one, one}, row);
  cv::Mat both;
  cv::vconcat(row, row, both);
  return both;
}

struct Cost {
  double seconds = 0.0;  ///< Processor time of the runner, from its start on.
  std::size_t people = 0;
};

Result<Cost> cost_of(const std::string& model, const std::vector<cv::Mat>& shown, int count) {
  const double before = children_seconds();
  Cost cost;
  {
    const camera::CameraSettings settings;
    auto looker = camera::Looker::start(settings, runner_of(model), {});
    if (!looker) return pass(looker);
    for (int i = 0; i < count; ++i) {
      const auto pixels =
          std::make_shared<const cv::Mat>(shown[static_cast<std::size_t>(i) % shown.size()]);
      const Timestamp captured = importers::kDefaultStart + i * std::chrono::milliseconds(33);
      const auto found = looker->look({pixels, {pixels->cols, pixels->rows}}, captured,
                                      static_cast<std::uint64_t>(i + 1), {});
      if (!found) return pass(found);
      cost.people = std::max(cost.people, found->bodies.size());
    }
  }
  cost.seconds = children_seconds() - before;
  return cost;
}

struct Load {
  const char* name;
  const char* model;
  bool six;
  double target;  ///< [1/s]; 0: none.
};
constexpr std::array kLoads{Load{"video-blazepose-lite-1", "blazepose-lite", false, 12.0},
                            Load{"video-blazepose-full-1", "blazepose-full", false, 0.0},
                            Load{"video-movenet-1", "movenet", false, 0.0},
                            Load{"video-movenet-6", "movenet", true, 6.0}};

Result<void> measure(Report& report, const Load& load, const std::vector<cv::Mat>& one) {
  std::vector<cv::Mat> shown = one;
  if (load.six) std::ranges::transform(one, shown.begin(), six_times);
  const int few = 4;
  const int many = report.quick() ? 12 : 64;
  const auto begin = cost_of(load.model, shown, few);
  if (!begin) return pass(begin);
  const auto all = cost_of(load.model, shown, many);
  if (!all) return pass(all);
  const double each = (all->seconds - begin->seconds) / (many - few);
  const double rate = each > 0.0 ? 1.0 / each : 0.0;
  report.row(load.name, "pictures_per_core_second", rate, "1/s");
  report.row(load.name, "people_found", static_cast<double>(all->people), "1");
  report.row(load.name, "start_s", begin->seconds, "s");
  if (load.target == 0.0) return {};
  report.row(load.name, "cameras_per_core", std::floor(rate / load.target), "1");
  if (!report.quick())
    report.condition(
        fmt::format("{}: at least {:.0f} pictures a second on one core", load.name, load.target),
        rate >= load.target);
  return {};
}

}  // namespace

Result<void> runner_speed(Report& report) {
  const auto one = pictures();
  if (!one) return pass(one);
  for (const Load& load : kLoads) {
    if (auto done = measure(report, load, *one); !done) return done;
  }
  report.note(
      "video: by the processor time of the runner, without its start and without decoding.  "
      "cameras_per_core: at 12 Hz with one person, at 6 Hz with six.  -6: six times the same "
      "person "
      "in one picture.");
  return {};
}

}  // namespace chorus::bench
