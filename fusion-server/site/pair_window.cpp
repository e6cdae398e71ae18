#include "fusion-server/site/pair_window.h"

#include <algorithm>

#include <Eigen/LU>

namespace chorus::site {
namespace {

constexpr Duration kWindow = std::chrono::milliseconds(1000);
constexpr Duration kBreak = std::chrono::milliseconds(500);
// Nobody is compared with what is older; the delay between cells included.
constexpr Duration kOldest = std::chrono::milliseconds(1500);
// For how long the noise of a fused pelvis lasts [s]: a quarter of a second after filtering.
constexpr double kNoiseLasts = 0.25;

}  // namespace

void PairWindow::add(const PairSample& sample) {
  if (!samples_.empty() && sample.at <= samples_.back().at) return;
  if (samples_.empty() || sample.at - samples_.back().at > kBreak) {
    samples_.clear();
    first_ = sample.at;
  }
  samples_.push_back(sample);
  while (sample.at - samples_.front().at > kWindow) samples_.pop_front();
}

Timestamp PairWindow::newest() const { return samples_.empty() ? Timestamp{} : samples_.back().at; }

std::optional<PairEvidence> PairWindow::evidence(const CommonError& error, Timestamp now,
                                                 const SiteConfig& config) const {
  if (samples_.empty() || now - samples_.back().at > kOldest) return std::nullopt;
  PairEvidence all;
  all.seconds = seconds(samples_.back().at - samples_.front().at);
  const double count = static_cast<double>(samples_.size());
  const double independent = std::min(count, 1.0 + all.seconds / kNoiseLasts);
  PairSample mean{};
  for (const PairSample& each : samples_) {
    mean.off += each.off / count;
    mean.place += each.place / count;
    mean.velocity += each.velocity / count;
    mean.covariance += each.covariance / count;
  }
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const PairSample& each : samples_)
    scatter += (each.off - mean.off) * (each.off - mean.off).transpose() / count;
  const double bias = 2.0 * config.person_sigma * config.person_sigma;
  const Eigen::Matrix2d noise = mean.covariance + bias * Eigen::Matrix2d::Identity();
  all.term.off = mean.off;
  all.term.lever = lever_at(error, mean.place, mean.velocity);
  all.term.noise = bias * Eigen::Matrix2d::Identity() + mean.covariance / independent;
  const double excess = (noise.inverse() * scatter).trace() - 2.0;
  all.unsteady = -0.5 * independent * std::max(0.0, excess);
  return all;
}

}  // namespace chorus::site
