// Orientation filters against optical truth: BROAD (D. Laidig, M. Caruso, A. Cereatti, T. Seel,
// Data 2021, CC BY 4.0), with the benchmark's own metric: root mean square of the total error and
// of the inclination error in the motion phases, mean over the trials.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <vector>

#include <zlib.h>

#include "common/base/parse.h"
#include "common/base/units.h"
#include "common/inertial/reference_filters.h"
#include "common/inertial/vqf.h"
#include "common/inertial/vqf_offline.h"
#include "tests/bench/inertial/inertial_cases.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using inertial::ImuSample;

constexpr double kBroadRateHz = 2000.0 / 7.0;  // of BROAD
constexpr double kBroadPeriod = 1.0 / kBroadRateHz;
// Kept for judging by whoever filed the issue.
constexpr std::string_view kKeptTrials[] = {"07_", "21_", "28_"};

struct BroadTrial {
  std::string name;
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> truth;  ///< Not unit where the cameras lost the body.
  std::vector<char> moving;
};

Result<std::string> unpacked_broad(const fs::path& file) {
  gzFile const packed = gzopen(file.c_str(), "rb");
  if (packed == nullptr) return fail(ErrorCode::Io, file.string(), "cannot be opened");
  std::string text;
  std::string part(1u << 20, '\0');
  int count = 0;
  while ((count = gzread(packed, part.data(), static_cast<unsigned>(part.size()))) > 0)
    text.append(part, 0, static_cast<std::size_t>(count));
  gzclose(packed);
  if (count == 0) return text;
  return fail(ErrorCode::Malformed, file.string(), "is no whole gzip file");
}

/// The numbers of a csv line; what is no number is NaN.
std::vector<double> broad_numbers(std::string_view line) {
  std::vector<double> out;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find(','), line.size());
    out.push_back(parse_finite(line.substr(0, end)).value_or(std::nan("")));
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return out;
}

Result<BroadTrial> read_broad_trial(const fs::path& file) {
  const auto text = unpacked_broad(file);
  if (!text) return pass(text);
  BroadTrial trial{file.stem().stem().string(), {}, {}, {}};
  std::string_view rest = *text;
  for (bool head = true; !rest.empty(); head = false) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (head) continue;
    const auto v = broad_numbers(line);
    if (v.size() != 18) return fail(ErrorCode::Malformed, file.string(), "needs 18 columns");
    trial.samples.push_back({{v[1], v[2], v[3]}, {v[4], v[5], v[6]}, {{v[7], v[8], v[9]}}});
    trial.truth.emplace_back(v[10], v[11], v[12], v[13]);
    trial.moving.push_back(v[17] > 0 ? 1 : 0);
  }
  return trial;
}

struct FilterErrors {
  double total = 0.0;        ///< Root mean square [rad]
  double inclination = 0.0;  ///< Root mean square [rad]
  double us_per_sample = 0.0;
};

FilterErrors filter_errors(const std::vector<Eigen::Quaterniond>& found, const BroadTrial& trial) {
  FilterErrors sums;
  double count = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (trial.moving[i] == 0 || !(trial.truth[i].norm() > 0.5)) continue;
    const Eigen::Quaterniond off = found[i].normalized() * trial.truth[i].normalized().conjugate();
    const double total = 2.0 * std::acos(std::clamp(std::abs(off.w()), 0.0, 1.0));
    const double upright = std::clamp(std::hypot(off.w(), off.z()), 0.0, 1.0);
    sums.total += total * total;
    sums.inclination += std::pow(2.0 * std::acos(upright), 2);
    count += 1.0;
  }
  return {std::sqrt(sums.total / count), std::sqrt(sums.inclination / count), 0.0};
}

using FilteredTrial = std::vector<Eigen::Quaterniond>;
using RunFilter = std::function<FilteredTrial(const std::vector<ImuSample>&)>;

FilteredTrial live_filter(const std::vector<ImuSample>& samples,
                          const inertial::VqfOptions& options) {
  inertial::Vqf filter(kBroadPeriod, options);
  FilteredTrial out;
  out.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    filter.update(sample);
    out.push_back(filter.state().nine_axis);
  }
  return out;
}

template <class Filter, class Options>
FilteredTrial older_filter(const std::vector<ImuSample>& samples, const Options& options) {
  Filter filter(kBroadPeriod, inertial::started_by(samples.front()), options);
  FilteredTrial out;
  for (const ImuSample& sample : samples) {
    filter.update(sample);
    out.push_back(inertial::to_enu(filter.nwu_from_sensor()));
  }
  return out;
}

struct FilterMethod {
  std::string name;
  RunFilter run;
  double published_deg;  ///< Measured outside this project on the 27 trials; NaN: not.
};

std::vector<FilterMethod> filter_methods() {
  const inertial::VqfOptions basic{3.0, 9.0, false, false, false};
  const double none = std::nan("");
  return {
      {"vqf", [](const auto& s) { return live_filter(s, {}); }, 2.33},
      {"vqf-offline", [](const auto& s) { return inertial::vqf_offline(s, kBroadPeriod); }, 2.04},
      {"vqf-basic", [basic](const auto& s) { return live_filter(s, basic); }, 3.44},
      {"madgwick",
       [](const auto& s) {
         return older_filter<inertial::Madgwick>(s, inertial::MadgwickOptions{0.12, 0.5});
       },
       4.67},
      {"madgwick-paper",
       [](const auto& s) {
         return older_filter<inertial::Madgwick>(s, inertial::MadgwickOptions{});
       },
       none},
      {"mahony",
       [](const auto& s) { return older_filter<inertial::Mahony>(s, inertial::MahonyOptions{}); },
       8.20},
  };
}

std::vector<fs::path> broad_files() {
  const char* const stated = std::getenv("CHORUS_BROAD");
  const fs::path folder =
      stated != nullptr ? fs::path(stated) : shared_recordings() / "broad_imu_optical" / "csv_60s";
  std::vector<fs::path> out;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder, absent)) {
    const std::string name = entry.path().filename().string();
    const bool kept = std::ranges::any_of(kKeptTrials, [&](auto k) { return name.starts_with(k); });
    if (!kept && name.ends_with(".csv.gz")) out.push_back(entry.path());
  }
  std::ranges::sort(out);
  return out;
}

FilterErrors timed_filter(const FilterMethod& method, const BroadTrial& trial) {
  const auto begin = std::chrono::steady_clock::now();
  const FilteredTrial found = method.run(trial.samples);
  const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
  FilterErrors errors = filter_errors(found, trial);
  errors.us_per_sample = took.count() / static_cast<double>(trial.samples.size());
  return errors;
}

struct FilterSum {
  FilterErrors all;
  double trials = 0.0, disturbed = 0.0, disturbed_total = 0.0, worst = 0.0;

  void add(const FilterErrors& each, bool is_disturbed) {
    all.total += each.total;
    all.inclination += each.inclination;
    all.us_per_sample += each.us_per_sample;
    trials += 1.0;
    disturbed += is_disturbed ? 1.0 : 0.0;
    disturbed_total += is_disturbed ? each.total : 0.0;
    worst = std::max(worst, each.total);
  }
};

void report_filter(Report& report, const FilterMethod& method, const FilterSum& sum) {
  const std::string name = "filter-" + method.name;
  const double total = to_deg(sum.all.total / sum.trials);
  report.row(name, "filter_deg", total, "deg", std::isnan(method.published_deg) ? "" : "published",
             total / method.published_deg);
  report.row(name, "inclination_deg", to_deg(sum.all.inclination / sum.trials), "deg");
  report.row(name, "worst_trial_deg", to_deg(sum.worst), "deg");
  if (sum.disturbed > 0)
    report.row(name, "disturbed_deg", to_deg(sum.disturbed_total / sum.disturbed), "deg");
  report.row(name, "us_per_sample", sum.all.us_per_sample / sum.trials, "us");
}

}  // namespace

Result<void> run_filter(Report& report) {
  const auto files = broad_files();
  if (files.empty()) {
    report.note(
        "filter: no trials of BROAD here; set CHORUS_BROAD (tests/bench/inertial/broad_csv.py)");
    return {};
  }
  const auto all = filter_methods();
  std::vector<FilterSum> sums(all.size());
  for (const fs::path& file : files) {
    const auto trial = read_broad_trial(file);
    if (!trial) return pass(trial);
    const bool disturbed = trial->name.find("_disturbed") != std::string::npos;
    for (std::size_t m = 0; m < all.size(); ++m)
      sums[m].add(timed_filter(all[m], *trial), disturbed);
  }
  for (std::size_t m = 0; m < all.size(); ++m) report_filter(report, all[m], sums[m]);
  report.note("filter: mean over " + std::to_string(files.size()) +
              " trials of BROAD; \"published\" was measured outside this project on 27 trials.");
  return {};
}

}  // namespace chorus::bench
