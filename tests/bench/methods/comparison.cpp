#include "tests/bench/methods/comparison.h"

#include <algorithm>
#include <cmath>

#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr double kLow = 0.05;
constexpr double kHigh = 0.95;

/// A lower result is better; a missing value is infinitely bad.
double badness(double value, Better better) {
  if (std::isnan(value)) return std::numeric_limits<double>::infinity();
  return better == Better::Lower ? value : -value;
}

}  // namespace

Comparison::Comparison(std::string case_name, std::string metric, std::string unit, Better better)
    : case_name_(std::move(case_name)),
      metric_(std::move(metric)),
      unit_(std::move(unit)),
      better_(better) {}

const Comparison::Method& Comparison::find(const std::string& name) const {
  static const Method kNone{};
  const auto at = std::find_if(methods_.begin(), methods_.end(),
                               [&](const Method& each) { return each.name == name; });
  return at == methods_.end() ? kNone : *at;
}

void Comparison::add(const std::string& method, std::size_t draw, double value) {
  auto at = std::find_if(methods_.begin(), methods_.end(),
                         [&](const Method& each) { return each.name == method; });
  if (at == methods_.end()) at = methods_.insert(methods_.end(), Method{method, {}, {}});
  at->draws.push_back(draw);
  at->values.push_back(value);
}

Spread Comparison::spread_of(const std::string& method) const {
  std::vector<double> bad;
  for (const double value : find(method).values) bad.push_back(badness(value, better_));
  const auto failed =
      std::count_if(bad.begin(), bad.end(), [](double value) { return !std::isfinite(value); });
  const auto count = static_cast<std::size_t>(failed);
  if (better_ == Better::Higher) {
    return {-median(bad), -percentile(bad, kHigh), -percentile(bad, kLow), count, bad.size()};
  }
  return {median(bad), percentile(bad, kLow), percentile(bad, kHigh), count, bad.size()};
}

double Comparison::won_percent(const std::string& baseline) const {
  const Method& ours = find(kOurs);
  const Method& theirs = find(baseline);
  std::size_t both = 0;
  std::size_t won = 0;
  for (std::size_t i = 0; i < ours.draws.size(); ++i) {
    const auto at = std::find(theirs.draws.begin(), theirs.draws.end(), ours.draws[i]);
    if (at == theirs.draws.end()) continue;
    const double beside = theirs.values[static_cast<std::size_t>(at - theirs.draws.begin())];
    ++both;
    won += badness(ours.values[i], better_) < badness(beside, better_) ? 1U : 0U;
  }
  return both == 0 ? kNoRatio : 100.0 * static_cast<double>(won) / static_cast<double>(both);
}

void Comparison::report(Report& report) const {
  Row row{case_name_, metric_, spread_of(kOurs).median, unit_, "", kNoRatio};
  row.spread = spread_of(kOurs);
  for (const Method& each : methods_) {
    if (each.name == kOurs) continue;
    Row beside = row;
    beside.baseline = each.name;
    beside.beside = spread_of(each.name);
    const double theirs = beside.beside->median;
    beside.ratio = std::isfinite(theirs) ? row.value / theirs : kNoRatio;
    beside.won_percent = won_percent(each.name);
    report.row(std::move(beside));
  }
  if (methods_.size() == 1) report.row(std::move(row));
}

void Comparison::report_wins(Report& report) const {
  for (const Method& each : methods_) {
    if (each.name == kOurs) continue;
    report.row(case_name_, "win_percent", won_percent(each.name), "%", each.name);
  }
}

}  // namespace chorus::bench
