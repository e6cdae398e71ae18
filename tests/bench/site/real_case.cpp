// The cases with real processes: real_cases.py starts and measures them.
#include <nlohmann/json.hpp>

#include "common/base/asked_program.h"
#include "common/base/json.h"
#include "tests/bench/site/site_cases.h"

namespace chorus::bench {
namespace {

constexpr const char* kRealCases = "tests/bench/site/real_cases.py";

Result<nlohmann::json> measured_case(const Report& report, const char* name) {
  const AskLimits patience{.patience = std::chrono::minutes(20)};
  const std::string programs = sibling_program("chorus").parent_path().string();
  const auto asked = ask_program(
      {"python3", "-B", kRealCases, name, programs, report.quick() ? "quick" : "full"}, patience);
  if (!asked) return pass(asked);
  const std::size_t begin = asked->said.rfind("{\"rows\"");
  if (asked->code != 0 || begin == std::string::npos)
    return fail(ErrorCode::Unavailable, kRealCases, "did not measure: " + asked->said);
  return parse_json(asked->said.substr(begin));
}

}  // namespace

Result<void> run_real_case(Report& report, const char* name) {
  const auto found = measured_case(report, name);
  if (!found) return pass(found);
  for (const nlohmann::json& row : found->at("rows"))
    report.row(name, row.at(0).get<std::string>(),
               row.at(1).is_number() ? row.at(1).get<double>() : kNoRatio,
               row.at(2).get<std::string>());
  for (const nlohmann::json& note : found->at("notes")) report.note(note.get<std::string>());
  return {};
}

}  // namespace chorus::bench
