// Kinect for Windows v2; its joints are ours.
#include "common/body/bones.h"
#include "common/layout/tables.h"

namespace chorus::layout {
namespace {

constexpr std::array<Recipe, kJointCount> recipes() {
  std::array<Recipe, kJointCount> all;
  for (std::uint8_t i = 0; i < kJointCount; ++i) all[i] = only(static_cast<JointId>(i), i);
  return all;
}
constexpr auto kRecipes = recipes();

}  // namespace

/// Confidence is TrackingState by name, or as a number times 0.5: 0 not tracked, 0.5 inferred, 1
/// tracked.
const Layout kKinectV2{"kinect_v2_25",
                       "Kinect for Windows SDK 2.0",
                       "https://learn.microsoft.com/en-us/previous-versions/windows/kinect/"
                       "microsoft.kinect.jointtype(v=ieb.10)",
                       kJointNames,
                       kRecipes,
                       0.75,
                       0.25};

}  // namespace chorus::layout
