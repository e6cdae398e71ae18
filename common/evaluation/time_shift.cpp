#include "common/evaluation/time_shift.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

constexpr std::size_t kParts = 8;          // of the take, for the standard error
constexpr std::size_t kLeastSamples = 50;  // in both worlds at one shift
constexpr double kGap = 0.1;               // samples further apart are not joined [s]

template <class Value>
auto after(const std::vector<Timed<Value>>& track, double time) {
  return std::ranges::lower_bound(track, time, {}, &Timed<Value>::time);
}

std::optional<double> value_at(const Signal& signal, double time) {
  const auto next = after(signal, time);
  if (next == signal.end()) return std::nullopt;
  if (next->time == time) return next->value;
  if (next == signal.begin()) return std::nullopt;
  const auto before = std::prev(next);
  if (next->time - before->time > kGap) return std::nullopt;
  const double share = (time - before->time) / (next->time - before->time);
  return before->value + share * (next->value - before->value);
}

std::optional<Eigen::Vector3d> place_at(const std::vector<Timed<Eigen::Vector3d>>& places,
                                        double time) {
  const auto next = after(places, time);
  if (next == places.end()) return std::nullopt;
  if (next->time == time) return next->value;
  if (next == places.begin()) return std::nullopt;
  const auto before = std::prev(next);
  if (next->time - before->time > kGap) return std::nullopt;
  const double share = (time - before->time) / (next->time - before->time);
  return Eigen::Vector3d(before->value + share * (next->value - before->value));
}

/// Sums from which a correlation follows, so that parts can be left out.
struct Sums {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;

  void add(double a, double b) {
    n += 1;
    x += a;
    y += b;
    xx += a * a;
    yy += b * b;
    xy += a * b;
  }
  Sums& operator+=(const Sums& o) {
    n += o.n, x += o.x, y += o.y, xx += o.xx, yy += o.yy, xy += o.xy;
    return *this;
  }
  [[nodiscard]] double covariance() const { return n > 0 ? xy / n - x * y / (n * n) : 0.0; }
  [[nodiscard]] double variances() const {
    return n > 0 ? std::max(0.0, xx / n - x * x / (n * n)) * std::max(0.0, yy / n - y * y / (n * n))
                 : 0.0;
  }
};

/// Sums of every pair, shift and part of the take.
struct Search {
  std::vector<double> shifts;
  std::vector<std::vector<std::array<Sums, kParts>>> sums;  ///< [pair][shift][part]
};

std::array<Sums, kParts> sums_at(const SignalPair& pair, double shift) {
  std::array<Sums, kParts> out;
  if (pair.inertial.empty() || pair.tracked.empty()) return out;
  const double begin = pair.tracked.front().time;
  const double length = std::max(1e-9, pair.tracked.back().time - begin);
  for (const auto& each : pair.tracked) {
    const auto other = value_at(pair.inertial, each.time - shift);
    if (!other) continue;
    const auto part = static_cast<std::size_t>((each.time - begin) / length * kParts);
    out[std::min(part, kParts - 1)].add(each.value, *other);
  }
  return out;
}

/// The mean correlation of all pairs at one shift, without one part (kParts: none left out).
double correlation(const Search& search, std::size_t shift, std::size_t without) {
  double sum = 0.0;
  double count = 0.0;
  for (const auto& pair : search.sums) {
    Sums total;
    for (std::size_t part = 0; part < kParts; ++part)
      if (part != without) total += pair[shift][part];
    const double variances = total.variances();
    if (total.n < static_cast<double>(kLeastSamples) || variances <= 0) continue;
    sum += total.covariance() / std::sqrt(variances);
    count += 1.0;
  }
  return count > 0 ? sum / count : -1.0;
}

/// The shift of the largest correlation by a parabola through it and its neighbours; the edge of
/// the search if the largest lies there.
double best_shift(const Search& search, std::size_t without) {
  std::vector<double> all(search.shifts.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = correlation(search, i, without);
  const auto best = static_cast<std::size_t>(std::ranges::max_element(all) - all.begin());
  if (best == 0 || best + 1 == all.size()) return search.shifts[best];
  const double bend = all[best - 1] - 2.0 * all[best] + all[best + 1];
  const double slope = 0.5 * (all[best + 1] - all[best - 1]);
  const double step = search.shifts[1] - search.shifts[0];
  return search.shifts[best] - (bend < 0 ? std::clamp(slope / bend, -0.5, 0.5) * step : 0.0);
}

Search searched(const std::vector<SignalPair>& pairs, const TimeShiftOptions& options) {
  Search search;
  const int reach = static_cast<int>(std::ceil(options.largest / options.step));
  for (int i = -reach; i <= reach; ++i) search.shifts.push_back(i * options.step);
  for (const SignalPair& pair : pairs) {
    auto& all = search.sums.emplace_back();
    for (const double shift : search.shifts) all.push_back(sums_at(pair, shift));
  }
  return search;
}

/// Jackknife: what the shift would be without each part of the take.
double standard_error(const Search& search, double shift) {
  double sum = 0.0;
  for (std::size_t part = 0; part < kParts; ++part) {
    const double off = best_shift(search, part) - shift;
    sum += off * off;
  }
  return std::sqrt(sum * (kParts - 1.0) / kParts);
}

}  // namespace

std::optional<Eigen::Quaterniond> orientation_at(const OrientationTrack& track, double time,
                                                 double gap) {
  const auto next = after(track, time);
  if (next == track.end()) return std::nullopt;
  if (next->time == time) return next->value;
  if (next == track.begin()) return std::nullopt;
  const auto before = std::prev(next);
  if (next->time - before->time > gap) return std::nullopt;
  const double share = (time - before->time) / (next->time - before->time);
  return normalised_or_identity(before->value).slerp(share, normalised_or_identity(next->value));
}

Signal angular_rates(const OrientationTrack& track, double half_window) {
  Signal out;
  if (!(half_window > 0)) return out;
  for (const auto& each : track) {
    const auto a = orientation_at(track, each.time - half_window, kGap);
    const auto b = orientation_at(track, each.time + half_window, kGap);
    if (a && b) out.push_back({each.time, angular_distance(*a, *b) / (2.0 * half_window)});
  }
  return out;
}

Signal accelerations(const std::vector<Timed<Eigen::Vector3d>>& places, double half_window) {
  Signal out;
  if (!(half_window > 0)) return out;
  for (const auto& each : places) {
    const auto a = place_at(places, each.time - half_window);
    const auto b = place_at(places, each.time + half_window);
    if (!a || !b) continue;
    const Eigen::Vector3d second = *a - 2.0 * each.value + *b;
    out.push_back({each.time, second.norm() / (half_window * half_window)});
  }
  return out;
}

Result<TimeShift> find_time_shift(const std::vector<SignalPair>& pairs,
                                  const TimeShiftOptions& options) {
  const Search search = searched(pairs, options);
  TimeShift found;
  found.shift = best_shift(search, kParts);
  const double place = (found.shift - search.shifts.front()) / options.step;
  const auto nearest = static_cast<std::size_t>(std::lround(place));
  found.correlation = correlation(search, std::min(nearest, search.shifts.size() - 1), kParts);
  if (!(found.correlation >= options.least_correlation))
    return fail(
        ErrorCode::InvalidArgument, "time",
        "tracker and sensors do not move alike at any shift; are they of one take, and does "
        "somebody move in it?");
  if (std::abs(found.shift) >= options.largest)
    return fail(ErrorCode::InvalidArgument, "time",
                "they agree best at the end of the search; the clocks differ by more");
  found.sigma = standard_error(search, found.shift);
  return found;
}

}  // namespace chorus::evaluation
