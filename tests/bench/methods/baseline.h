// Other ways to fuse the views of one person: the methods that our fusion is compared with.
//
// All these methods get the same views as ours: the same alignment, registration, facing and
// association (pipeline::perceive), so left and right are corrected for all of them, which is why
// the mean is called flip-fixed-mean.  Only what the product lacks is implemented here.
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "fusion-server/flow/person.h"

namespace chorus::bench::baselines {

using Body = Skeleton<WorldSpace>;

/// Fuses one person's views into one body per instant; may remember earlier instants.
using Method = std::function<Body(const Person& person, Timestamp instant)>;

struct Baseline {
  std::string_view name;
  Method (*begin)();  ///< Makes the method with an empty memory.
};

/// All baselines, in the order of the tables.
[[nodiscard]] std::span<const Baseline> all();

}  // namespace chorus::bench::baselines
