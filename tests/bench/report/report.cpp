#include "tests/bench/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench_revision.h"

namespace chorus::bench {
namespace {

/// One column of the printed table; an optional one is left out if it is empty in all rows.
struct Column {
  const char* title;
  bool right_aligned;
  bool optional;
};
constexpr std::array kColumns{
    Column{"case", false, false},     Column{"metric", false, false}, Column{"value", true, false},
    Column{"unit", false, false},     Column{"5-95 %", false, true},  Column{"failed", false, true},
    Column{"baseline", false, false}, Column{"5-95 %", false, true},  Column{"failed", false, true},
    Column{"ratio", true, false},     Column{"won", true, true}};
using Cells = std::array<std::string, kColumns.size()>;

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : std::string("-");
}

std::string range_of(const std::optional<Spread>& spread) {
  return spread ? number(spread->low) + " .. " + number(spread->high) : std::string();
}

std::string failed_of(const std::optional<Spread>& spread) {
  return spread ? fmt::format("{}/{}", spread->failed, spread->draws) : std::string();
}

/// "icp 10.5": the name of the baseline, and its value where it is known.
std::string baseline_of(const Row& row) {
  if (row.beside) return row.baseline + " " + number(row.beside->median);
  const double told = row.value / row.ratio;
  return std::isfinite(row.ratio) && std::isfinite(told) ? row.baseline + " " + number(told)
                                                         : row.baseline;
}

Cells cells_of(const Row& row) {
  const auto unless_none = [](double value, const char* unit) {
    return std::isfinite(value) ? number(value) + unit : std::string();
  };
  return {row.case_name,
          row.metric,
          number(row.value),
          row.unit,
          range_of(row.spread),
          failed_of(row.spread),
          baseline_of(row),
          range_of(row.beside),
          failed_of(row.beside),
          unless_none(row.ratio, ""),
          unless_none(row.won_percent, " %")};
}

nlohmann::json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

nlohmann::ordered_json json_of(const Spread& spread) {
  return {{"median", number_or_null(spread.median)},
          {"p5", number_or_null(spread.low)},
          {"p95", number_or_null(spread.high)},
          {"failed", spread.failed},
          {"draws", spread.draws}};
}

nlohmann::ordered_json json_of(const Row& row) {
  nlohmann::ordered_json object{
      {"case", row.case_name}, {"metric", row.metric},     {"value", number_or_null(row.value)},
      {"unit", row.unit},      {"baseline", row.baseline}, {"ratio", number_or_null(row.ratio)}};
  if (row.spread) object["spread"] = json_of(*row.spread);
  if (row.beside) object["beside"] = json_of(*row.beside);
  if (row.beside) object["won_percent"] = number_or_null(row.won_percent);
  return object;
}

/// Width of each column; zero: left out.
std::array<std::size_t, kColumns.size()> widths_of(const std::vector<Cells>& table) {
  std::array<std::size_t, kColumns.size()> widths{};
  for (const Cells& cells : table) {
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      widths[i] = std::max(widths[i], cells[i].size());
    }
  }
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const std::size_t title = std::string_view(kColumns[i].title).size();
    if (widths[i] > 0 || !kColumns[i].optional) widths[i] = std::max(widths[i], title);
  }
  return widths;
}

void print_line(std::ostream& out, const Cells& cells,
                const std::array<std::size_t, kColumns.size()>& widths) {
  std::string line;
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    if (widths[i] == 0) continue;
    line += kColumns[i].right_aligned ? fmt::format("{:>{}}  ", cells[i], widths[i])
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
  std::vector<Cells> table;
  for (const Row& each : rows_) table.push_back(cells_of(each));
  const auto widths = widths_of(table);
  Cells titles;
  std::transform(kColumns.begin(), kColumns.end(), titles.begin(),
                 [](const Column& column) { return column.title; });
  print_line(out, titles, widths);
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
  for (const Row& each : rows_) document["rows"].push_back(json_of(each));
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string_view built_from() { return kBuiltFrom; }

}  // namespace chorus::bench
