#include "tests/bench/accuracy/fusion_report.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace chorus::bench {
namespace {

/// True if the method has this figure; not every method has every figure.
bool has_any(const Draws& draws, std::size_t method, std::size_t metric) {
  return std::ranges::any_of(draws, [&](const std::vector<Scored>& draw) {
    return !std::isnan(draw[method].values[metric]);
  });
}

/// Reports the figures of stated covariances, of which lower is not better, for every method that
/// states covariances.
void report_stated(Report& report, const std::string& name, const Draws& draws,
                   std::size_t metric) {
  const Comparison found = compare(name, draws, metric);
  const Metric& shown = metrics()[metric];
  for (std::size_t method = 0; !draws.empty() && method < draws.front().size(); ++method) {
    if (!has_any(draws, method, metric)) continue;
    const std::string& of = draws.front()[method].method;
    const Spread spread = found.spread_of(of);
    report.row({name, shown.name, spread.median, shown.unit, of, kNoRatio, spread});
  }
}

/// Reports errors over the joints that every method reports.
void report_common(Report& report, const std::string& name, const Draws& draws) {
  Comparison comparison(name, "mpjpe_common_mm", "mm");
  for (std::size_t draw = 0; draw < draws.size(); ++draw) {
    for (const Scored& scored : draws[draw]) {
      if (!std::isnan(scored.common)) comparison.add(scored.method, draw, to_mm(scored.common));
    }
  }
  comparison.report(report);
}

}  // namespace

bool is_short_metric(const Metric& metric) {
  return metric.name == "mpjpe_mm" || metric.name == "flip_percent" ||
         metric.name == "limb_flip_percent" || metric.name == "missing_percent";
}

Comparison compare(const std::string& name, const Draws& draws, std::size_t metric) {
  const Metric& shown = metrics()[metric];
  Comparison comparison(name, shown.name, shown.unit);
  for (std::size_t method = 0; !draws.empty() && method < draws.front().size(); ++method) {
    if (!has_any(draws, method, metric)) continue;
    for (std::size_t draw = 0; draw < draws.size(); ++draw) {
      const Scored& scored = draws[draw][method];
      const double value = scored.values[metric];
      // NaN here means that there were no joints of this kind, which is not a failure.
      if (shown.kind == Kind::Stated && std::isnan(value)) continue;
      comparison.add(scored.method, draw, value);
    }
  }
  return comparison;
}

Comparison report_draws(Report& report, const std::string& name, const Draws& draws, bool in_full) {
  for (std::size_t metric = 0; metric < metrics().size(); ++metric) {
    if (!in_full && !is_short_metric(metrics()[metric])) continue;
    if (metrics()[metric].kind == Kind::Stated) {
      report_stated(report, name, draws, metric);
    } else {
      compare(name, draws, metric).report(report);
    }
  }
  if (in_full) report_common(report, name, draws);
  Comparison errors = compare(name, draws, 0);
  errors.report_wins(report);
  return errors;
}

}  // namespace chorus::bench
