// The page in headless Chromium: pictures a second with six people and ten sensors, beside an empty
// three.js scene of the same size in the same run.
#include <filesystem>

#include <nlohmann/json.hpp>

#include "common/base/asked_program.h"
#include "common/base/json.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {
namespace {

constexpr const char* kScript = "tests/bench/live/cockpit.mjs";
constexpr double kLeastRatio = 0.8;
constexpr double kOldest = 120.0;  // [ms]

Result<nlohmann::json> measured(bool quick) {
  const AskLimits patience{.patience = std::chrono::minutes(10)};
  const auto asked =
      ask_program({"node", kScript, quick ? "4" : "10", quick ? "1" : "3"}, patience);
  if (!asked) return pass(asked);
  const std::size_t begin = asked->said.rfind("{\"page_hz\"");
  if (asked->code != 0 || begin == std::string::npos)
    return fail(ErrorCode::Unavailable, kScript,
                "did not measure (it needs node, chromium, and npm ci in tests/ and "
                "services/viewer/): " +
                    asked->said);
  return parse_json(asked->said.substr(begin));
}

}  // namespace

Result<void> run_cockpit(Report& report) {
  const auto found = measured(report.quick());
  if (!found) return pass(found);
  const auto number = [&](const char* key) { return found->value(key, kNoRatio); };
  report.row("six-people-ten-sensors", "pictures", number("page_hz"), "Hz", "empty three.js scene",
             number("ratio"));
  report.row("empty-scene", "pictures", number("empty_hz"), "Hz");
  report.row("phone", "pictures", number("phone_hz"), "Hz");
  report.row("six-people-ten-sensors", "fused_age_p95", number("age_p95_ms"), "ms");
  report.row("six-people-ten-sensors", "first_paint", number("first_paint_ms"), "ms");
  report.row("six-people-ten-sensors", "frame", number("frame_bytes"), "B");
  report.condition("at least 0.8 of the pictures of an empty scene",
                   number("ratio") >= kLeastRatio);
  report.condition("the fused frame on the page is at most 120 ms old (p95)",
                   number("age_p95_ms") <= kOldest);
  report.note(
      "software rendering; the artificial server, the browser and whatever else runs share "
      "this machine's cores");
  return {};
}

}  // namespace chorus::bench
