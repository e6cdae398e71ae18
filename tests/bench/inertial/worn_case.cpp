// Headings that drift and are corrected from bones that real cameras see, whose suit it is, and
// what following a suit costs.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/bench/inertial/inertial_cases.h"
#include "tests/bench/inertial/worn_takes.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

/// Headings of a take's sensors against the true ones, after the first part.
struct HeadingErrors {
  std::map<std::string, std::vector<double>> corrected;    ///< [rad]
  std::map<std::string, std::vector<double>> uncorrected;  ///< With the first part's heading.
};

double rms_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? kNoRatio : std::sqrt(sum / static_cast<double>(values.size()));
}

double rms_of_all(const std::map<std::string, std::vector<double>>& errors) {
  std::vector<double> all;
  for (const auto& [name, each] : errors) all.insert(all.end(), each.begin(), each.end());
  return rms_of(all);
}

double worst_limb(const std::map<std::string, std::vector<double>>& errors) {
  double worst = 0.0;
  for (const auto& [name, each] : errors)
    if (!each.empty()) worst = std::max(worst, rms_of(each));
  return worst;
}

HeadingErrors heading_errors(const WornTake& take, const std::vector<SeenInstant>& seen,
                             const SensorFaults& faults) {
  HeadingErrors out;
  std::map<std::string, double> kept;  // the heading when the first part ended
  (void)fused_with(take, seen, &faults, [&](std::size_t i, const worn::Wear& wear) {
    if (i < take.judged_from()) return;
    const double time = static_cast<double>(i) / kTakeHz;
    const Timestamp at = importers::kDefaultStart + from_seconds(time);
    for (const WornReport& source : wear.reports(at)) {
      for (const WornSensorReport& one : source.sensors) {
        if (!one.calibrated) continue;
        const auto sensor = std::ranges::find(take.sensors, one.limb, &StandIn::limb);
        const auto s = static_cast<std::size_t>(sensor - take.sensors.begin());
        const double exact = true_heading(faults, s, time);
        const double first = kept.try_emplace(one.sensor, one.heading).first->second;
        out.corrected[one.sensor].push_back(wrap_angle(one.heading - exact));
        out.uncorrected[one.sensor].push_back(wrap_angle(first - exact));
      }
    }
  });
  return out;
}

Result<void> follow_headings(Report& report, const WornTake& take,
                             const std::vector<std::size_t>& cameras) {
  const auto seen = seen_by(take, cameras);
  if (!seen) return pass(seen);
  for (const double drift : {0.3, 0.05}) {
    SensorFaults faults;
    faults.drift = deg(drift);
    const HeadingErrors errors = heading_errors(take, *seen, faults);
    const std::string name =
        fmt::format("heading-{}-{}cameras-{}deg/s", take.name, cameras.size(), drift);
    const double rms = rms_of_all(errors.corrected);
    report.row(name, "heading_deg", to_deg(rms), "deg", "uncorrected",
               rms / rms_of_all(errors.uncorrected));
    report.row(name, "worst_limb_deg", to_deg(worst_limb(errors.corrected)), "deg");
    report.row(name, "uncorrected_deg", to_deg(rms_of_all(errors.uncorrected)), "deg");
    report.row(name, "sensors", static_cast<double>(errors.corrected.size()), "");
    if (drift < 0.1) continue;
    const bool two = cameras.size() == 2;
    report.condition(name + (two ? ": rms at most 6.5 deg" : ": rms at most 5 deg"),
                     rms <= deg(two ? 6.5 : 5.0));
    report.condition(name + (two ? ": worst limb at most 12 deg" : ": worst limb at most 9 deg"),
                     worst_limb(errors.corrected) <= deg(two ? 12.0 : 9.0));
  }
  return {};
}

/// Three people of whom the first wears the suit: two takes, and one of them 15 s later.
struct Company {
  const WornTake* take;
  std::array<FusedTake, 2> fused;
};

struct FoundWearers {
  double right = 0.0, wrong = 0.0, none = 0.0, in_time = 0.0;
  std::vector<double> times;  ///< [s]
};

void find_wearer(const Company& company, std::size_t begin, bool still, FoundWearers& out) {
  constexpr std::size_t kLater = 450;   // 15 s
  constexpr std::size_t kSearch = 300;  // 10 s
  const SensorFaults faults{.seed = 1 + begin};
  worn::Wear wear;
  wear.configure({.enabled = true}, {*SensorId::parse(kStandInSuit)});
  for (std::size_t k = 0; k < kSearch; ++k) {
    const std::size_t i = still ? begin : begin + k;
    const Timestamp at =
        importers::kDefaultStart + from_seconds(static_cast<double>(begin + k) / kTakeHz);
    for (std::size_t half = 0; half < 2; ++half) {
      inertial::InertialFrame frame = said(*company.take, faults, 2 * i + (still ? 0 : half));
      const Duration on =
          at - importers::kDefaultStart + from_seconds(static_cast<double>(half) / kSensorHz);
      frame.captured = importers::kDefaultStart + on;
      for (auto& reading : frame.readings) reading.captured = frame.captured;
      wear.take(std::move(frame));
    }
    std::vector<FusedBody> bodies;
    const std::array<const std::optional<FusedBody>*, 3> all{
        &company.fused[0].bodies[i], &company.fused[1].bodies[i],
        &company.fused[0].bodies[(i + kLater) % company.fused[0].bodies.size()]};
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (!*all[p]) continue;
      bodies.push_back(**all[p]);
      bodies.back().id = PersonId{p + 1};
    }
    wear.learn(bodies, at);
    const auto wearer = wear.reports(at).front().wearer;
    if (!wearer) continue;
    const double time = static_cast<double>(k) / kTakeHz;
    (*wearer == PersonId{1} ? out.right : out.wrong) += 1.0;
    if (*wearer == PersonId{1} && time <= 3.0) out.in_time += 1.0;
    out.times.push_back(time);
    return;
  }
  out.none += 1.0;
}

constexpr const char* kNoCompany =
    "left out: needs CHORUS_EIGHT_VIEWS with gt_skel_gbl_ori.txt and CHORUS_XSENS13";

}  // namespace

Result<void> run_heading(Report& report) {
  const auto takes = worn_takes();
  if (!takes) return pass(takes);
  if (takes->empty()) report.note(std::string("heading: ") + kNoCompany);
  for (const WornTake& take : *takes) {
    for (const auto& cameras : {std::vector<std::size_t>{0, 2, 4, 6}, {0, 2}}) {
      if (auto ok = follow_headings(report, take, cameras); !ok) return ok;
      if (report.quick()) return {};
    }
  }
  return {};
}

Result<void> run_suit_of_whom(Report& report) {
  const auto takes = worn_takes();
  if (!takes) return pass(takes);
  if (takes->size() < 2) {
    report.note(std::string("suit-of-whom: ") + kNoCompany);
    return {};
  }
  std::array<std::vector<SeenInstant>, 2> seen;
  for (std::size_t t = 0; t < 2; ++t) {
    auto one = seen_by((*takes)[t], {0, 2, 4, 6});
    if (!one) return pass(one);
    seen[t] = std::move(*one);
  }
  FoundWearers moving, still;
  for (std::size_t t = 0; t < 2; ++t) {
    const Company company{&(*takes)[t],
                          {fused_with((*takes)[t], seen[t], nullptr),
                           fused_with((*takes)[1 - t], seen[1 - t], nullptr)}};
    const std::size_t size = std::min(seen[0].size(), seen[1].size());
    for (std::size_t begin = 0; begin + 300 < size; begin += report.quick() ? 300 : 60) {
      find_wearer(company, begin, false, moving);
      if (begin % 300 == 0) find_wearer(company, begin, true, still);
    }
  }
  const double asked = moving.right + moving.wrong + moving.none;
  report.row("suit-of-whom", "right_percent", 100.0 * moving.right / asked, "%");
  report.row("suit-of-whom", "right_in_3_s_percent", 100.0 * moving.in_time / asked, "%");
  report.row("suit-of-whom", "wrong", moving.wrong, "");
  report.row("suit-of-whom", "undecided_in_10_s", moving.none, "");
  report.row("suit-of-whom", "time_median_s", median(moving.times), "s");
  report.row("suit-of-whom", "named_while_still", still.right + still.wrong, "");
  report.condition("suit-of-whom: none wrong", moving.wrong == 0.0);
  report.condition("suit-of-whom: right in 3 s", moving.in_time == asked);
  report.condition("suit-of-whom: refused while all stand still", still.right + still.wrong == 0.0);
  return {};
}

Result<void> run_worn_cost(Report& report) {
  const auto takes = worn_takes();
  if (!takes) return pass(takes);
  if (takes->empty()) {
    report.note(std::string("cost: ") + kNoCompany);
    return {};
  }
  const WornTake& take = takes->front();
  const auto clock = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const double begin = clock();
  const auto seen = seen_by(take, {0, 1, 2, 3, 4, 5, 6, 7});
  if (!seen) return pass(seen);
  const double pipeline = clock() - begin;
  const SensorFaults faults;
  const FusedTake alone = fused_with(take, *seen, nullptr);
  const FusedTake with = fused_with(take, *seen, &faults);
  const double more = with.seconds_fusing - alone.seconds_fusing + with.seconds_wearing;
  const auto instants = static_cast<double>(take.size());
  report.row("cost", "pipeline_us", 1e6 * pipeline / instants, "us");
  report.row("cost", "with_13_sensors_us", 1e6 * more / instants, "us", "pipeline",
             more / pipeline);
  report.row("cost", "steering_us", 1e6 * (with.seconds_fusing - alone.seconds_fusing) / instants,
             "us");
  report.condition("cost: fusion + 10 %", more <= 0.1 * pipeline);
  report.note(
      "cost: 30 instants and 60 samples of 13 sensors a second, eight cameras, one person; "
      "live calibration included");
  return {};
}

}  // namespace chorus::bench
