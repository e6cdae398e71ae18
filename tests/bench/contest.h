// One draw of the workshop with every method of fusion on it, measured alike.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fusion-server/fusion/fuse.h"
#include "tests/bench/baselines/baseline.h"
#include "tests/bench/baselines/oracle.h"
#include "tests/bench/judge.h"
#include "tests/bench/metrics.h"
#include "tests/bench/moments.h"

namespace chorus::bench {

/// A figure of a method, lower is better.
struct Metric {
  std::string_view name;
  std::string_view unit;
  double (*of)(const Answers&);
};

/// In the order of the tables; mpjpe_mm first.
[[nodiscard]] std::span<const Metric> metrics();

struct Contender {
  std::string name;
  std::function<baselines::Method()> begin;
  bool true_labels = false;  ///< Gets each view with left and right exchanged where that is true.
  baselines::Told told = nullptr;  ///< Instead of `begin`: made knowing the truth.
};

/// The product's default, the method of the tables' first column.
[[nodiscard]] Contender ours(const fusion::FusionConfig& config = {}, std::string name = "ours");

/// Ours and everything it is held against.
[[nodiscard]] std::vector<Contender> all_contenders();

struct Contest {
  Setting setting;
  bool own_registration = false;  ///< Registered from the frames themselves; else by the truth.
  bool every_method =
      true;  ///< With the best sensor and the filter at arrival, which are no Method.
  pipeline::PipelineConfig pipeline = {};
};

struct Scored {
  std::string method;
  std::vector<double> values;  ///< In the order of metrics().
};

/// One draw.  A registration that fails gives NaN everywhere.
[[nodiscard]] std::vector<Scored> hold(const Contest& contest,
                                       const std::vector<Contender>& contenders);

/// A view's skeleton with left and right exchanged.
[[nodiscard]] Skeleton<WorldSpace> exchanged(const Skeleton<WorldSpace>& body);

}  // namespace chorus::bench
