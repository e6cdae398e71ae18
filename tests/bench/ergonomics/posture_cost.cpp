// What scoring costs: six people, four methods, with doubt.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/summary.h"
#include "tests/bench/ergonomics/ergonomics_cases.h"
#include "tests/bench/ergonomics/posture_agreement.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kPeople = 6;
constexpr double kFramesHz = 30.0;
constexpr Timestamp kBegin{};

ergonomics::BodyAt moving_body(std::size_t person, std::size_t frame) {
  const double t = static_cast<double>(frame) / kFramesHz;
  std::mt19937_64 random(person);
  auto body = drawn_body(random);
  for (Joint& joint : body.joints) {
    joint.position += 0.02 * Eigen::Vector3d(std::sin(3 * t), std::cos(2 * t), std::sin(5 * t));
    joint.covariance = Covariance(Eigen::Matrix3d::Identity() * 4e-4);
  }
  return {kBegin + Duration(std::llround(1e9 * t)), body};
}

}  // namespace

Result<void> posture_cost(Report& report) {
  const std::vector<const ergonomics::Method*> methods{&ergonomics::kReba, &ergonomics::kRula,
                                                       &ergonomics::kOwas, &ergonomics::kEaws};
  const std::size_t frames = report.quick() ? 100 : 600;
  std::vector<ergonomics::Observer> observers(kPeople);
  std::vector<double> milliseconds;
  double sets = 0.0;
  for (std::size_t f = 0; f < frames; ++f) {
    std::vector<ergonomics::BodyAt> bodies;
    for (std::size_t p = 0; p < kPeople; ++p) bodies.push_back(moving_body(p, f));
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t p = 0; p < kPeople; ++p) {
      const auto seen = observers[p].observe(bodies[p]);
      for (const auto* method : methods)
        sets += set_of(score_of(*method, seen, empty_hands()), 0.9).width();
    }
    const auto took = std::chrono::steady_clock::now() - begin;
    milliseconds.push_back(std::chrono::duration<double, std::milli>(took).count());
  }
  double sum = 0.0;
  for (const double each : milliseconds) sum += each;
  const double mean = sum / static_cast<double>(frames);
  report.row("cost", "frame_ms", mean, "ms");
  report.row("cost", "frame_p99_ms", percentile(milliseconds, 0.99), "ms");
  report.row("cost", "cpu_percent", mean * kFramesHz / 10.0, "%");
  // Ten minutes of one person.
  std::vector<ergonomics::BodyAt> bodies;
  const std::size_t ten_minutes = report.quick() ? 1'800 : 18'000;
  for (std::size_t f = 0; f < ten_minutes; ++f) bodies.push_back(moving_body(0, f));
  ergonomics::Task task;
  task.asked = empty_hands();
  const auto begin = std::chrono::steady_clock::now();
  const auto person = ergonomics::score_person({bodies, methods, task, kBegin, {}});
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() * 18'000.0 /
      static_cast<double>(ten_minutes);
  report.row("cost", "ten_minutes_s", seconds, "s");
  report.note(
      "cost: without reading the recording, which takes 16 us a frame (chorus-bench codec)");
  report.condition("cost: something was scored", sets > 0.0 && person.methods[0].scored > 0.9);
  return {};
}

}  // namespace chorus::bench
