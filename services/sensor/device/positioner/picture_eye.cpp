#include "services/sensor/device/positioner/picture_eye.h"

#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "common/positioning/outline_sight.h"

namespace chorus::positioner {
namespace {

using positioning::kSightWidth;
using positioning::PictureSight;

constexpr std::size_t kEnough = 30;  // Pictures of the empty room before it is believed.

cv::Mat working(const camera::Picture& picture) {
  cv::Mat out;
  const double factor = 1.0 * kSightWidth / picture.size.width;
  cv::resize(*picture.pixels, out, {}, factor, factor, cv::INTER_AREA);
  return out;
}

class OutlineEye final : public PictureEye {
 public:
  explicit OutlineEye(EyeSettings settings)
      : settings_(std::move(settings)),
        shape_(silhouette::usual_shape(settings_.stature, settings_.girth)) {}

  std::shared_ptr<const PictureSight> see(const camera::LookedAt& looked) override {
    picture_ = looked.picture;
    lens_ = looked.lens.camera;
    captured_ = looked.captured;
    const positioning::SightCamera camera{settings_.world_from_sensor,
                                          positioning::sight_lens(lens_), shape_};
    auto evidence = evidence_of(looked);
    return evidence ? positioning::outline_sight(camera, std::move(*evidence)) : nullptr;
  }

  std::function<Result<CameraImage>()> drawn(const Skeleton<WorldSpace>& body) const override {
    if (!picture_) return {};
    const auto capsules =
        silhouette::flat_capsules(body, shape_, settings_.world_from_sensor, lens_);
    return [capsules, picture = *picture_, lens = lens_, captured = captured_] {
      camera::Picture marked{std::make_shared<cv::Mat>(picture.pixels->clone()), picture.size};
      cv::Mat pixels = *marked.pixels;  // Shares its memory.
      constexpr double kSpacing = 3.0;  // [px]
      for (const silhouette::OutlinePoint& point : silhouette::outline_of(capsules, kSpacing))
        cv::circle(pixels, {static_cast<int>(point.pixel.x()), static_cast<int>(point.pixel.y())},
                   1, cv::Scalar(80, 255, 80), cv::FILLED);
      return jpeg_of(marked).map([&](std::string bytes) {
        return CameraImage{captured, lens, "image/jpeg", std::move(bytes)};
      });
    };
  }

 private:
  [[nodiscard]] std::optional<silhouette::EvidenceSource> evidence_of(
      const camera::LookedAt& looked) {
    if (looked.mask && settings_.background != EyeBackground::Mixtures) {
      const camera::PersonMask& mask = *looked.mask;
      const cv::Mat cells(mask.size.height, mask.size.width, CV_8U,
                          const_cast<std::uint8_t*>(mask.cells.data()));
      return silhouette::evidence_of_mask(cells, 1.0 * mask.size.width / kSightWidth);
    }
    if (settings_.background == EyeBackground::Network) return std::nullopt;
    const cv::Mat picture = working(looked.picture);
    if (!looked.somebody) room_.learn(picture);
    if (room_.learned() < kEnough || !looked.somebody) return std::nullopt;
    return room_.evidence(picture);
  }

  EyeSettings settings_;
  std::vector<silhouette::ShapedBone> shape_;
  silhouette::Background room_{
      {.scale = positioning::kSightFieldScale, .model = silhouette::BackgroundModel::Mixtures}};
  std::optional<camera::Picture> picture_{};
  Intrinsics lens_{};
  Timestamp captured_{};
};

}  // namespace

std::unique_ptr<PictureEye> make_eye(EyeSettings settings) {
  return std::make_unique<OutlineEye>(std::move(settings));
}

}  // namespace chorus::positioner
