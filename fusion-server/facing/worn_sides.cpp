#include "fusion-server/facing/worn_sides.h"

#include <algorithm>
#include <cmath>

#include "common/evaluation/limb_fit.h"

namespace chorus::facing {
namespace {

/// The line of sight along which a flat figure has no depth.
Eigen::Vector3d sight_to(const SensorView& view) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Joint& joint : view.skeleton.joints) {
    if (joint.seen()) sum += joint.position - view.eye;
  }
  sum.y() = 0.0;
  return sum.norm() > 0 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d::Zero();
}

/// The limb's log odds in the mean of the views, because they see the same posture.
double limb_log_odds(const Person& person, const WornLimb& worn, const std::vector<bool>& exchanged,
                     const std::vector<Eigen::Vector3d>& sights) {
  double sum = 0.0;
  double views = 0.0;
  for (std::size_t v = 0; v < person.views.size(); ++v) {
    const auto fit = evaluation::limb_fit(
        person.views[v].skeleton, {worn.limb, worn.world_from_limb, worn.covariance}, sights[v]);
    if (!fit) continue;
    const double labels = 0.5 * (fit->exchanged - fit->labelled);
    sum += exchanged[v] ? -labels : labels;
    views += 1.0;
  }
  return views > 0 ? sum / views : 0.0;
}

/// Log odds of two hypotheses if the evidence misleads with this chance.
double doubted(double log_odds, double misleads) {
  const double ratio = std::exp(std::clamp(log_odds, -30.0, 30.0));
  return std::log(((1.0 - misleads) * ratio + misleads) / ((1.0 - misleads) + misleads * ratio));
}

}  // namespace

double worn_log_odds(const Person& person, const std::vector<bool>& exchanged,
                     std::span<const Figure> flat, const WornCue& cue) {
  if (person.worn.empty()) return 0.0;
  std::vector<Eigen::Vector3d> sights(person.views.size(), Eigen::Vector3d::Zero());
  for (const Figure& figure : flat) sights[figure.view] = sight_to(person.views[figure.view]);
  double sum = 0.0;
  for (const WornLimb& worn : person.worn) sum += limb_log_odds(person, worn, exchanged, sights);
  return doubted(sum, cue.misleads);
}

}  // namespace chorus::facing
