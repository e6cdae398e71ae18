// What a picture says of the person's outline: a distance field (Madaras et al. 3.5, Fig. 5).
//
// OpenCV runs on one thread here: cv::Canny cuts a picture into as many stripes as there are
// threads and decides at their borders in another order, so a number would depend on the machine
// (docs/benchmarks/positioner.md, "threads").
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace cv {
class Mat;
}

namespace chorus::silhouette {

struct EvidenceSettings {
  double scale = 0.5;       ///< The field is this much smaller than the picture.
  double farthest = 30.0;   ///< Larger distances count as this [px of the field].
  double threshold = 18.0;  ///< Least difference from the background, of 255.
};

/// A field of distances from the nearest edge, and what is not background.
class Evidence {
 public:
  /// Distance from the nearest edge at a pixel of the picture [px of the picture], interpolated;
  /// the farthest outside the picture.
  [[nodiscard]] double distance(const Eigen::Vector2d& pixel) const;
  /// Derivative of that.
  [[nodiscard]] Eigen::Vector2d slope(const Eigen::Vector2d& pixel) const;
  /// True where the picture differs from the background.
  [[nodiscard]] bool is_foreground(const Eigen::Vector2d& pixel) const;
  /// Share of the picture that differs from the background.
  [[nodiscard]] double foreground() const { return foreground_; }
  /// The field itself, 32-bit floats [px of the field], for methods that need whole pictures.
  [[nodiscard]] const cv::Mat& field() const { return *field_; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] double farthest() const { return farthest_ / scale_; }

 private:
  friend class Background;
  [[nodiscard]] double at(int column, int row) const;

  std::shared_ptr<const cv::Mat> field_;  ///< 32-bit floats.
  std::shared_ptr<const cv::Mat> mask_;   ///< 8 bits.
  double scale_ = 1.0;
  double farthest_ = 0.0;
  double foreground_ = 0.0;
};

/// The room without the person: the median of pictures.
class Background {
 public:
  explicit Background(const EvidenceSettings& settings = {}) : settings_(settings) {}

  /// A picture (grey or BGR) for the median; at most 64 are kept.  It may show the person, as long
  /// as no place is covered in half of the pictures.
  void learn(const cv::Mat& picture);
  [[nodiscard]] std::size_t learned() const { return pictures_.size(); }

  /// Background subtraction, adaptive threshold, Canny, distance transform.  None without a learned
  /// background, or for a picture of another size.
  [[nodiscard]] std::optional<Evidence> evidence(const cv::Mat& picture);
  /// The same from a mask of the person that somebody else made (8 bits, any size of the same
  /// shape).
  [[nodiscard]] Evidence evidence_of_mask(const cv::Mat& mask, double scale) const;

 private:
  EvidenceSettings settings_;
  std::vector<std::shared_ptr<const cv::Mat>> pictures_;
  std::shared_ptr<const cv::Mat> median_;
};

}  // namespace chorus::silhouette
