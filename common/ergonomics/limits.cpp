#include "common/ergonomics/limits.h"

#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>

#include "common/base/units.h"
#include "printed_tables.h"

namespace chorus::ergonomics {
namespace {

struct Field {
  std::string_view name;
  double Limits::*value;
};

// clang-format off
constexpr std::array kFields{
    Field{"rula.upper_arm.low", &Limits::rula_upper_arm_low}, Field{"rula.upper_arm.middle", &Limits::rula_upper_arm_middle},
    Field{"rula.upper_arm.high", &Limits::rula_upper_arm_high}, Field{"rula.lower_arm.least", &Limits::rula_lower_arm_least},
    Field{"rula.lower_arm.most", &Limits::rula_lower_arm_most}, Field{"rula.neck.low", &Limits::rula_neck_low},
    Field{"rula.neck.high", &Limits::rula_neck_high}, Field{"rula.trunk.low", &Limits::rula_trunk_low},
    Field{"rula.trunk.high", &Limits::rula_trunk_high}, Field{"rula.wrist", &Limits::rula_wrist},
    Field{"reba.trunk.low", &Limits::reba_trunk_low}, Field{"reba.trunk.high", &Limits::reba_trunk_high},
    Field{"reba.neck", &Limits::reba_neck}, Field{"reba.knee.low", &Limits::reba_knee_low},
    Field{"reba.knee.high", &Limits::reba_knee_high}, Field{"reba.wrist", &Limits::reba_wrist},
    Field{"owas.bent", &Limits::owas_bent}, Field{"owas.twisted", &Limits::owas_twisted},
    Field{"owas.knee", &Limits::owas_knee}, Field{"owas.arm_at_least", &Limits::owas_arm_at_least},
    Field{"iso.trunk.low", &Limits::iso_trunk_low}, Field{"iso.trunk.high", &Limits::iso_trunk_high},
    Field{"iso.asymmetric", &Limits::iso_asymmetric}, Field{"iso.head.low", &Limits::iso_head_low},
    Field{"iso.head.high", &Limits::iso_head_high}, Field{"iso.neck", &Limits::iso_neck},
    Field{"iso.upper_arm.low", &Limits::iso_upper_arm_low}, Field{"iso.upper_arm.high", &Limits::iso_upper_arm_high},
    Field{"en.trunk.low", &Limits::en_trunk_low}, Field{"en.trunk.high", &Limits::en_trunk_high},
    Field{"en.asymmetric", &Limits::en_asymmetric}, Field{"en.upper_arm.low", &Limits::en_upper_arm_low},
    Field{"en.upper_arm.high", &Limits::en_upper_arm_high}, Field{"en.head", &Limits::en_head},
    Field{"eaws.bent", &Limits::eaws_bent}, Field{"eaws.strongly_bent", &Limits::eaws_strongly_bent},
    Field{"eaws.elbow_at_least", &Limits::eaws_elbow_at_least}, Field{"upright", &Limits::upright},
    Field{"twisted", &Limits::twisted}, Field{"side_bent", &Limits::side_bent}, Field{"abducted", &Limits::abducted},
    Field{"shoulder_raised", &Limits::shoulder_raised}, Field{"across", &Limits::across}, Field{"out", &Limits::out},
    Field{"foot_lifted", &Limits::foot_lifted}, Field{"knee_on_floor", &Limits::knee_on_floor},
    Field{"shank_lying", &Limits::shank_lying}, Field{"thigh_level", &Limits::thigh_level},
    Field{"shank_upright", &Limits::shank_upright}, Field{"seated_knee", &Limits::seated_knee}, Field{"lying", &Limits::lying}};
// clang-format on

Limits filled(const std::vector<LimitRow>& rows) {
  Limits all{};
  for (const Field& field : kFields) {
    const auto row = std::ranges::find(rows, field.name, &LimitRow::name);
    if (row != rows.end()) all.*field.value = row->value;
  }
  return all;
}

}  // namespace

Result<std::vector<LimitRow>> read_limits(std::string_view text, std::string_view file) {
  std::vector<LimitRow> rows;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    LimitRow row;
    words >> row.name >> row.value >> row.unit >> std::ws;
    std::getline(words, row.source);
    const auto at = fmt::format("{}:{}", file, number);
    if (std::ranges::find(kFields, row.name, &Field::name) == kFields.end())
      return fail(ErrorCode::Malformed, at, fmt::format("'{}' is no limit", row.name));
    if ((row.unit != "deg" && row.unit != "m") || row.source.empty())
      return fail(ErrorCode::Malformed, at, "needs a value, deg or m, and a source");
    if (row.unit == "deg") row.value = deg(row.value);
    rows.push_back(std::move(row));
  }
  for (const Field& field : kFields) {
    if (std::ranges::count(rows, field.name, &LimitRow::name) != 1)
      return fail(ErrorCode::Malformed, std::string(file),
                  fmt::format("must state {} once", field.name));
  }
  return rows;
}

const std::vector<LimitRow>& limit_rows() {
  static const std::vector<LimitRow> kRows =
      read_limits(printed::limits, "limits.txt").value_or(std::vector<LimitRow>{});
  return kRows;
}

const Limits& limits() {
  static const Limits kLimits = filled(limit_rows());
  return kLimits;
}

}  // namespace chorus::ergonomics
