// One draw of the workshop, with every method of fusion measured in the same way.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion-server/fusion/fuse.h"
#include "tests/bench/methods/baseline.h"
#include "tests/bench/methods/moments.h"
#include "tests/bench/methods/oracle.h"
#include "tests/judge/judge.h"
#include "tests/judge/metrics.h"

namespace chorus::bench {

/// How a figure is to be read.
enum class Kind {
  Error,   ///< Lower is better.
  Stated,  ///< About stated covariances, for methods that state them; neither direction is better.
};

/// A figure of a method.
struct Metric {
  std::string name;
  std::string unit;
  std::function<double(const Answers&)> of;
  Kind kind = Kind::Error;
};

/// In the order of the tables; mpjpe_mm first.
[[nodiscard]] std::span<const Metric> metrics();

struct Contender {
  std::string name;
  std::function<baselines::Method()> begin;
  bool true_labels = false;  ///< Gets every view with correct labels: left and right are swapped
                             ///< back where they are wrong.
  baselines::Told told = nullptr;  ///< Used instead of `begin`: knows the truth.
  bool bound = false;     ///< Used instead of `begin`: baselines::linear_bound() with true errors.
  bool smoothed = false;  ///< Used instead of `begin`: the product, told what came later.
};

/// The product's default method; the first column of the tables.
[[nodiscard]] Contender ours(const fusion::FusionConfig& config = {}, std::string name = "ours");

/// The contender with views whose left and right are corrected by the truth; named
/// "NAME-true-labels".
[[nodiscard]] Contender labelled(Contender contender);

/// The product when each instant waits for later ones (pipeline/smoother.h); "ours-smoothed".
[[nodiscard]] Contender ours_smoothed();

/// Ours and all methods that it is compared with.
[[nodiscard]] std::vector<Contender> all_contenders();

/// A sensor that sends nothing any more.
struct Silence {
  std::size_t sensor = 0;  ///< Its number, from 0.
  Duration after{0};       ///< How long after the beginning.
};

struct Contest {
  Setting setting;
  /// True: registered from the frames themselves; false: the true registration.
  bool own_registration = false;
  /// Includes the best sensor and the filter at arrival, which are not of type Method.
  bool every_method = true;
  pipeline::PipelineConfig pipeline = {};
  std::optional<Silence> silence = {};
};

/// What every contender gets in one draw, and the truth.
struct Course {
  std::vector<Timestamp> instants;
  std::vector<std::optional<Person>> given;  ///< At each instant; none: the person was not found.
  std::vector<Skeleton<WorldSpace>> exact;   ///< At each instant.
  std::function<Skeleton<WorldSpace>(Timestamp)> truth_at;
};
[[nodiscard]] Course course_of(const Contest& contest);

struct Scored {
  std::string method;
  std::vector<double> values;  ///< In the order of metrics().
  double common = 0.0;         ///< Mean error over the joints that every contender reports [m].
  std::array<double, kJointCount> joints{};  ///< Mean error of each joint [m]; NaN: never seen.
};

/// Runs one draw.  If registration fails, all values are NaN.
[[nodiscard]] std::vector<Scored> hold(const Contest& contest,
                                       const std::vector<Contender>& contenders);

/// A view's skeleton with left and right swapped.
[[nodiscard]] Skeleton<WorldSpace> exchanged(const Skeleton<WorldSpace>& body);

}  // namespace chorus::bench
