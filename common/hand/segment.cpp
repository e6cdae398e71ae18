#include "common/hand/segment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

namespace chorus::hand {
namespace {

constexpr int kLevels = 256;
// A most frequent value above this: the ground is in this channel brighter than the hand (4.1 names
// no number; half the range separates white from dark grounds).
constexpr int kPaperMode = 127;
// Size of the opening, as a share of the picture's longer side.
constexpr double kOpening = 0.004;
// Size of the median filter [px].  Without it grain tears the outline where hand and ground are
// much alike: 5 of 150 drawn hands then had a finger too short.
constexpr int kGrain = 5;
// Least distance between the means on both sides of the cut [levels]: below it, it cuts noise.
constexpr double kLeastContrast = 18.0;
// Least share of the variance that the cut explains: 0.64 for a uniform channel.
constexpr double kLeastSeparation = 0.68;
constexpr double kLeastShare = 0.02;  // of the picture that a hand fills

std::array<double, kLevels> histogram(const cv::Mat& channel) {
  std::array<double, kLevels> counts{};
  for (int y = 0; y < channel.rows; ++y) {
    const auto* row = channel.ptr<unsigned char>(y);
    for (int x = 0; x < channel.cols; ++x) counts[row[x]] += 1.0;
  }
  return counts;
}

cv::Mat opened(const cv::Mat& mask) {
  const int radius = std::max(1, cvRound(0.5 * kOpening * std::max(mask.cols, mask.rows)));
  const int side = 2 * radius + 1;
  cv::Mat out;
  cv::morphologyEx(mask, out, cv::MORPH_OPEN,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side}));
  return out;
}

struct Cut {
  int level = 0;
  double below = 0.0;  ///< Means on both sides.
  double above = 0.0;
  double separation = 0.0;  ///< Between-class variance over all variance.
};

/// Otsu's cut.
Cut otsu(const cv::Mat& channel) {
  const auto counts = histogram(channel);
  double total = 0.0, sum = 0.0, squares = 0.0;
  for (int i = 0; i < kLevels; ++i) {
    total += counts[i];
    sum += i * counts[i];
    squares += 1.0 * i * i * counts[i];
  }
  const double variance = squares / total - (sum / total) * (sum / total);
  Cut best;
  double n = 0.0, s = 0.0, most = 0.0;
  for (int i = 0; i + 1 < kLevels; ++i) {
    n += counts[i];
    s += i * counts[i];
    if (n < kLeastShare * total || total - n < kLeastShare * total) continue;
    const double a = s / n, b = (sum - s) / (total - n);
    const double between = n / total * (1.0 - n / total) * (b - a) * (b - a);
    if (between <= most) continue;
    most = between;
    best = {i, a, b, variance > 0.0 ? between / variance : 0.0};
  }
  return best;
}

/// True if the border of the picture is mostly above the level.
bool border_above(const cv::Mat& channel, int level) {
  int above = 0, all = 0;
  const auto look = [&](int x, int y) {
    ++all;
    if (channel.at<unsigned char>(y, x) > level) ++above;
  };
  for (int x = 0; x < channel.cols; ++x) look(x, 0), look(x, channel.rows - 1);
  for (int y = 0; y < channel.rows; ++y) look(0, y), look(channel.cols - 1, y);
  return 2 * above > all;
}

/// The mask of one channel; none without contrast.
std::optional<cv::Mat> channel_mask(const cv::Mat& channel) {
  const Cut cut = otsu(channel);
  if (cut.above - cut.below < kLeastContrast || cut.separation < kLeastSeparation)
    return std::nullopt;
  cv::Mat mask = channel > cut.level;
  if (border_above(channel, cut.level)) cv::bitwise_not(mask, mask);
  return mask;
}

/// Saturation, value, red chroma and yellow chroma.
std::array<cv::Mat, 4> channels_of(const cv::Mat& bgr) {
  cv::Mat hsv, lab, ycc;
  cv::cvtColor(bgr, hsv, cv::COLOR_BGR2HSV);
  cv::cvtColor(bgr, lab, cv::COLOR_BGR2Lab);
  cv::cvtColor(bgr, ycc, cv::COLOR_BGR2YCrCb);
  std::array<cv::Mat, 4> out;
  cv::extractChannel(hsv, out[0], 1);
  cv::extractChannel(hsv, out[1], 2);
  cv::extractChannel(ycc, out[2], 1);
  cv::extractChannel(lab, out[3], 2);
  return out;
}

cv::Point at(const Pixel& p) { return {cvRound(p.x()), cvRound(p.y())}; }

/// Marks the hand's bones with 255, its surroundings with 0, and leaves 128 between, and towards
/// the forearm.
cv::Mat seeds(const SeenHand& seen, cv::Size size) {
  const Pixel& wrist = seen.joints[0];
  const double palm = (seen.joints[hand_joint(1, 0)] - seen.joints[hand_joint(4, 0)]).norm();
  cv::Mat far(size, CV_8U, cv::Scalar(0)), out(size, CV_8U, cv::Scalar(128));
  for (std::size_t i = 1; i < kHandJoints; ++i) {
    const Pixel& from = seen.joints[layout::kHandTable[i].parent];
    cv::line(far, at(from), at(seen.joints[i]), 255, std::max(1, cvRound(1.1 * palm)));
  }
  const Pixel down = wrist - seen.joints[hand_joint(2, 0)];
  cv::line(far, at(wrist), at(wrist + 6.0 * down), 255, std::max(1, cvRound(1.8 * palm)));
  out.setTo(0, far == 0);
  for (std::size_t i = 1; i < kHandJoints; ++i) {
    const Pixel& from = seen.joints[layout::kHandTable[i].parent];
    cv::line(out, at(from), at(seen.joints[i]), 255, std::max(1, cvRound(0.1 * palm)));
  }
  return out;
}

struct Colours {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  double count = 0.0;
};

Colours colours_where(const cv::Mat& lab, const cv::Mat& marks, int mark) {
  Colours out;
  for (int y = 0; y < lab.rows; ++y) {
    for (int x = 0; x < lab.cols; ++x) {
      if (marks.at<unsigned char>(y, x) != mark) continue;
      const auto& c = lab.at<cv::Vec3b>(y, x);
      const Eigen::Vector3d v(c[0], c[1], c[2]);
      out.mean += v;
      out.scatter += v * v.transpose();
      out.count += 1.0;
    }
  }
  if (out.count < 1.0) return out;
  out.mean /= out.count;
  out.scatter = out.scatter / out.count - out.mean * out.mean.transpose();
  return out;
}

/// None if a hand and its surroundings have the same colour, or if nothing surrounds it.
std::optional<cv::Mat> discriminant_mask(const cv::Mat& bgr, const SeenHand& seen) {
  cv::Mat lab;
  cv::cvtColor(bgr, lab, cv::COLOR_BGR2Lab);
  const cv::Mat marks = seeds(seen, bgr.size());
  const Colours on = colours_where(lab, marks, 255), off = colours_where(lab, marks, 0);
  if (on.count < 100.0 || off.count < 100.0) return std::nullopt;
  const Eigen::Matrix3d within = on.scatter + off.scatter + 4.0 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d direction = within.ldlt().solve(on.mean - off.mean);
  const double low = direction.dot(off.mean), high = direction.dot(on.mean);
  // The cut lies nearer to the narrower side, by their deviations along the direction.
  const double s_off = std::sqrt(std::max(1e-9, direction.dot(off.scatter * direction)));
  const double s_on = std::sqrt(std::max(1e-9, direction.dot(on.scatter * direction)));
  if (high - low < s_off + s_on) return std::nullopt;
  const double cut = low + (high - low) * std::clamp(s_off / (s_off + s_on), 0.3, 0.7);
  cv::Mat mask(bgr.size(), CV_8U);
  for (int y = 0; y < lab.rows; ++y) {
    for (int x = 0; x < lab.cols; ++x) {
      const auto& c = lab.at<cv::Vec3b>(y, x);
      mask.at<unsigned char>(y, x) =
          direction.dot(Eigen::Vector3d(c[0], c[1], c[2])) > cut ? 255 : 0;
    }
  }
  return mask;
}

}  // namespace

cv::Mat paper_mask(const cv::Mat& bgr) {
  cv::Mat hsv;
  cv::cvtColor(bgr, hsv, cv::COLOR_BGR2HSV);
  std::array<cv::Mat, 2> channels;
  std::array<int, 2> modes{};
  for (int i = 0; i < 2; ++i) {
    cv::extractChannel(hsv, channels[i], 1 + i);
    const auto counts = histogram(channels[i]);
    modes[i] = static_cast<int>(std::ranges::max_element(counts) - counts.begin());
  }
  std::array<bool, 2> keep{modes[0] <= kPaperMode, modes[1] <= kPaperMode};
  if (!keep[0] && !keep[1]) keep[modes[0] <= modes[1] ? 0 : 1] = true;
  cv::Mat mask(bgr.size(), CV_8U, cv::Scalar(255));
  for (int i = 0; i < 2; ++i) {
    if (keep[i]) mask &= channels[i] > cv::mean(channels[i])[0];
  }
  return opened(mask);
}

std::vector<cv::Mat> masks(const cv::Mat& picture, const SeenHand* seen) {
  cv::Mat bgr;
  cv::medianBlur(picture, bgr, kGrain);
  std::vector<cv::Mat> out, single;
  if (seen != nullptr) {
    if (const auto own = discriminant_mask(bgr, *seen)) out.push_back(opened(*own));
  }
  cv::Mat all(bgr.size(), CV_8U, cv::Scalar(255));
  for (const cv::Mat& channel : channels_of(bgr)) {
    const auto mask = channel_mask(channel);
    if (!mask) continue;
    all &= *mask;
    single.push_back(opened(*mask));
  }
  if (!single.empty()) out.push_back(opened(all));
  if (single.size() > 1) out.insert(out.end(), single.begin(), single.end());
  if (out.empty()) out.emplace_back(bgr.size(), CV_8U, cv::Scalar(0));
  return out;
}

}  // namespace chorus::hand
