#include "common/evaluation/scores.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/parse.h"

namespace chorus::evaluation {
namespace {

constexpr std::size_t kMostAnnotations = 100'000;

std::optional<double> share(double part, double whole) {
  if (!(whole > 0)) return std::nullopt;
  return part / whole;
}

double overlap(const Segment& a, const Segment& b) {
  const double both = std::min(a.end, b.end) - std::max(a.begin, b.begin);
  const double either = std::max(a.end, b.end) - std::min(a.begin, b.begin);
  return either > 0 ? std::max(0.0, both) / either : 1.0;
}

bool meets(const Segment& one, const std::vector<Segment>& others, double least) {
  return std::ranges::any_of(others, [&](const Segment& o) { return overlap(one, o) >= least; });
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t end = std::min(line.find(','), line.size());
    std::string_view field = line.substr(0, end);
    while (!field.empty() && (field.front() == ' ' || field.front() == '"')) field.remove_prefix(1);
    while (!field.empty() && std::string_view(" \r\"").find(field.back()) != std::string_view::npos)
      field.remove_suffix(1);
    out.push_back(field);
    if (end == line.size()) return out;
    line.remove_prefix(end + 1);
  }
}

Result<Annotation> annotation_of(std::string_view line, const std::string& where) {
  const auto fields = fields_of(line);
  if (fields.size() != 3)
    return fail(ErrorCode::Malformed, where, "needs three columns: limb, begin_s, end_s");
  const auto limb = inertial::limb_meant_by(fields[0]);
  const auto begin = parse_finite(fields[1]);
  const auto end = parse_finite(fields[2]);
  if (!limb)
    return fail(ErrorCode::Malformed, where,
                fmt::format("\"{}\" is no limb; there are Pelvis, ShankLeft, HandRight and so on",
                            fields[0]));
  if (!begin || !end || *end < *begin)
    return fail(ErrorCode::Malformed, where, "begin and end are seconds, begin first");
  return Annotation{*limb, {*begin, *end}};
}

}  // namespace

Counts& Counts::operator+=(const Counts& other) {
  true_positives += other.true_positives;
  false_positives += other.false_positives;
  false_negatives += other.false_negatives;
  true_negatives += other.true_negatives;
  return *this;
}

std::optional<double> Counts::precision() const {
  return share(true_positives, true_positives + false_positives);
}
std::optional<double> Counts::recall() const {
  return share(true_positives, true_positives + false_negatives);
}
std::optional<double> Counts::f() const {
  return share(2.0 * true_positives, 2.0 * true_positives + false_positives + false_negatives);
}

bool inside(const std::vector<Segment>& segments, double time) {
  return std::ranges::any_of(segments,
                             [&](const Segment& s) { return s.begin <= time && time <= s.end; });
}

Counts frame_counts(const std::vector<double>& times, const std::vector<Segment>& detected,
                    const std::vector<Segment>& annotated) {
  Counts out;
  for (const double time : times) {
    const bool found = inside(detected, time);
    const bool there = inside(annotated, time);
    double& count = found ? (there ? out.true_positives : out.false_positives)
                          : (there ? out.false_negatives : out.true_negatives);
    count += 1.0;
  }
  return out;
}

Counts segment_counts(const std::vector<Segment>& detected, const std::vector<Segment>& annotated,
                      double least_overlap) {
  Counts out;
  for (const Segment& each : detected)
    (meets(each, annotated, least_overlap) ? out.true_positives : out.false_positives) += 1.0;
  for (const Segment& each : annotated)
    if (!meets(each, detected, least_overlap)) out.false_negatives += 1.0;
  return out;
}

std::optional<double> kappa(const std::vector<double>& times, const std::vector<Segment>& one,
                            const std::vector<Segment>& other) {
  const Counts c = frame_counts(times, one, other);
  const double n = static_cast<double>(times.size());
  if (n == 0.0) return std::nullopt;
  const double agreed = (c.true_positives + c.true_negatives) / n;
  const double by_one = (c.true_positives + c.false_positives) / n;
  const double by_other = (c.true_positives + c.false_negatives) / n;
  const double chance = by_one * by_other + (1.0 - by_one) * (1.0 - by_other);
  return share(agreed - chance, 1.0 - chance);
}

std::optional<double> roc_area(const std::vector<Timed<double>>& values,
                               const std::vector<Segment>& segments) {
  std::vector<std::pair<double, bool>> all;
  for (const auto& each : values)
    if (std::isfinite(each.value)) all.emplace_back(each.value, inside(segments, each.time));
  std::ranges::sort(all);
  // Mann-Whitney: ranks of those inside, equal values sharing their mean rank.
  double ranks = 0.0, positives = 0.0;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i;
    while (end < all.size() && all[end].first == all[i].first) ++end;
    const double mean_rank = 0.5 * static_cast<double>(i + 1 + end);
    for (; i < end; ++i) {
      if (!all[i].second) continue;
      ranks += mean_rank;
      positives += 1.0;
    }
  }
  const double negatives = static_cast<double>(all.size()) - positives;
  return share(ranks - positives * (positives + 1.0) / 2.0, positives * negatives);
}

Result<std::vector<Annotation>> parse_annotations(std::string_view text, std::string_view origin) {
  std::vector<Annotation> out;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (number == 1 || line.find_first_not_of(" \r\t") == std::string_view::npos) continue;
    if (out.size() == kMostAnnotations)
      return fail(ErrorCode::TooLarge, std::string(origin), "has more than 100000 annotations");
    const auto each = annotation_of(line, fmt::format("{}:{}", origin, number));
    if (!each) return pass(each);
    out.push_back(*each);
  }
  return out;
}

std::vector<Segment> segments_of(const std::vector<Annotation>& all, inertial::Limb limb) {
  std::vector<Segment> out;
  for (const Annotation& each : all)
    if (each.limb == limb) out.push_back(each.segment);
  return out;
}

}  // namespace chorus::evaluation
