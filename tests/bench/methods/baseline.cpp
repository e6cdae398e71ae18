#include "tests/bench/methods/baseline.h"

#include <array>

#include "tests/bench/methods/averaging.h"
#include "tests/bench/methods/selection.h"

namespace chorus::bench::baselines {

std::span<const Baseline> all() {
  static constexpr std::array kAll{
      Baseline{"best-skeleton", best_skeleton},
      Baseline{"joint-counting", joint_counting},
      Baseline{"substitution", substitution},
      Baseline{"flip-fixed-mean", [] { return product(fusion::Method::Mean); }},
      Baseline{"tracked-mean", tracked_mean},
      Baseline{"otto", [] { return product(fusion::Method::Otto); }},
      Baseline{"otto-kalman", [] { return product(fusion::Method::OttoKalman); }},
      Baseline{"best-view", [] { return product(fusion::Method::BestView); }},
      Baseline{"largest-cluster", largest_cluster},
  };
  return kAll;
}

}  // namespace chorus::bench::baselines
