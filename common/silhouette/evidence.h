// What a picture says of the person's outline: a distance field (Madaras et al. 3.5, Fig. 5), of
// the whole picture or of a region of interest.
//
// OpenCV runs on one thread here: cv::Canny cuts a picture into as many stripes as there are
// threads and decides at their borders in another order, so a number would depend on the machine
// (docs/benchmarks/positioner.md, "threads").
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace cv {
class BackgroundSubtractorMOG2;
class Mat;
}  // namespace cv

namespace chorus::silhouette {

enum class BackgroundModel {
  Median,    ///< Of pictures spread over the take; for files.
  Mixtures,  ///< Of Gaussians for each pixel (Zivkovic's MOG2), shadows left out; also live.
};

struct EvidenceSettings {
  double scale = 0.5;       ///< The field is this much smaller than the picture.
  double farthest = 30.0;   ///< Larger distances count as this [px of the field].
  double threshold = 18.0;  ///< Least difference from the background, of 255.
  BackgroundModel model = BackgroundModel::Median;
  /// Above 0: the threshold adapts to the mean of so many pixels around (cv::adaptiveThreshold, as
  /// in the paper); 0: to the picture's common change of light.  Odd [px of the field].
  int surroundings = 0;
};

/// The scale at which a picture of this width has a field of at most 480 pixels.
[[nodiscard]] double usual_scale(int width);

/// A part of a picture [px of the picture].
using Region = Eigen::AlignedBox2d;

/// A field of distances from the nearest edge, and what is not background, of a picture or of a
/// region of it.
class Evidence {
 public:
  /// Distance from the nearest edge at a pixel of the picture [px of the picture], interpolated;
  /// the farthest outside the picture or the region.
  [[nodiscard]] double distance(const Eigen::Vector2d& pixel) const;
  /// Derivative of that.
  [[nodiscard]] Eigen::Vector2d slope(const Eigen::Vector2d& pixel) const;
  /// True where the picture differs from the background.
  [[nodiscard]] bool is_foreground(const Eigen::Vector2d& pixel) const;
  /// Share of the picture or region that differs from the background.
  [[nodiscard]] double foreground() const { return foreground_; }
  /// The field itself, 32-bit floats [px of the field], for methods that need whole pictures.
  [[nodiscard]] const cv::Mat& field() const { return *field_; }
  /// Column and row of the whole picture's field at which this field begins [px of the field].
  [[nodiscard]] const Eigen::Vector2i& origin() const { return origin_; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] double farthest() const { return farthest_ / scale_; }

 private:
  friend class EvidenceSource;
  [[nodiscard]] double at(int column, int row) const;

  std::shared_ptr<const cv::Mat> field_;  ///< 32-bit floats.
  std::shared_ptr<const cv::Mat> mask_;   ///< 8 bits.
  Eigen::Vector2i origin_ = Eigen::Vector2i::Zero();
  double scale_ = 1.0;
  double farthest_ = 0.0;
  double foreground_ = 0.0;
};

/// A picture whose evidence is made where it is asked for: adaptive threshold, Canny and distance
/// transform take most of the time, and a person who is followed fills a small part of a picture.
class EvidenceSource {
 public:
  [[nodiscard]] Evidence whole() const;
  /// Within the region every value is that of whole().
  [[nodiscard]] Evidence within(const Region& region) const;

 private:
  friend class Background;
  friend EvidenceSource evidence_of_mask(const cv::Mat&, double, const EvidenceSettings&);
  explicit EvidenceSource(const EvidenceSettings& settings) : settings_(settings) {}
  [[nodiscard]] Evidence cut(int left, int top, int right, int bottom) const;

  EvidenceSettings settings_;
  std::shared_ptr<const cv::Mat> difference_;  ///< From the background, 8 bits; null with a mask.
  std::shared_ptr<const cv::Mat> mask_;        ///< 8 bits; null with a difference.
  double common_ = 0.0;                        ///< Mean of the difference.
};

/// The evidence of a mask of the person that somebody else made, as a network does (8 bits); it is
/// `scale` times the picture's size.
[[nodiscard]] EvidenceSource evidence_of_mask(const cv::Mat& mask, double scale,
                                              const EvidenceSettings& settings = {});

/// The room without the person.
class Background {
 public:
  explicit Background(const EvidenceSettings& settings = {}) : settings_(settings) {}

  /// A picture (grey or BGR).  For the median at most 64 are kept, spread over all that were given;
  /// they may show the person, as long as no place is covered in half of them.  Mixtures should not
  /// see the person at all.
  void learn(const cv::Mat& picture);
  [[nodiscard]] std::size_t learned() const { return learned_; }

  /// Background subtraction now; adaptive threshold, Canny and distance transform where they are
  /// asked for.  None without a learned background, or for a picture of another size.
  [[nodiscard]] std::optional<EvidenceSource> evidence(const cv::Mat& picture);

 private:
  EvidenceSettings settings_;
  std::vector<std::shared_ptr<const cv::Mat>> pictures_;
  std::shared_ptr<const cv::Mat> median_;
  std::shared_ptr<cv::BackgroundSubtractorMOG2> mixtures_;
  std::pair<int, int> size_{0, 0};  ///< Of the field [px].
  std::size_t learned_ = 0;         ///< Pictures given.
  std::size_t stride_ = 1;          ///< One picture in so many is kept for the median.
};

}  // namespace chorus::silhouette
