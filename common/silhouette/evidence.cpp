#include "common/silhouette/evidence.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/background_segm.hpp>

namespace chorus::silhouette {
namespace {

constexpr std::size_t kMostPictures = 64;
constexpr double kCannyLow = 50.0;  // On a mask, whose edges are as steep as can be.
constexpr double kCannyHigh = 150.0;
constexpr double kFilters = 14.0;  // Reach of blur, opening, closing and Canny together [px].

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

void clean(cv::Mat& mask) {
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5});
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, kernel);
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, kernel);
}

/// Pixels that differ by more than the threshold and more than others do.
cv::Mat differing(const cv::Mat& difference, double common, const EvidenceSettings& settings) {
  cv::Mat smooth;
  cv::GaussianBlur(difference, smooth, {5, 5}, 1.0);
  cv::Mat mask;
  if (settings.surroundings > 1) {
    cv::adaptiveThreshold(smooth, mask, 255.0, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY,
                          settings.surroundings | 1, -settings.threshold);
  } else {
    // A change of light changes everything alike: its mean is taken off.
    cv::threshold(smooth, mask, std::max(settings.threshold, 1.5 * common), 255.0,
                  cv::THRESH_BINARY);
  }
  clean(mask);
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
  column -= origin_.x();
  row -= origin_.y();
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
  constexpr double kMost = 1e6;
  if (!(std::abs(pixel.x()) < kMost && std::abs(pixel.y()) < kMost)) return false;
  const int column = static_cast<int>(std::lround((pixel.x() + 0.5) * scale_ - 0.5)) - origin_.x();
  const int row = static_cast<int>(std::lround((pixel.y() + 0.5) * scale_ - 0.5)) - origin_.y();
  if (column < 0 || row < 0 || column >= mask_->cols || row >= mask_->rows) return false;
  return mask_->at<std::uint8_t>(row, column) != 0;
}

double usual_scale(int width) {
  constexpr double kWidest = 480.0;
  return std::min(1.0, kWidest / std::max(1, width));
}

void Background::learn(const cv::Mat& picture) {
  if (picture.empty()) return;
  const OneThread one;
  auto grey = std::make_shared<const cv::Mat>(small_grey(picture, settings_.scale));
  const std::pair size(grey->cols, grey->rows);
  if (learned_ > 0 && size != size_) return;
  size_ = size;
  ++learned_;
  if (settings_.model == BackgroundModel::Mixtures) {
    if (!mixtures_) mixtures_ = cv::createBackgroundSubtractorMOG2();
    cv::Mat ignored;
    mixtures_->apply(*grey, ignored);
    return;
  }
  if ((learned_ - 1) % stride_ != 0) return;
  median_.reset();
  pictures_.push_back(std::move(grey));
  if (pictures_.size() < kMostPictures) return;
  // Every second one goes, so that those that are kept stay spread over the take.
  for (std::size_t i = 0; 2 * i < pictures_.size(); ++i) pictures_[i] = pictures_[2 * i];
  pictures_.resize(pictures_.size() / 2);
  stride_ *= 2;
}

std::optional<EvidenceSource> Background::evidence(const cv::Mat& picture) {
  if (learned_ == 0 || picture.empty()) return std::nullopt;
  const OneThread one;
  const cv::Mat grey = small_grey(picture, settings_.scale);
  if (std::pair(grey.cols, grey.rows) != size_) return std::nullopt;
  EvidenceSource out(settings_);
  if (settings_.model == BackgroundModel::Mixtures) {
    cv::Mat mask;
    mixtures_->apply(grey, mask, 0.0);  // Nothing is learned: the person may be there.
    cv::threshold(mask, mask, 200.0, 255.0, cv::THRESH_BINARY);  // Shadows are 127.
    clean(mask);
    out.mask_ = std::make_shared<const cv::Mat>(std::move(mask));
    return out;
  }
  if (!median_) median_ = std::make_shared<const cv::Mat>(median_of(pictures_));
  cv::Mat difference;
  cv::absdiff(grey, *median_, difference);
  out.common_ = cv::mean(difference)[0];
  out.difference_ = std::make_shared<const cv::Mat>(std::move(difference));
  return out;
}

Evidence EvidenceSource::whole() const {
  const cv::Mat& all = mask_ ? *mask_ : *difference_;
  return cut(0, 0, all.cols, all.rows);
}

Evidence EvidenceSource::within(const Region& region) const {
  if (region.isEmpty() || !region.min().allFinite() || !region.max().allFinite()) return whole();
  // Edges outside count as far as the field reaches, and pixels as far as the filters do.
  const double beyond = settings_.farthest + kFilters + settings_.surroundings / 2.0;
  const cv::Mat& all = mask_ ? *mask_ : *difference_;
  const auto in = [&](double pixel, double by, int most) {
    return static_cast<int>(std::clamp(pixel * settings_.scale + by, 0.0, 1.0 * most));
  };
  return cut(in(region.min().x(), -beyond, all.cols), in(region.min().y(), -beyond, all.rows),
             in(region.max().x(), beyond + 1.0, all.cols),
             in(region.max().y(), beyond + 1.0, all.rows));
}

Evidence EvidenceSource::cut(int left, int top, int right, int bottom) const {
  const OneThread one;
  const cv::Rect part(left, top, right - left, bottom - top);
  if (part.empty()) return whole();
  Evidence out;
  out.origin_ = {left, top};
  out.scale_ = settings_.scale;
  out.farthest_ = settings_.farthest;
  const cv::Mat mask =
      mask_ ? (*mask_)(part).clone() : differing((*difference_)(part).clone(), common_, settings_);
  out.field_ = std::make_shared<const cv::Mat>(distances_from_edges(mask, settings_.farthest));
  out.foreground_ = static_cast<double>(cv::countNonZero(mask)) /
                    static_cast<double>(std::max<std::size_t>(1, mask.total()));
  out.mask_ = std::make_shared<const cv::Mat>(mask);
  return out;
}

EvidenceSource evidence_of_mask(const cv::Mat& mask, double scale,
                                const EvidenceSettings& settings) {
  EvidenceSource out(settings);
  out.settings_.scale = scale;
  out.mask_ = std::make_shared<const cv::Mat>(mask.clone());
  return out;
}

}  // namespace chorus::silhouette
