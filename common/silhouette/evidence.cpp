#include "common/silhouette/evidence.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace chorus::silhouette {
namespace {

constexpr std::size_t kMostPictures = 64;
constexpr double kCannyLow = 50.0;  // On a mask, whose edges are as steep as can be.
constexpr double kCannyHigh = 150.0;

/// One thread while it lives.
class OneThread {
 public:
  OneThread() : threads_(cv::getNumThreads()) { cv::setNumThreads(1); }
  ~OneThread() { cv::setNumThreads(threads_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int threads_;
};

cv::Mat small_grey(const cv::Mat& picture, double scale) {
  cv::Mat grey = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  cv::Mat out;
  cv::resize(grey, out, {}, scale, scale, cv::INTER_AREA);
  return out;
}

cv::Mat median_of(const std::vector<std::shared_ptr<const cv::Mat>>& pictures) {
  cv::Mat out(pictures.front()->size(), CV_8U);
  std::vector<std::uint8_t> values(pictures.size());
  for (int row = 0; row < out.rows; ++row) {
    for (int column = 0; column < out.cols; ++column) {
      for (std::size_t i = 0; i < pictures.size(); ++i)
        values[i] = pictures[i]->at<std::uint8_t>(row, column);
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      out.at<std::uint8_t>(row, column) = *middle;
    }
  }
  return out;
}

/// Pixels that differ by more than the threshold and more than what is around them usually does.
cv::Mat differing(const cv::Mat& picture, const cv::Mat& background, double threshold) {
  cv::Mat difference;
  cv::absdiff(picture, background, difference);
  cv::GaussianBlur(difference, difference, {5, 5}, 1.0);
  // A change of light changes everything alike: its median is taken off.
  cv::Mat mask;
  const double common = cv::mean(difference)[0];
  cv::threshold(difference, mask, std::max(threshold, 1.5 * common), 255.0, cv::THRESH_BINARY);
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5});
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, kernel);
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, kernel);
  return mask;
}

cv::Mat distances_from_edges(const cv::Mat& mask, double farthest) {
  cv::Mat edges;
  cv::Canny(mask, edges, kCannyLow, kCannyHigh);
  cv::Mat away = 255 - edges;
  cv::Mat field;
  cv::distanceTransform(away, field, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::min(field, farthest, field);
  return field;
}

}  // namespace

double Evidence::at(int column, int row) const {
  if (column < 0 || row < 0 || column >= field_->cols || row >= field_->rows) return farthest_;
  return static_cast<double>(field_->at<float>(row, column));
}

double Evidence::distance(const Eigen::Vector2d& pixel) const {
  const double x = (pixel.x() + 0.5) * scale_ - 0.5;
  const double y = (pixel.y() + 0.5) * scale_ - 0.5;
  constexpr double kMost = 1e6;
  if (!(std::abs(x) < kMost && std::abs(y) < kMost)) return farthest_ / scale_;
  const int column = static_cast<int>(std::floor(x));
  const int row = static_cast<int>(std::floor(y));
  const double u = x - column;
  const double v = y - row;
  const double value = (1 - u) * (1 - v) * at(column, row) + u * (1 - v) * at(column + 1, row) +
                       (1 - u) * v * at(column, row + 1) + u * v * at(column + 1, row + 1);
  return value / scale_;
}

Eigen::Vector2d Evidence::slope(const Eigen::Vector2d& pixel) const {
  const double step = 0.5 / scale_;
  const Eigen::Vector2d across(step, 0.0);
  const Eigen::Vector2d down(0.0, step);
  return Eigen::Vector2d(distance(pixel + across) - distance(pixel - across),
                         distance(pixel + down) - distance(pixel - down)) /
         (2.0 * step);
}

bool Evidence::is_foreground(const Eigen::Vector2d& pixel) const {
  const auto column = static_cast<int>(std::lround((pixel.x() + 0.5) * scale_ - 0.5));
  const auto row = static_cast<int>(std::lround((pixel.y() + 0.5) * scale_ - 0.5));
  if (column < 0 || row < 0 || column >= mask_->cols || row >= mask_->rows) return false;
  return mask_->at<std::uint8_t>(row, column) != 0;
}

void Background::learn(const cv::Mat& picture) {
  if (pictures_.size() >= kMostPictures || picture.empty()) return;
  const OneThread one;
  auto grey = std::make_shared<const cv::Mat>(small_grey(picture, settings_.scale));
  if (!pictures_.empty() && grey->size() != pictures_.front()->size()) return;
  pictures_.push_back(std::move(grey));
  median_.reset();
}

std::optional<Evidence> Background::evidence(const cv::Mat& picture) {
  if (pictures_.empty() || picture.empty()) return std::nullopt;
  const OneThread one;
  if (!median_) median_ = std::make_shared<const cv::Mat>(median_of(pictures_));
  const cv::Mat grey = small_grey(picture, settings_.scale);
  if (grey.size() != median_->size()) return std::nullopt;
  return evidence_of_mask(differing(grey, *median_, settings_.threshold), settings_.scale);
}

Evidence Background::evidence_of_mask(const cv::Mat& mask, double scale) const {
  const OneThread one;
  Evidence out;
  out.scale_ = scale;
  out.farthest_ = settings_.farthest;
  out.mask_ = std::make_shared<const cv::Mat>(mask.clone());
  out.field_ = std::make_shared<const cv::Mat>(distances_from_edges(mask, settings_.farthest));
  out.foreground_ = static_cast<double>(cv::countNonZero(mask)) /
                    static_cast<double>(std::max<std::size_t>(1, mask.total()));
  return out;
}

}  // namespace chorus::silhouette
