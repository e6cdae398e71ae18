#include "common/positioning/outline_sight.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/geometry/rotation.h"

namespace chorus::positioning {
namespace {

// The paper states no error; a search in steps of 10 cm that loses people for a while is not better
// than this (docs/benchmarks/positioner.md) [m].
constexpr double kSearchSigma = 0.15;
constexpr double kSearchHeightSigma = 0.05;
constexpr int kHeadings = 12;  // Tried when none is known.

class OutlineSight final : public PictureSight {
 public:
  OutlineSight(SightCamera camera, silhouette::Evidence evidence, const SightSettings& settings)
      : camera_(std::move(camera)), evidence_(std::move(evidence)), settings_(settings) {}

  [[nodiscard]] std::optional<SightedPlace> searched(const ExpectedBody& last) const override {
    const Skeleton<WorldSpace> body = placed(last.pose, last.heading, last.place);
    const auto found = silhouette::search(view(body), settings_.search);
    if (!found) return std::nullopt;
    SightedPlace out{last.place + found->shift, Eigen::Matrix3d::Zero(), last.heading,
                     found->energy / evidence_.scale(), found->ambiguous};
    out.covariance.diagonal() << kSearchSigma * kSearchSigma,
        kSearchHeightSigma * kSearchHeightSigma, kSearchSigma * kSearchSigma;
    return out;
  }

  [[nodiscard]] std::optional<SightedPlace> outlined(const ExpectedBody& expected) const override {
    const Skeleton<WorldSpace> body = placed(expected.pose, expected.heading, expected.place);
    const auto fit = silhouette::fit_outline(view(body), settings_.outline);
    if (!fit) return std::nullopt;
    return SightedPlace{expected.place + fit->shift, fit->covariance, expected.heading,
                        fit->mean_px, fit->ambiguous};
  }

  [[nodiscard]] std::optional<SightedPlace> anywhere(const suit::SuitPose& pose,
                                                     std::optional<double> heading,
                                                     double height) const override {
    std::optional<SightedPlace> best;
    const int tries = heading ? 1 : kHeadings;
    for (int i = 0; i < tries; ++i) {
      const double turn = heading ? *heading : wrap_angle(2.0 * std::numbers::pi * i / kHeadings);
      const Eigen::Vector3d origin(0.0, height, 0.0);
      const Skeleton<WorldSpace> body = placed(pose, turn, origin);
      const auto fit = silhouette::find_on_floor(view(body), settings_.floor, settings_.outline);
      if (!fit || (best && best->misfit_px <= fit->mean_px)) continue;
      best = {origin + fit->shift, fit->covariance, turn, fit->mean_px, fit->ambiguous};
    }
    return best;
  }

 private:
  [[nodiscard]] silhouette::SearchView view(const Skeleton<WorldSpace>& body) const {
    return {body, camera_.shape, camera_.world_from_sensor, camera_.lens, evidence_};
  }

  SightCamera camera_;
  silhouette::Evidence evidence_;
  SightSettings settings_;
};

}  // namespace

Intrinsics sight_lens(const Intrinsics& lens) {
  const double factor = 1.0 * kSightWidth / std::max(1, lens.width);
  Intrinsics out = lens;
  out.width = kSightWidth;
  out.height = static_cast<int>(std::lround(factor * lens.height));
  out.fx *= factor;
  out.fy *= factor;
  out.cx = (lens.cx + 0.5) * factor - 0.5;
  out.cy = (lens.cy + 0.5) * factor - 0.5;
  return out;
}

std::shared_ptr<const PictureSight> outline_sight(const SightCamera& camera,
                                                  silhouette::Evidence evidence,
                                                  const SightSettings& settings) {
  return std::make_shared<OutlineSight>(camera, std::move(evidence), settings);
}

}  // namespace chorus::positioning
