#include "fusion-server/learn/error_samples.h"

namespace chorus::learn {

void add_samples(const Person& person, const Skeleton<WorldSpace>& exact,
                 std::vector<ErrorSample>& samples) {
  for (const SensorView& view : person.views) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto id = static_cast<JointId>(j);
      if (!view.skeleton[id].seen() || !exact[id].seen()) continue;
      const double error = (view.skeleton[id].position - exact[id].position).norm();
      samples.push_back({id, fusion::features_of(view, id), error});
    }
  }
}

}  // namespace chorus::learn
