#include <algorithm>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/table.h"
#include "common/posture/spread.h"
#include "tests/bench/ergonomics/ergonomics_cases.h"
#include "tests/bench/ergonomics/posture_agreement.h"

namespace chorus::bench {
namespace {

using ergonomics::Method;
using ergonomics::Seen;
using ergonomics::Table;
using posture::Centre;
using posture::Limb;
using posture::Side;
using Cells = std::map<std::string, std::vector<int>>;

constexpr auto kGolden = "tests/golden/ergonomics/second_transcription.txt";
constexpr auto kLookUps = "../shared/data/ergonomics/rula_reba_table_cases.csv";

Cells golden_cells() {
  std::ifstream file(kGolden);
  Cells cells;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::string method, table, digits;
    words >> method >> table;
    while (words >> digits) {
      for (const char digit : digits)
        cells[method + " " + table].push_back(digit >= 'a' ? 10 + digit - 'a' : digit - '0');
    }
  }
  return cells;
}

Cells own_cells() {
  const auto& tables = ergonomics::printed_tables();
  return {{"RULA A", tables.rula_a.cells()}, {"RULA B", tables.rula_b.cells()},
          {"RULA C", tables.rula_c.cells()}, {"REBA A", tables.reba_a.cells()},
          {"REBA B", tables.reba_b.cells()}, {"REBA C", tables.reba_c.cells()},
          {"OWAS AC", tables.owas.cells()}};
}

int looked_up(const std::string& method, const std::string& what, const std::vector<int>& in) {
  const auto& tables = ergonomics::printed_tables();
  const char table = what.front();
  if (method == "RULA")
    return table == 'A'   ? tables.rula_a.at(in[0], in[1], in[2], in[3])
           : table == 'B' ? tables.rula_b.at(in[0], in[1], in[2])
                          : tables.rula_c.at(in[0], in[1]);
  return table == 'A'   ? tables.reba_a.at(in[0], in[1], in[2])
         : table == 'B' ? tables.reba_b.at(in[1], in[0], in[2])
                        : tables.reba_c.at(in[0], in[1]);
}

/// The level's name as the file spells it.
std::string level_named(const std::string& method, int score) {
  const Method& which = method == "RULA" ? ergonomics::kRula : ergonomics::kReba;
  std::string key(which.levels[level_of(which, score)].key);
  std::ranges::replace(key, ' ', '_');
  return key;
}

/// How many of the public look-ups agree, of how many.
std::pair<int, int> look_ups() {
  std::ifstream file(kLookUps);
  std::string line;
  std::pair<int, int> right_of{0, 0};
  while (std::getline(file, line)) {
    std::vector<std::string> cells;
    std::istringstream parts(line);
    std::string cell;
    while (std::getline(parts, cell, ',')) cells.push_back(cell);
    if (cells.size() != 4 || (cells[0] != "RULA" && cells[0] != "REBA")) continue;
    std::vector<int> in;
    std::istringstream numbers(cells[2]);
    while (std::getline(numbers, cell, ';')) in.push_back(std::stoi(cell));
    ++right_of.second;
    const bool right = cells[1].starts_with("level")
                           ? level_named(cells[0], in[0]) == cells[3]
                           : looked_up(cells[0], cells[1], in) == std::stoi(cells[3]);
    right_of.first += right ? 1 : 0;
  }
  return right_of;
}

Skeleton<WorldSpace> mirrored_body(const Skeleton<WorldSpace>& body) {
  Skeleton<WorldSpace> out = body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    out.joints[j] = body[mirror(static_cast<JointId>(j))];
    out.joints[j].position.x() *= -1.0;
  }
  return out;
}

Skeleton<WorldSpace> turned_body(const Skeleton<WorldSpace>& body, double yaw) {
  const Eigen::Isometry3d move =
      Eigen::Translation3d(2.0 * yaw, 0.0, -1.0) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY());
  return to_world(move, Skeleton<SensorSpace>{body.joints});
}

Seen seen_of(const Skeleton<WorldSpace>& body) {
  return {posture::posture_of(body).measures, false};
}

ergonomics::ScoreRange scored(const Method& method, const Seen& seen) {
  const auto asked = empty_hands();
  const auto left = score_of(method, codes_of(method, seen, Side::Left, asked));
  return method.sided ? worse(left, score_of(method, codes_of(method, seen, Side::Right, asked)))
                      : left;
}

/// Angles that have a neutral value and do not decide how the legs bear the person.
constexpr std::array kMonotone{posture::index_of(Centre::TrunkFlexion),
                               posture::index_of(Centre::TrunkSideBend),
                               posture::index_of(Centre::TrunkTwist),
                               posture::index_of(Centre::NeckSideBend),
                               posture::index_of(Limb::UpperArmElevation, Side::Left),
                               posture::index_of(Limb::UpperArmElevation, Side::Right),
                               posture::index_of(Limb::UpperArmAbduction, Side::Left)};

struct Broken {
  int mirror = 0, moved = 0, fallen = 0;
};

void try_laws(const Skeleton<WorldSpace>& body, double yaw, Broken& broken) {
  const Seen seen = seen_of(body);
  const Seen mirror = seen_of(mirrored_body(body));
  const Seen moved = seen_of(turned_body(body, yaw));
  for (const Method* method : ergonomics::methods()) {
    const auto score = scored(*method, seen);
    broken.mirror += scored(*method, mirror) == score ? 0 : 1;
    broken.moved += scored(*method, moved) == score ? 0 : 1;
    if (!method->ordered) continue;
    for (const std::size_t m : kMonotone) {
      Seen farther = seen;
      farther.measures.values[m] *= 1.25;
      const auto higher = scored(*method, farther);
      broken.fallen += higher.low < score.low || higher.high < score.high ? 1 : 0;
    }
  }
}

/// 19.9, 20 and 20.1 degrees of bending in the methods that have a limit there.
int wrong_limits() {
  int wrong = 0;
  for (const auto& [method, input, code] :
       {std::tuple{&ergonomics::kReba, 0, 2}, std::tuple{&ergonomics::kRula, 6, 2},
        std::tuple{&ergonomics::kOwas, 0, 1}, std::tuple{&ergonomics::kIso11226, 0, 1},
        std::tuple{&ergonomics::kEn1005, 0, 1}, std::tuple{&ergonomics::kEaws, 1, 1}}) {
    for (const double degrees : {19.9, 20.0, 20.1}) {
      Seen seen;
      seen.measures.values.fill(0.0);
      seen.measures[Centre::TrunkFlexion] = deg(degrees);
      const int found =
          codes_of(*method, seen, Side::Left, empty_hands())[static_cast<std::size_t>(input)];
      wrong += found == code + (degrees > 20.05 ? 1 : 0) ? 0 : 1;
    }
  }
  return wrong;
}

}  // namespace

Skeleton<WorldSpace> drawn_body(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11U) / 9007199254740992.0);
  };
  const auto direction = [&](const Eigen::Vector3d& mean, double spread) {
    return Eigen::Vector3d(
        (mean + spread * Eigen::Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)))
            .normalized());
  };
  using enum JointId;
  Skeleton<WorldSpace> body;
  const auto put = [&](JointId id, const Eigen::Vector3d& at) {
    body[id].position = at;
    body[id].state = JointState::Tracked;
  };
  const Eigen::Vector3d up = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d hips(0, 0.95, 0);
  const Eigen::Vector3d left = direction(Eigen::Vector3d::UnitX(), 0.2);
  const Eigen::Vector3d trunk = direction(up, 0.9);
  const Eigen::Vector3d chest = direction(left, 0.5);
  put(SpineBase, hips);
  put(SpineShoulder, hips + 0.5 * trunk);
  put(Head, hips + 0.5 * trunk + 0.25 * direction(trunk, 0.7));
  for (const Side side : posture::kSides) {
    const bool is_left = side == Side::Left;
    const double sign = is_left ? 1.0 : -1.0;
    put(is_left ? HipLeft : HipRight, hips + sign * 0.1 * left);
    put(is_left ? ShoulderLeft : ShoulderRight, hips + 0.5 * trunk + sign * 0.18 * chest);
    const Eigen::Vector3d shoulder = body[is_left ? ShoulderLeft : ShoulderRight].position;
    put(is_left ? ElbowLeft : ElbowRight, shoulder + 0.3 * direction(-up, 1.5));
    put(is_left ? WristLeft : WristRight,
        body[is_left ? ElbowLeft : ElbowRight].position + 0.25 * direction(-up, 1.5));
    put(is_left ? KneeLeft : KneeRight,
        body[is_left ? HipLeft : HipRight].position + 0.42 * direction(-up, 0.7));
    put(is_left ? AnkleLeft : AnkleRight,
        body[is_left ? KneeLeft : KneeRight].position + 0.42 * direction(-up, 0.7));
  }
  return body;
}

Result<void> posture_tables(Report& report) {
  const Cells golden = golden_cells();
  const Cells own = own_cells();
  int wrong = 0;
  int cells = 0;
  for (const auto& [name, values] : own) {
    const auto other = golden.find(name);
    if (other == golden.end() || other->second.size() != values.size())
      return fail(ErrorCode::Malformed, kGolden, "has no " + name + " of that size");
    for (std::size_t i = 0; i < values.size(); ++i) wrong += values[i] == other->second[i] ? 0 : 1;
    cells += static_cast<int>(values.size());
  }
  std::mt19937_64 random(report.seed());
  int noticed = 0;
  constexpr int kMutants = 40;
  for (int n = 0; n < kMutants; ++n) {
    Cells mutant = own;
    auto table = std::next(mutant.begin(), static_cast<std::ptrdiff_t>(random() % mutant.size()));
    table->second[random() % table->second.size()] += random() % 2 == 0 ? 1 : -1;
    noticed += mutant != golden ? 1 : 0;
  }
  const auto [right, asked] = look_ups();
  report.row("tables", "cells", cells, "");
  report.row("tables", "wrong_cells", wrong, "");
  report.row("tables", "mutants_noticed", noticed, "of 40");
  report.row("tables", "look_ups_right", right, fmt::format("of {}", asked));
  report.condition("tables: every cell equals the second transcription", wrong == 0);
  report.condition("tables: all of 40 mutated cells are noticed", noticed == kMutants);
  if (asked == 0)
    report.note(
        fmt::format("tables: {} is not there, so the public look-ups were left out", kLookUps));
  report.condition("tables: all public look-ups agree", right == asked);
  return {};
}

Result<void> posture_laws(Report& report) {
  const int bodies = report.quick() ? 1'000 : 10'000;
  std::mt19937_64 random(report.seed());
  Broken broken;
  for (int n = 0; n < bodies; ++n) {
    const auto body = drawn_body(random);
    try_laws(body, 0.1 + 0.001 * static_cast<double>(n % 5000), broken);
  }
  const int limits = wrong_limits();
  report.row("laws", "bodies", bodies, "");
  report.row("laws", "mirror_broken", broken.mirror, "");
  report.row("laws", "moved_broken", broken.moved, "");
  report.row("laws", "fallen", broken.fallen, "");
  report.row("laws", "wrong_limits", limits, "");
  report.condition("laws: scores are mirror-symmetric", broken.mirror == 0);
  report.condition("laws: scores are unmoved by turning and moving the world", broken.moved == 0);
  report.condition("laws: no score falls when an angle moves away from neutral",
                   broken.fallen == 0);
  report.condition("laws: limits are as printed", limits == 0);
  return {};
}

}  // namespace chorus::bench
