#include "tests/bench/accuracy/origin_life.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"
#include "fusion-server/core/fusion_core.h"
#include "fusion-server/wire/registration_file.h"
#include "tests/judge/judge.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kRing = 6;
constexpr std::uint64_t kLifePurpose = 911;
constexpr Duration kWalk = std::chrono::seconds(30);
constexpr Duration kBetween = std::chrono::seconds(60);  // from the beginning of a walk to the next
constexpr Duration kSpare = std::chrono::seconds(5);     // so that pauses do not end a walk early
constexpr double kReach = 1.0;                           // of the marks, along x and along z [m]
constexpr double kWalkersSpread = 0.08;

SensorId sensor_number(std::size_t place) {
  return SensorId::parse(fmt::format("s{}", place + 1)).value();
}

/// Six sensors in a ring, and a seventh between the first two.
std::vector<Eigen::Isometry3d> places() {
  auto all = ring_places(synthetic::Ring{});
  synthetic::Ring finer;
  finer.count = 2 * kRing;
  all.push_back(ring_place(finer, 1));
  return all;
}

constexpr std::size_t kCorners = 4;
constexpr std::size_t kWaist = 5;

/// In the middle of the floor, four around it, and one above it.
std::vector<Eigen::Vector3d> marks() {
  return {{0, 0, 0},
          {kReach, 0, kReach},
          {-kReach, 0, kReach},
          {kReach, 0, -kReach},
          {-kReach, 0, -kReach},
          {0, 1, 0}};
}

class Cell {
 public:
  explicit Cell(const LifeSetting& setting) : setting_(setting), now_(begin_of(setting.seed)) {
    scene_.world_from_sensor = places();
    for (std::size_t i = 0; i < kRing; ++i) config_.sensors.insert(sensor_number(i));
    config_.session.first_solve = kBetween;  // provisional results do not survive the walk
    core_.emplace(config_, Registration{});
  }

  /// One person walks, whom nobody has seen before.  False: the result was not adopted.
  bool walk() {
    begin_walk();
    std::vector<SensorFrame> frames = frames_of_walk();
    bool adopted = false;
    for (SensorFrame& frame : frames) {
      const Timestamp at = frame.received;
      core_->take(std::move(frame));
      if (const auto job = core_->due_job(at)) adopted = solve(*job, at);
    }
    now_ += kBetween;
    return adopted;
  }
  /// Asks for a session before the walk; without it, only sensors without a place are registered.
  bool walk_for_all() {
    if (!core_->start_session(kWalk, now_)) return false;
    return walk();
  }

  void mark_origin() {
    const auto found = found_marks();
    const auto fit = fit_yaw(marks(), found);
    const Eigen::Isometry3d& world_from_scene = fit->target_from_source;
    (void)core_->move_origin({found[0].x(), found[0].z(), yaw_of(world_from_scene.linear())});
    marked_ = found_marks();
  }
  [[nodiscard]] Drift drift() const;

  void give_up() { core_->forget(); }
  void choose_master(std::size_t place) {
    config_.registration.master = sensor_number(place);
    core_->reconfigure(config_);
  }
  void restart() {
    config_.registration.master.reset();
    const std::string file = wire::write_registration(core_->registration());
    core_.emplace(config_, wire::read_registration(file).value());
  }
  void take_out(std::size_t place) {
    config_.sensors.erase(sensor_number(place));
    core_->reconfigure(config_);
  }
  void put_in(std::size_t place) {
    config_.sensors.insert(sensor_number(place));
    core_->reconfigure(config_);
  }
  void push(std::size_t place, const Eigen::Vector3d& by) {
    scene_.world_from_sensor[place].translation() += by;
  }
  [[nodiscard]] const Registration& registration() const { return core_->registration(); }

 private:
  void begin_walk();
  [[nodiscard]] std::vector<SensorFrame> frames_of_walk() const;
  bool solve(const core::SolveJob& job, Timestamp at);
  [[nodiscard]] std::vector<Eigen::Vector3d> found_marks() const;

  LifeSetting setting_;
  Timestamp now_;
  std::uint64_t walks_ = 0;
  synthetic::Scene scene_;
  core::CoreConfig config_;
  std::optional<core::FusionCore> core_;
  std::vector<Eigen::Vector3d> marked_;
};

void Cell::begin_walk() {
  ++walks_;
  synthetic::WalkerScript script;
  synthetic::Draw draw{kLifePurpose, setting_.seed, walks_};
  script.seed = draw.bits();
  script.body_scale += draw.uniform(-kWalkersSpread, kWalkersSpread);
  scene_.people = synthetic::make_people(script, 1);
}

/// The sensors keep their parameters; all errors are drawn anew, those of the person too.
std::vector<SensorFrame> Cell::frames_of_walk() const {
  std::vector<SensorFrame> all;
  synthetic::Draw draw{kLifePurpose + 1, setting_.seed, walks_};
  const std::uint64_t errors = draw.bits();
  for (std::size_t i = 0; i < scene_.world_from_sensor.size(); ++i) {
    if (!config_.sensors.contains(sensor_number(i))) continue;
    synthetic::SensorChoice choice{sensor_number(i), i,     setting_.profile, setting_.seed, {},
                                   errors,           errors};
    choice.own_clock = false;
    auto frames = synthetic::record(scene_, choice, now_, now_ + kWalk + kSpare).value();
    std::ranges::move(frames, std::back_inserter(all));
  }
  std::ranges::stable_sort(all, {}, &SensorFrame::received);
  return all;
}

bool Cell::solve(const core::SolveJob& job, Timestamp at) {
  core::Solution solution{job.session, job.kind, {}, std::chrono::milliseconds(300), false};
  solution.registration = registration::solve(core::assembled(job.walk), at, job.config);
  return core_->solved(std::move(solution), at) == core::Outcome::Adopted;
}

/// Where the sensors put the marks, on average.
std::vector<Eigen::Vector3d> Cell::found_marks() const {
  std::vector<Eigen::Vector3d> found(marks().size(), Eigen::Vector3d::Zero());
  const auto& sensors = core_->registration().sensors;
  for (std::size_t i = 0; i < scene_.world_from_sensor.size(); ++i) {
    const auto place = sensors.find(sensor_number(i));
    if (place == sensors.end()) continue;
    const Eigen::Isometry3d world_from_scene =
        place->second.world_from_sensor * scene_.world_from_sensor[i].inverse();
    for (std::size_t k = 0; k < found.size(); ++k)
      found[k] += world_from_scene * marks()[k] / static_cast<double>(sensors.size());
  }
  return found;
}

Drift Cell::drift() const {
  const auto found = found_marks();
  const auto across = [&](std::size_t k) {
    return std::hypot(found[k].x() - marked_[k].x(), found[k].z() - marked_[k].z());
  };
  Drift out;
  out.horizontal = across(0);
  out.vertical = std::abs(found[0].y() - marked_[0].y());
  for (std::size_t k = 1; k <= kCorners; ++k) out.corner = std::max(out.corner, across(k));
  out.waist = across(kWaist);
  out.yaw = std::abs(yaw_of(fit_yaw(marked_, found)->target_from_source.linear()));
  return out;
}

/// Distances of the same sensors' positions, and of points in front of them.
double largest_shift(const Registration& before, const Registration& after) {
  const Eigen::Vector3d ahead(0, 0, core::kReach);
  double most = 0.0;
  for (const auto& [sensor, place] : before.sensors) {
    const auto now = after.sensors.find(sensor);
    if (now == after.sensors.end()) continue;
    const Eigen::Isometry3d& was = place.world_from_sensor;
    const Eigen::Isometry3d& is = now->second.world_from_sensor;
    most = std::max(
        {most, (was.translation() - is.translation()).norm(), (was * ahead - is * ahead).norm()});
  }
  return most;
}

std::size_t other_than_master(const Registration& registration) {
  std::size_t place = 0;
  while (sensor_number(place) == registration.master) ++place;
  return place;
}

}  // namespace

Life live_on(const LifeSetting& setting) {
  Cell cell(setting);
  Life life;
  const auto step = [&](std::vector<Drift>& out, bool adopted) {
    life.refused += !adopted;
    out.push_back(cell.drift());
  };
  life.refused += !cell.walk_for_all();
  if (cell.registration().sensors.size() != kRing) return life;
  cell.mark_origin();
  for (std::size_t i = 0; i < setting.again; ++i) step(life.again, cell.walk_for_all());

  cell.choose_master(other_than_master(cell.registration()));
  cell.give_up();
  step(life.other_master, cell.walk_for_all());

  cell.restart();
  step(life.restart, true);
  step(life.restart, cell.walk_for_all());

  cell.take_out(kRing - 1);
  step(life.removed, cell.walk_for_all());

  cell.put_in(kRing);
  const Registration before = cell.registration();
  step(life.added, cell.walk());
  life.held_shift = largest_shift(before, cell.registration());
  step(life.added, cell.walk_for_all());

  synthetic::Draw draw{kLifePurpose + 2, setting.seed};
  const double direction = draw.uniform(-std::numbers::pi, std::numbers::pi);
  cell.push(2, setting.push * Eigen::Vector3d(std::sin(direction), 0.0, std::cos(direction)));
  step(life.pushed, cell.walk_for_all());
  return life;
}

}  // namespace chorus::bench
