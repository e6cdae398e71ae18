#include "tests/bench/methods/baseline.h"

#include <array>

#include "tests/bench/methods/averaging.h"

namespace chorus::bench::baselines {

std::span<const Baseline> all() {
  static constexpr std::array kAll{
      Baseline{"best-skeleton", [] { return product(fusion::Method::BestSkeleton); }},
      Baseline{"joint-counting", [] { return product(fusion::Method::JointCounting); }},
      Baseline{"substitution", [] { return product(fusion::Method::Substitution); }},
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
