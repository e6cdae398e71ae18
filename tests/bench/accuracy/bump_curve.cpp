#include "tests/bench/accuracy/bump_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "fusion-server/watch/watch.h"
#include "tests/bench/accuracy/watched_room.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr std::uint64_t kCurvePurpose = 733;
constexpr std::size_t kCurveRooms = 20;
constexpr Duration kCurveLength = std::chrono::minutes(24);  // of each: 8 h in all
constexpr const char* kCurveProfiles[] = {"A", "B", "D"};
constexpr double kStep = 0.1;                                // [s] from instant to instant
constexpr double kSoonEnough = 5.0;                          // [s] of somebody moving in view
constexpr Duration kKnownAfter = std::chrono::seconds(180);  // sensors are known by then
constexpr Duration kGivenUpAfter = std::chrono::seconds(40);
constexpr double kMoving = 0.25;  // [m/s]

struct Pushed {
  const char* name;
  double shift;
  double yaw;
};
constexpr std::array<Pushed, 5> kPushes{{{"50mm", 0.05, 0.0},
                                         {"75mm", 0.075, 0.0},
                                         {"100mm", 0.1, 0.0},
                                         {"2deg", 0.0, deg(2)},
                                         {"4deg", 0.0, deg(4)}}};
constexpr std::array<double, 4> kLimits{0.035, 0.04, 0.05, 0.06};  // least_shift [m]

watch::WatchConfig limited(double least_shift) {
  watch::WatchConfig config;
  config.enabled = true;
  config.least_shift = least_shift;
  return config;
}

/// The results of all pushes of one kind under one limit.
struct Outcomes {
  /// For how long somebody had moved in view of the sensor when the push was reported [s]; NaN:
  /// not reported in time.
  std::vector<double> told;
  std::size_t wrong = 0;  ///< Another sensor was named first.
};

struct CurveLog {
  std::array<std::array<Outcomes, kPushes.size()>, kLimits.size()> pushes;
  std::array<std::size_t, kLimits.size()> false_alarms{};
  double watched = 0.0;  ///< [s]
};

/// A copy of the watch that sees one sensor pushed.
struct PushTrial {
  watch::Watch watch;
  std::size_t limit = 0;
  std::size_t push = 0;
  std::optional<double> told = {};
  bool wrong = false;
};

/// The views of `sensor` as if it had been moved by `shift` and turned by `yaw` about the vertical
/// through it, while its registered place stays.
std::vector<Person> with_pushed(std::vector<Person> people, const SensorId& sensor,
                                const Eigen::Vector3d& shift, double yaw) {
  const Eigen::Matrix3d turn = about_y(-yaw).toRotationMatrix();
  for (Person& person : people) {
    for (SensorView& view : person.views) {
      if (view.sensor != sensor) continue;
      for (Joint& joint : view.skeleton.joints)
        joint.position = view.eye + turn * (joint.position - shift - view.eye);
    }
  }
  return people;
}

class Curve {
 public:
  explicit Curve(std::uint64_t seed) : draw_{kCurvePurpose, seed} {}

  void take(const std::vector<Person>& people, Timestamp instant);
  [[nodiscard]] CurveLog log() && { return std::move(log_); }

 private:
  [[nodiscard]] std::set<SensorId> seeing_somebody_move(const std::vector<Person>& people,
                                                        Timestamp instant);
  void begin_trials(const std::set<SensorId>& seeing, Timestamp instant);
  void end_trials(Timestamp instant);
  void look_undisturbed(const std::vector<Person>& people, Timestamp instant);
  void look_pushed(const std::vector<Person>& people, Timestamp instant);

  struct Mover {
    Eigen::Vector3d smoothed;
    Timestamp seen;
  };

  synthetic::Draw draw_;
  std::array<watch::Watch, kLimits.size()> undisturbed_;
  std::map<PersonId, Mover> movers_;
  std::vector<PushTrial> trials_;
  SensorId sensor_ = SensorId::parse("s1").value();
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();
  double sign_ = 1.0;
  double moved_for_ = 0.0;  ///< How long somebody moved in view of `sensor_` since the push [s].
  std::optional<Timestamp> begun_;
  Timestamp pushed_at_;
  CurveLog log_;
};

/// Sensors that see somebody move whom another sensor sees, too, both without anybody in the way.
std::set<SensorId> Curve::seeing_somebody_move(const std::vector<Person>& people,
                                               Timestamp instant) {
  constexpr double kSmoothing = 0.5;  // [s]
  constexpr Duration kGap = std::chrono::milliseconds(400);
  std::set<SensorId> seeing;
  for (const Person& person : people) {
    const auto middle = person.carried ? std::nullopt : watch::middle_of(person);
    if (!middle) continue;
    Mover& mover = movers_.try_emplace(person.id, Mover{*middle, instant}).first->second;
    if (instant - mover.seen > kGap) mover.smoothed = *middle;
    Eigen::Vector3d ahead = *middle - mover.smoothed;
    mover.smoothed += (1.0 - std::exp(-kStep / kSmoothing)) * ahead;
    mover.seen = instant;
    ahead.y() = 0.0;
    if (ahead.norm() <= kMoving * kSmoothing) continue;
    std::vector<Eigen::Vector3d> others;
    for (const Person& other : people) {
      const auto place = other.carried ? other.carried : watch::middle_of(other);
      if (other.id != person.id && place) others.push_back(*place);
    }
    for (const auto& residual : watch::residuals_of(watch::seen_clearly(person, others)))
      seeing.insert(residual.sensor);
  }
  return seeing;
}

void Curve::begin_trials(const std::set<SensorId>& seeing, Timestamp instant) {
  const auto pick = draw_.bits() % seeing.size();
  sensor_ = *std::next(seeing.begin(), static_cast<std::ptrdiff_t>(pick));
  const double angle = draw_.uniform(-std::numbers::pi, std::numbers::pi);
  direction_ = {std::sin(angle), 0.0, std::cos(angle)};
  sign_ = draw_.bits() % 2 == 0 ? 1.0 : -1.0;
  moved_for_ = 0.0;
  pushed_at_ = instant;
  for (std::size_t limit = 0; limit < kLimits.size(); ++limit) {
    for (std::size_t push = 0; push < kPushes.size(); ++push)
      trials_.push_back({undisturbed_[limit], limit, push});
  }
}

/// Ends the present trials.  They count only if somebody has moved long enough in view of the
/// pushed sensor.
void Curve::end_trials(Timestamp instant) {
  constexpr Duration kPause = std::chrono::seconds(3);
  if (moved_for_ >= kSoonEnough) {
    for (const PushTrial& trial : trials_) {
      Outcomes& outcomes = log_.pushes[trial.limit][trial.push];
      outcomes.told.push_back(trial.told.value_or(kNoRatio));
      outcomes.wrong += trial.wrong ? 1 : 0;
    }
  }
  trials_.clear();
  pushed_at_ = instant + kPause;
}

void Curve::look_undisturbed(const std::vector<Person>& people, Timestamp instant) {
  for (std::size_t limit = 0; limit < kLimits.size(); ++limit) {
    undisturbed_[limit].look(people, instant, limited(kLimits[limit]));
    if (!undisturbed_[limit].finding()) continue;
    ++log_.false_alarms[limit];
    undisturbed_[limit].forget();  // as when the sensor has lost its place
  }
}

void Curve::look_pushed(const std::vector<Person>& people, Timestamp instant) {
  for (std::size_t push = 0; push < kPushes.size(); ++push) {
    const auto seen =
        with_pushed(people, sensor_, kPushes[push].shift * direction_, kPushes[push].yaw * sign_);
    for (PushTrial& trial : trials_) {
      if (trial.push != push || trial.told) continue;
      trial.watch.look(seen, instant, limited(kLimits[trial.limit]));
      const auto finding = trial.watch.finding();
      if (!finding) continue;
      const bool named = finding->sensor == sensor_;
      if (!named && !finding->or_else) trial.wrong = true;
      if (named) trial.told = moved_for_ <= kSoonEnough ? moved_for_ : kNoRatio;
    }
  }
}

void Curve::take(const std::vector<Person>& people, Timestamp instant) {
  if (!begun_) pushed_at_ = (begun_ = instant).value() + kKnownAfter;
  log_.watched = seconds(instant - *begun_);
  const auto seeing = seeing_somebody_move(people, instant);
  const bool over = moved_for_ >= kSoonEnough || instant - pushed_at_ > kGivenUpAfter;
  if (!trials_.empty() && over) end_trials(instant);
  if (trials_.empty() && instant >= pushed_at_ && !seeing.empty()) begin_trials(seeing, instant);
  look_undisturbed(people, instant);
  if (trials_.empty()) return;
  if (seeing.contains(sensor_)) moved_for_ += kStep;
  look_pushed(people, instant);
}

CurveLog pushed_and_not(std::uint64_t seed, Duration length) {
  WatchedSetting setting;
  setting.seed = seed;
  setting.profile = kCurveProfiles[seed % std::size(kCurveProfiles)];
  setting.persons = 2;
  setting.length = length;
  Curve curve(seed);
  watch_room(setting, [&](const std::vector<Person>& people, Timestamp instant) {
    curve.take(people, instant);
  });
  return std::move(curve).log();
}

void report_limit(Report& report, std::size_t limit, const std::vector<CurveLog>& logs) {
  constexpr double kEightHours = 8.0 * 3600.0;  // [s]
  const std::string name = fmt::format("bump-curve-{:.0f}mm", to_mm(kLimits[limit]));
  double watched = 0.0, alarms = 0.0;
  for (const CurveLog& log : logs) {
    watched += log.watched;
    alarms += static_cast<double>(log.false_alarms[limit]);
  }
  report.row(name, "false_alarms_per_8h", alarms * kEightHours / watched, "");
  report.row(name, "simulated_hours", watched / 3600.0, "h");
  for (std::size_t push = 0; push < kPushes.size(); ++push) {
    std::vector<double> told;
    std::size_t all = 0, wrong = 0;
    for (const CurveLog& log : logs) {
      const Outcomes& outcomes = log.pushes[limit][push];
      all += outcomes.told.size();
      wrong += outcomes.wrong;
      std::ranges::copy_if(outcomes.told, std::back_inserter(told),
                           [](double each) { return std::isfinite(each); });
    }
    const std::string pushed = kPushes[push].name;
    const double share = 100.0 * static_cast<double>(told.size()) / static_cast<double>(all);
    report.row(name, "told_" + pushed, share, "%");
    report.row(name, "pushes_" + pushed, static_cast<double>(all), "");
    report.row(name, "wrong_" + pushed, static_cast<double>(wrong), "");
    if (!told.empty()) report.row(name, "median_" + pushed + "_s", median(told), "s");
  }
}

}  // namespace

void measure_bump_curve(Report& report) {
  const Duration length = report.quick() ? std::chrono::minutes(5) : kCurveLength;
  const auto logs = over_draws(report.quick() ? 1 : kCurveRooms, [&](std::size_t i) {
    return pushed_and_not(report.seed() + i, length);
  });
  for (std::size_t limit = 0; limit < kLimits.size(); ++limit) report_limit(report, limit, logs);
  report.note(
      "bump-curve: rings of six, two people, stamps are true time; told: the pushed sensor is "
      "named within 5 s in which somebody moved in view of it and of another one.  wrong: another "
      "one was named first.");
}

}  // namespace chorus::bench
