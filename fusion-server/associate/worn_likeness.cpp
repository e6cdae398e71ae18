#include "fusion-server/associate/worn_likeness.h"

#include <algorithm>

#include "common/evaluation/limb_fit.h"
#include "fusion-server/flow/worn_people.h"

namespace chorus::associate {
namespace {

// Mean squared angles by their variance, over the limbs.  Of the wearer they are 1, and more where
// a limb is guessed; of somebody who moves otherwise they are nearly as large as they can be.
constexpr double kAsWorn = 2.0;
constexpr double kElsewhere = 6.0;

}  // namespace

std::optional<double> unlike_worn(const SensorView& view, std::span<const WornLimb> worn) {
  if (worn.empty()) return std::nullopt;
  const Eigen::Vector3d sight = sight_without_depth(view);
  double labelled = 0.0;
  double exchanged = 0.0;
  double limbs = 0.0;
  for (const WornLimb& each : worn) {
    const auto fit = evaluation::limb_fit(
        view.skeleton, {each.limb, each.world_from_limb, each.covariance}, sight);
    if (!fit) continue;
    labelled += fit->labelled;
    exchanged += fit->exchanged;
    limbs += 1.0;
  }
  if (limbs == 0.0) return std::nullopt;
  const double mean = std::min(labelled, exchanged) / limbs;
  return std::clamp((mean - kAsWorn) / (kElsewhere - kAsWorn), 0.0, 1.0);
}

std::optional<double> unlike_worn(std::span<const PlacedView> views,
                                  std::span<const WornLimb> worn) {
  double sum = 0.0;
  double count = 0.0;
  for (const PlacedView& each : views) {
    const auto unlike = unlike_worn(each.view, worn);
    if (!unlike) continue;
    sum += *unlike;
    count += 1.0;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

}  // namespace chorus::associate
