// Error of a body against the truth, with its labels as given and with left and right swapped.
#pragma once

#include "common/body/bones.h"
#include "common/body/skeleton.h"

namespace chorus::bench {

/// Sum of one body's distances from the truth [m], over the joints that were seen.
struct LabelledError {
  double as_given = 0.0;
  double exchanged = 0.0;  ///< The sum with left and right swapped in all labels.
};

template <class Space>
[[nodiscard]] LabelledError labelled_error(const Skeleton<Space>& body,
                                           const Skeleton<Space>& exact) {
  LabelledError error;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (!body.joints[i].seen()) continue;
    const Eigen::Vector3d& place = body.joints[i].position;
    error.as_given += (place - exact.joints[i].position).norm();
    error.exchanged += (place - exact[mirror(static_cast<JointId>(i))].position).norm();
  }
  return error;
}

}  // namespace chorus::bench
