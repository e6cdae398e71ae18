// What else one could do with the views of one person: the methods our fusion is held against.
//
// All of them get the same views as ours: the same alignment, registration, facing and association
// (pipeline::perceive), so left and right are put right for all of them: the mean is called
// flip-fixed-mean for that.  Otto's mean and Kalman filter, the plain mean and the heaviest
// view are the product's own methods; only what the product does not have is written here.
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "fusion-server/flow.h"

namespace chorus::bench::baselines {

using Body = Skeleton<WorldSpace>;

/// One body of a person's views, instant after instant; may remember earlier instants.
using Method = std::function<Body(const Person& person, Timestamp instant)>;

struct Baseline {
  std::string_view name;
  Method (*begin)();  ///< A fresh method that remembers nothing yet.
};

/// All of them, in the order of the tables.
[[nodiscard]] std::span<const Baseline> all();

}  // namespace chorus::bench::baselines
