// prop: a box of 0.3 m in both hands, at assembly work beside a car; one hand hidden for 0.5 s.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/workplace/held_prop.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/ergonomics/ergonomics_cases.h"
#include "tests/judge/crowd.h"
#include "tests/judge/judge.h"

namespace chorus::bench {
namespace {

constexpr double kHalfBox = 0.15;  // [m]

workplace::Prop carried_box(bool level) {
  return {.name = "box",
          .joint = JointId::HandLeft,
          .other = JointId::HandRight,
          .size = {0.3, 0.2, 0.3},
          .level = level};
}

/// Both hands at the sides of a box before the body, which is raised and lowered by 0.25 m.
synthetic::Person box_carrier(synthetic::Person walker) {
  return [walker = std::move(walker)](Duration at) {
    Skeleton<WorldSpace> body = walker(at);
    const Eigen::Vector3d hips = body[JointId::SpineBase].position;
    Eigen::Vector3d left = body[JointId::HipLeft].position - body[JointId::HipRight].position;
    left.y() = 0.0;
    left.normalize();
    const Eigen::Vector3d ahead = left.cross(Eigen::Vector3d::UnitY());
    const double lift = 0.25 * std::sin(1.3 * std::chrono::duration<double>(at).count());
    const Eigen::Vector3d middle = Eigen::Vector3d(hips.x(), 1.1 + lift, hips.z()) + 0.30 * ahead;
    for (const bool left_hand : {true, false}) {
      const Eigen::Vector3d side = (left_hand ? kHalfBox : -kHalfBox) * left;
      apply(synthetic::Reach{left_hand, 1.0, middle + side}, body);
    }
    return body;
  };
}

Workshop carrying_workshop(std::uint64_t seed) {
  Setting setting;
  setting.seed = seed;
  setting.occluders = {car_body(), pillar()};
  setting.length = std::chrono::seconds(40);
  for (synthetic::Person& person : worker_beside_car(seed))
    setting.people.push_back(box_carrier(std::move(person)));
  return draw_workshop(setting);
}

struct BoxErrors {
  std::vector<double> place;  ///< [m]
  std::vector<double> turn;   ///< [rad]
  double jump = 0.0;          ///< Largest step beyond that of the true box [m].
  double asked = 0.0;
};

/// `hide`: the left hand is not seen for 0.5 s in every 4 s, as behind the box.
void follow_box(const Workshop& workshop, const pipeline::OfflineResult& fused,
                const workplace::Prop& prop, bool hide, BoxErrors& out) {
  const SensorId master = workshop.tracks.front().sensor;
  workplace::HeldProp held(prop);
  std::optional<Eigen::Vector3d> before;
  for (std::size_t i = 0; i < fused.snapshots.size(); ++i) {
    const Snapshot& snapshot = fused.snapshots[i];
    if (snapshot.bodies.empty()) continue;
    Skeleton<WorldSpace> body = snapshot.bodies.front().skeleton;
    if (hide && i % 120 >= 60 && i % 120 < 75)
      body[JointId::HandLeft].state = JointState::NotTracked;
    const auto truth = grip_of(true_body(workshop, 0, snapshot.instant, master), prop);
    if (!truth) continue;
    ++out.asked;
    const auto found = held.follow(snapshot.instant, body);
    if (!found) continue;
    const Eigen::Vector3d off =
        found->world_from_prop.translation() - truth->world_from_prop.translation();
    out.place.push_back(off.norm());
    out.turn.push_back(angular_distance(Eigen::Quaterniond(found->world_from_prop.linear()),
                                        Eigen::Quaterniond(truth->world_from_prop.linear())));
    if (before) out.jump = std::max(out.jump, (off - *before).norm());
    before = off;
  }
}

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

Result<void> held_box(Report& report) {
  BoxErrors seen;
  BoxErrors hidden;
  BoxErrors level;
  for (std::uint64_t draw = 0; draw < (report.quick() ? 1u : 3u); ++draw) {
    const Workshop workshop = carrying_workshop(report.seed() + draw);
    const SensorId master = workshop.tracks.front().sensor;
    const auto fused =
        pipeline::fuse_offline(workshop.tracks, true_registration(workshop, master), {});
    if (!fused) return pass(fused);
    follow_box(workshop, *fused, carried_box(false), false, seen);
    follow_box(workshop, *fused, carried_box(false), true, hidden);
    follow_box(workshop, *fused, carried_box(true), false, level);
  }
  const double place = 1e3 * quantile_of(seen.place, 0.5);
  const double turn = to_deg(quantile_of(seen.turn, 0.5));
  const double jump = 1e3 * hidden.jump;
  report.condition(fmt::format("prop: the box is at most 40 mm off (median {:.1f}, p95 {:.1f})",
                               place, 1e3 * quantile_of(seen.place, 0.95)),
                   place <= 40.0);
  report.condition(fmt::format("prop: and turned by at most 3 deg (median {:.2f}, p95 {:.2f})",
                               turn, to_deg(quantile_of(seen.turn, 0.95))),
                   turn <= 3.0);
  const double yaw = to_deg(quantile_of(level.turn, 0.5));
  report.condition(fmt::format("prop: one stated to be level by at most 3 deg (median {:.2f}, p95 "
                               "{:.2f})",
                               yaw, to_deg(quantile_of(level.turn, 0.95))),
                   yaw <= 3.0);
  report.condition(
      fmt::format("prop: no jump over 50 mm when one hand is hidden for 0.5 s (largest {:.1f}; of "
                  "both hands seen {:.1f}; median error {:.1f} mm)",
                  jump, 1e3 * seen.jump, 1e3 * quantile_of(hidden.place, 0.5)),
      jump <= 50.0);
  report.condition(
      fmt::format("prop: is known at all instants ({:.1f} %)",
                  100.0 * static_cast<double>(seen.place.size()) / std::max(seen.asked, 1.0)),
      static_cast<double>(seen.place.size()) >= 0.98 * seen.asked);
  return {};
}

}  // namespace chorus::bench
