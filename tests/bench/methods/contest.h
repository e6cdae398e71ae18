// One draw of the workshop with every method of fusion on it, measured alike.
#pragma once

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

/// Which way a figure counts.
enum class Kind {
  Error,   ///< Lower is better.
  Stated,  ///< Of covariances: for methods that state one; neither lower nor higher is better.
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
  bool true_labels = false;  ///< Gets each view with left and right exchanged where that is true.
  baselines::Told told = nullptr;  ///< Instead of `begin`: made knowing the truth.
  bool bound = false;  ///< Instead of `begin`: baselines::linear_bound(), where errors are known.
};

/// The product's default, the method of the tables' first column.
[[nodiscard]] Contender ours(const fusion::FusionConfig& config = {}, std::string name = "ours");

/// The same, told which views have left and right exchanged: "NAME-true-labels".
[[nodiscard]] Contender labelled(Contender contender);

/// Ours and everything it is held against.
[[nodiscard]] std::vector<Contender> all_contenders();

struct Contest {
  Setting setting;
  bool own_registration = false;  ///< Registered from the frames themselves; else by the truth.
  /// With the best sensor and the filter at arrival, which are no Method.
  bool every_method = true;
  pipeline::PipelineConfig pipeline = {};
};

struct Scored {
  std::string method;
  std::vector<double> values;  ///< In the order of metrics().
  double common = 0.0;         ///< Mean error over the joints that every contender answers [m].
};

/// One draw.  A registration that fails gives NaN everywhere.
[[nodiscard]] std::vector<Scored> hold(const Contest& contest,
                                       const std::vector<Contender>& contenders);

/// A view's skeleton with left and right exchanged.
[[nodiscard]] Skeleton<WorldSpace> exchanged(const Skeleton<WorldSpace>& body);

}  // namespace chorus::bench
