#include "tests/bench/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench_revision.h"

namespace chorus::bench {
namespace {

constexpr std::size_t kColumns = 6;
using Cells = std::array<std::string, kColumns>;
constexpr std::array<bool, kColumns> kRightAligned{false, false, true, false, false, true};

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("-");
}

/// "icp 10.5": what stands beside, and its own value as the ratio tells it.
Cells cells_of(const Row& row) {
  const bool compared = std::isfinite(row.ratio);
  const double beside = row.value / row.ratio;
  const bool told = compared && std::isfinite(beside);
  return {row.case_name,
          row.metric,
          number(row.value),
          row.unit,
          told ? row.baseline + " " + number(beside) : row.baseline,
          compared ? number(row.ratio) : std::string()};
}

nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

void print_line(std::ostream& out, const Cells& cells,
                const std::array<std::size_t, kColumns>& widths) {
  std::string line;
  for (std::size_t i = 0; i < kColumns; ++i) {
    line += kRightAligned[i] ? fmt::format("{:>{}}  ", cells[i], widths[i])
                             : fmt::format("{:<{}}  ", cells[i], widths[i]);
  }
  line.erase(line.find_last_not_of(' ') + 1);
  out << line << '\n';
}

}  // namespace

void Report::row(std::string case_name, std::string metric, double value, std::string unit,
                 std::string baseline, double ratio) {
  rows_.push_back({std::move(case_name), std::move(metric), value, std::move(unit),
                   std::move(baseline), ratio});
}

void Report::condition(std::string sentence, bool holds) {
  note((holds ? "HOLDS: " : "BROKEN: ") + std::move(sentence));
  if (!holds) ++broken_;
}

void Report::print(std::ostream& out) const {
  std::vector<Cells> table{{"case", "metric", "value", "unit", "baseline", "ratio"}};
  for (const Row& each : rows_) table.push_back(cells_of(each));
  std::array<std::size_t, kColumns> widths{};
  for (const Cells& cells : table) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], cells[i].size());
  }
  for (const Cells& cells : table) print_line(out, cells, widths);
  out << fmt::format("\n{}  seed {}  built from {}{}{}\n", options_.name, options_.seed,
                     built_from(), profile_.empty() ? "" : "  profile " + profile_,
                     options_.quick ? "  (quick: indicative only)" : "");
  for (const std::string& sentence : notes_) out << sentence << '\n';
}

std::string Report::json() const {
  nlohmann::ordered_json document{{"name", options_.name},   {"seed", options_.seed},
                                  {"profile", profile_},     {"git", built_from()},
                                  {"quick", options_.quick}, {"rows", nlohmann::json::array()},
                                  {"notes", notes_}};
  for (const Row& each : rows_) {
    document["rows"].push_back(nlohmann::ordered_json{{"case", each.case_name},
                                                      {"metric", each.metric},
                                                      {"value", number_or_null(each.value)},
                                                      {"unit", each.unit},
                                                      {"baseline", each.baseline},
                                                      {"ratio", number_or_null(each.ratio)}});
  }
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string_view built_from() { return kBuiltFrom; }

}  // namespace chorus::bench
