#include "common/comparison/blocks.h"

#include <algorithm>
#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace chorus::comparison {
namespace {

constexpr double kFewestBlocks = 10.0;
/// Below this share of a full block a last one does not count.
constexpr double kHalf = 0.5;
constexpr double kMostAlike = 0.9;
constexpr double kFewestIndependent = 3.0;

struct Means {
  std::vector<double> times;
  std::vector<double> values;
};

Means block_means(const Series& series, double block) {
  Means out;
  if (series.times.empty()) return out;
  const double first = series.times.front();
  const double whole = series.times.back() - first;
  const double length = std::min(block, whole / kFewestBlocks);
  if (!(length > 0.0)) return {series.times, series.values};
  std::vector<std::size_t> counts;
  for (std::size_t i = 0; i < series.times.size(); ++i) {
    const double at = (series.times[i] - first) / length;
    const auto index = static_cast<std::size_t>(std::max(0.0, at));
    if (out.values.size() <= index) {
      out.values.resize(index + 1);
      out.times.resize(index + 1);
      counts.resize(index + 1);
    }
    out.values[index] += series.values[i];
    out.times[index] += series.times[i];
    ++counts[index];
  }
  const double usual =
      static_cast<double>(series.times.size()) / static_cast<double>(counts.size());
  Means kept;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto count = static_cast<double>(counts[i]);
    if (count < kHalf * usual || counts[i] == 0) continue;
    kept.values.push_back(out.values[i] / count);
    kept.times.push_back(out.times[i] / count);
  }
  return kept;
}

double quantile(double confidence, double freedom) {
  const boost::math::students_t distribution(freedom);
  return boost::math::quantile(distribution, 0.5 + 0.5 * std::clamp(confidence, 0.0, 0.999999999));
}

/// How many independent values say as much about a mean: consecutive ones of an AR(1) process.
double independent(const std::vector<double>& values, double middle) {
  const auto n = static_cast<double>(values.size());
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += (values[i] - middle) * (values[i] - middle);
    if (i > 0) products += (values[i] - middle) * (values[i - 1] - middle);
  }
  // A short series shows 1/n less than there is (Kendall 1954).
  const double alike = squares > 0.0 ? products / squares + 1.0 / n : 0.0;
  const double bounded = std::clamp(alike, 0.0, kMostAlike);
  return std::max(kFewestIndependent, n * (1.0 - bounded) / (1.0 + bounded));
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

Estimate mean_of(const Series& series, double block, double confidence) {
  if (series.values.empty()) return {0.0, std::numeric_limits<double>::infinity()};
  Estimate out{mean(series.values), std::numeric_limits<double>::infinity()};
  const Means means = block_means(series, block);
  if (means.values.size() < 2) return out;
  const double middle = mean(means.values);
  double squares = 0.0;
  for (const double value : means.values) squares += (value - middle) * (value - middle);
  const auto n = static_cast<double>(means.values.size());
  const double own = std::min(n, independent(means.values, middle));
  out.half = quantile(confidence, own - 1.0) * std::sqrt(squares / (n - 1.0) / own);
  return out;
}

Estimate slope_of(const Series& series, double block, double confidence) {
  Estimate out{0.0, std::numeric_limits<double>::infinity()};
  const Means means = block_means(series, block);
  if (means.values.size() < 3) return out;
  const double t0 = mean(means.times);
  const double y0 = mean(means.values);
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < means.values.size(); ++i) {
    xx += (means.times[i] - t0) * (means.times[i] - t0);
    xy += (means.times[i] - t0) * (means.values[i] - y0);
  }
  if (!(xx > 0.0)) return out;
  out.mean = xy / xx;
  double squares = 0.0;
  for (std::size_t i = 0; i < means.values.size(); ++i) {
    const double left = means.values[i] - y0 - out.mean * (means.times[i] - t0);
    squares += left * left;
  }
  const auto n = static_cast<double>(means.values.size());
  out.half = quantile(confidence, n - 2.0) * std::sqrt(squares / (n - 2.0) / xx);
  return out;
}

}  // namespace chorus::comparison
