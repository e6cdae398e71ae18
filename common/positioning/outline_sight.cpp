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
// A person who is followed is so near to where they are expected: the filter errs by less, and
// somebody who runs takes a step of this length from one picture to the next [m].
constexpr double kFollowed = 0.25;

class OutlineSight final : public PictureSight {
 public:
  OutlineSight(SightCamera camera, silhouette::EvidenceSource source, const SightSettings& settings)
      : camera_(std::move(camera)), source_(std::move(source)), settings_(settings) {}

  [[nodiscard]] std::optional<SightedPlace> searched(const ExpectedBody& last) const override {
    const Skeleton<WorldSpace> body = placed(last.pose, last.heading, last.place);
    const auto region = region_of(body, settings_.search.shifts * settings_.search.shift);
    const Evidence evidence = region ? source_.within(*region) : source_.whole();
    const auto found = silhouette::search(view(body, evidence), settings_.search);
    if (!found) return std::nullopt;
    SightedPlace out{last.place + found->shift, Eigen::Matrix3d::Zero(), last.heading,
                     found->energy / evidence.scale(), found->ambiguous};
    out.covariance.diagonal() << kSearchSigma * kSearchSigma,
        kSearchHeightSigma * kSearchHeightSigma, kSearchSigma * kSearchSigma;
    return out;
  }

  [[nodiscard]] std::optional<SightedPlace> outlined(const ExpectedBody& expected) const override {
    const Skeleton<WorldSpace> body = placed(expected.pose, expected.heading, expected.place);
    auto fit = followed(body);
    if (!fit) fit = silhouette::fit_outline(view(body, source_.whole()), settings_.outline);
    if (!fit) return std::nullopt;
    return SightedPlace{expected.place + fit->shift, fit->covariance, expected.heading,
                        fit->mean_px, fit->ambiguous};
  }

  [[nodiscard]] std::optional<SightedPlace> anywhere(const suit::SuitPose& pose,
                                                     std::optional<double> heading,
                                                     double height) const override {
    std::optional<SightedPlace> best;
    const Evidence evidence = source_.whole();
    const int tries = heading ? 1 : kHeadings;
    for (int i = 0; i < tries; ++i) {
      const double turn = heading ? *heading : wrap_angle(2.0 * std::numbers::pi * i / kHeadings);
      const Eigen::Vector3d origin(0.0, height, 0.0);
      const Skeleton<WorldSpace> body = placed(pose, turn, origin);
      const auto fit =
          silhouette::find_on_floor(view(body, evidence), settings_.floor, settings_.outline);
      if (!fit || (best && best->misfit_px <= fit->mean_px)) continue;
      best = {origin + fit->shift, fit->covariance, turn, fit->mean_px, fit->ambiguous};
    }
    return best;
  }

 private:
  using Evidence = silhouette::Evidence;

  [[nodiscard]] silhouette::SearchView view(const Skeleton<WorldSpace>& body,
                                            const Evidence& evidence) const {
    return {body, camera_.shape, camera_.world_from_sensor, camera_.lens, evidence};
  }

  [[nodiscard]] std::optional<silhouette::Region> region_of(const Skeleton<WorldSpace>& body,
                                                            double reach) const {
    if (!settings_.regions) return std::nullopt;
    return silhouette::region_around(
        {body, camera_.shape, camera_.world_from_sensor, camera_.lens, Evidence{}}, reach);
  }

  /// The fit within a region of interest; none when the person is not there or leaves it.
  [[nodiscard]] std::optional<silhouette::OutlineFit> followed(
      const Skeleton<WorldSpace>& body) const {
    const auto region = region_of(body, kFollowed);
    if (!region) return std::nullopt;
    silhouette::OutlineSettings settings = settings_.outline;
    settings.reach = 0.0;
    auto fit = silhouette::fit_outline(view(body, source_.within(*region)), settings);
    const bool left = fit && fit->shift.head<3>().cwiseAbs().maxCoeff() > kFollowed;
    if (!fit || left || fit->mean_px > settings.lost_px) return std::nullopt;
    return fit;
  }

  SightCamera camera_;
  silhouette::EvidenceSource source_;
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
                                                  silhouette::EvidenceSource source,
                                                  const SightSettings& settings) {
  return std::make_shared<OutlineSight>(camera, std::move(source), settings);
}

}  // namespace chorus::positioning
