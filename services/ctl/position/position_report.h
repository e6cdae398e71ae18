// The report of `chorus position`.  Pure.
#pragma once

#include <string>
#include <vector>

#include "common/positioning/take.h"
#include "common/report/report.h"

namespace chorus::ctl {

struct PositionReport {
  std::vector<std::pair<std::string, std::string>> subject;
  const positioning::TakeResult& result;
  const std::vector<positioning::CameraTake>& cameras;
  std::string method;
  /// Where the suit's steps alone lead, from the first place on; as many as result.placed.
  std::vector<Eigen::Vector3d> walked;
  std::vector<std::string> notes = {};  ///< What was looked at, and what could not be.
  double stature = 0.0;                 ///< As stated or as the suit's bones are [m].
};

[[nodiscard]] report::Report position_report(const PositionReport& take);

/// What is probably wrong with a take although it was placed.
[[nodiscard]] std::vector<std::string> doubts_of(const positioning::TakeResult& result);

/// The same in three or four lines, for the terminal.
[[nodiscard]] std::string position_text(const PositionReport& take);

}  // namespace chorus::ctl
