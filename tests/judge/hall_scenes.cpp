#include "tests/judge/hall_scenes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"

namespace chorus::bench {
namespace {

using synthetic::Draw;

constexpr double kSide = 6.0;     // [m] of a cell
constexpr double kOverlap = 1.5;  // [m]
constexpr double kPitch = kSide - kOverlap;
constexpr double kGap = 2.4;  // [m]: two seconds at 1.2 m/s
constexpr std::size_t kColumns = 4;

/// The sizes of people differ by this, relative, and each length at the same size by that; the
/// spreads that associate/build.cpp assumes.
constexpr double kSizes = 0.05;
constexpr double kLengths = 0.02;

double column_middle(std::size_t column) {
  constexpr std::array kMiddles{0.0, kPitch, kPitch + kSide + kGap, 2 * kPitch + kSide + kGap};
  return kMiddles[column];
}
double row_middle(std::size_t row) { return row == 0 ? 0.0 : kPitch; }

Eigen::AlignedBox2d box(double x, double z, double half_x, double half_z) {
  return {Eigen::Vector2d(x - half_x, z - half_z), Eigen::Vector2d(x + half_x, z + half_z)};
}

/// Fills in where the cell stands, what is believed of that, and its clock.
void place(HallCell& cell, std::uint64_t seed, std::uint64_t number, const PlaceErrors& errors) {
  Draw draw({seed, 21, number});
  const Eigen::Vector2d middle = cell.sees.center();
  cell.site_from_cell = Eigen::Isometry3d::Identity();
  cell.site_from_cell.linear() = about_y(draw.uniform(-3.0, 3.0)).toRotationMatrix();
  cell.site_from_cell.translation() = Eigen::Vector3d(middle.x(), 0, middle.y());
  cell.clock_ahead = from_seconds(draw.uniform(-0.2, 0.2));
  cell.stated.cell = cell.id;
  cell.stated.version = 1;
  Eigen::Isometry3d wrong = Eigen::Isometry3d::Identity();
  wrong.linear() = about_y(deg(errors.yaw) * draw.gauss()).toRotationMatrix();
  cell.stated.site_from_cell = cell.site_from_cell;
  cell.stated.site_from_cell.linear() = wrong.linear() * cell.site_from_cell.linear();
  cell.stated.site_from_cell.translation().x() += errors.place * draw.gauss();
  cell.stated.site_from_cell.translation().z() += errors.place * draw.gauss();
  cell.stated.covariance.setZero();
  cell.stated.covariance(1, 1) = std::pow(deg(errors.yaw), 2);
  cell.stated.covariance(3, 3) = cell.stated.covariance(5, 5) = errors.place * errors.place;
  cell.stated.clock_added = -cell.clock_ahead + from_seconds(errors.clock * draw.gauss());
  cell.stated.clock_sigma = from_seconds(errors.clock);
}

struct Leg {
  double begin = 0.0;
  double end = 0.0;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

/// Cells that can be reached from one: row * kColumns + column.  `walled`: the rows are joined at
/// their ends only.
std::vector<std::size_t> neighbours(std::size_t cell, bool walled) {
  const std::size_t column = cell % kColumns;
  const std::size_t across = (cell + kColumns) % (2 * kColumns);
  std::vector<std::size_t> all;
  if (!walled) all.push_back(across);
  if (column > 0) all.push_back(cell - 1);
  if (column + 1 < kColumns) all.push_back(cell + 1);
  if (walled && (column == 0 || column + 1 == kColumns)) all.push_back(across);
  return all;
}

/// Goes on from the end of the path in a straight line; nobody takes less than half a second.
void walk_to(const Eigen::Vector2d& to, double speed, std::vector<Leg>& legs) {
  const Leg& last = legs.back();
  const double duration = std::max(0.5, (to - last.to).norm() / speed);
  legs.push_back({last.end, last.end + duration, last.to, to});
}

Eigen::Vector2d spot_in(std::size_t cell, Draw& draw) {
  constexpr double kAbout = 1.3;
  return {column_middle(cell % kColumns) + draw.uniform(-kAbout, kAbout),
          row_middle(cell / kColumns) + draw.uniform(-kAbout, kAbout)};
}

std::vector<Leg> legs_of(Draw& draw, double length) {
  constexpr double kRight = 0.35;  // [m] to the right of the line between two spots
  auto cell = static_cast<std::size_t>(draw.bits() % (2 * kColumns));
  Eigen::Vector2d at = spot_in(cell, draw);
  std::vector<Leg> legs;
  for (double time = -10.0; time < length + 10.0;) {
    const double pause = draw.uniform() < 0.5 ? draw.uniform(0.0, 1.0) : draw.uniform(2.0, 12.0);
    legs.push_back({time, time + pause, at, at});
    if (draw.uniform() < 0.7) {
      const auto ways = neighbours(cell, true);
      cell = ways[draw.bits() % ways.size()];
    }
    Eigen::Vector2d to = spot_in(cell, draw);
    const Eigen::Vector2d along = (to - at).normalized();
    if (along.allFinite()) to += kRight * Eigen::Vector2d(-along.y(), along.x());
    walk_to(to, draw.uniform(0.8, 1.5), legs);
    time = legs.back().end;
    at = to;
  }
  return legs;
}

Eigen::Vector2d on_legs(const std::vector<Leg>& legs, double time) {
  auto leg = std::ranges::upper_bound(legs, time, {}, &Leg::end);
  if (leg == legs.end()) leg = std::prev(legs.end());
  const double share =
      std::clamp((time - leg->begin) / std::max(1e-9, leg->end - leg->begin), 0.0, 1.0);
  return leg->from + share * (leg->to - leg->from);
}

/// Nobody turns or stops at once: the mean over half a second.
HallPath smooth(std::vector<Leg> legs) {
  return [kept = std::make_shared<const std::vector<Leg>>(std::move(legs))](
             double time) -> std::optional<Eigen::Vector2d> {
    constexpr int kHalf = 2;
    constexpr double kStep = 0.125;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int i = -kHalf; i <= kHalf; ++i) sum += on_legs(*kept, time + i * kStep);
    return Eigen::Vector2d(sum / (2 * kHalf + 1));
  };
}

}  // namespace

std::vector<HallCell> eight_cells(std::uint64_t seed, const PlaceErrors& errors) {
  std::vector<HallCell> cells;
  for (std::size_t i = 0; i < 2 * kColumns; ++i) {
    const std::size_t row = i / kColumns;
    const std::size_t column = i % kColumns;
    HallCell cell;
    cell.id = *SensorId::parse(std::string(1, row == 0 ? 'a' : 'b') + std::to_string(column + 1));
    const double x = column_middle(column);
    const double z = row_middle(row);
    cell.sees = box(x, z, 0.5 * kSide, 0.5 * kSide);
    // The wall between the rows.
    const bool walled = column == 1 || column == 2;
    const double beyond = row == 0 ? z + 0.5 * kSide : z - 0.5 * kSide;
    if (walled) cell.blind.push_back(box(x, beyond, kSide, 0.5 * kOverlap));
    place(cell, seed, i, errors);
    cells.push_back(std::move(cell));
  }
  return cells;
}

std::vector<HallPerson> people_in_hall(std::uint64_t seed, std::size_t count, double length) {
  std::vector<HallPerson> people;
  for (std::size_t p = 0; p < count; ++p) {
    Draw draw({seed, 22, p});
    people.push_back(of_own_build({smooth(legs_of(draw, length))}, seed, p));
  }
  return people;
}

std::vector<HallCell> grid_of_cells(std::uint64_t seed) {
  std::vector<HallCell> cells;
  for (std::size_t i = 0; i < 2 * kColumns; ++i) {
    HallCell cell;
    cell.id = *SensorId::parse("g" + std::to_string(i + 1));
    cell.sees = box(kPitch * static_cast<double>(i % kColumns), row_middle(i / kColumns),
                    0.5 * kSide, 0.5 * kSide);
    place(cell, seed, i, {});
    cells.push_back(std::move(cell));
  }
  return cells;
}

HallPerson walker_through_grid(std::uint64_t seed, double length) {
  Draw draw({seed, 24});
  std::map<std::pair<std::size_t, std::size_t>, int> used;
  std::size_t cell = 0;
  constexpr double kBegin = -10.0;
  const Eigen::Vector2d corner(0, 0);
  std::vector<Leg> legs{{kBegin, kBegin, corner, corner}};
  while (legs.back().end < length + 10.0) {
    const std::vector<std::size_t> ways = neighbours(cell, false);
    const std::size_t next = *std::ranges::min_element(ways, {}, [&](std::size_t way) {
      return used[{cell, way}] + draw.uniform(0.0, 0.9);
    });
    ++used[{cell, next}];
    const Eigen::Vector2d to(
        kPitch * static_cast<double>(next % kColumns) + draw.uniform(-1.5, 1.5),
        row_middle(next / kColumns) + draw.uniform(-1.5, 1.5));
    walk_to(to, draw.uniform(0.9, 1.3), legs);
    cell = next;
  }
  return {smooth(std::move(legs))};
}

std::vector<HallCell> two_cells(double overlap, std::uint64_t seed, const PlaceErrors& errors) {
  std::vector<HallCell> cells;
  for (const double side : {-1.0, 1.0}) {
    HallCell cell;
    cell.id = *SensorId::parse(side < 0 ? "left" : "right");
    const double inner = -side * 0.5 * overlap;
    cell.sees = {Eigen::Vector2d(std::min(side * kSide, inner), -0.5 * kSide),
                 Eigen::Vector2d(std::max(side * kSide, inner), 0.5 * kSide)};
    place(cell, seed, side < 0 ? 0 : 1, errors);
    cells.push_back(std::move(cell));
  }
  return cells;
}

HallPerson straight_walker(const Eigen::Vector2d& from, const Eigen::Vector2d& velocity,
                           double begin) {
  return {[=](double time) -> std::optional<Eigen::Vector2d> {
    if (time < begin) return std::nullopt;
    return Eigen::Vector2d(from + (time - begin) * velocity);
  }};
}

HallPerson of_own_build(HallPerson person, std::uint64_t seed, std::uint64_t number) {
  Draw draw({seed, 23, number});
  person.size = std::exp(kSizes * draw.gauss());
  for (double& length : person.build) length = kLengths * draw.gauss();
  return person;
}

}  // namespace chorus::bench
