#include "services/ctl/operate/registration_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "common/base/units.h"
#include "common/client/service_client.h"
#include "common/geometry/rotation.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

constexpr double kSigmas95 = 1.96;

std::string yaw_shown(const nlohmann::json& sensor) {
  const Eigen::Quaterniond q(client::number_at(sensor, "qw"), client::number_at(sensor, "qx"),
                             client::number_at(sensor, "qy"), client::number_at(sensor, "qz"));
  if (!q.coeffs().allFinite()) return "-";
  return shown(to_deg(yaw_of(normalised_or_identity(q).toRotationMatrix())), 1);
}

std::string chain_shown(const nlohmann::json& sensor, const char* key) {
  std::string text;
  for (const auto& link : client::part_at(sensor, key)) {
    if (link.is_string()) text += (text.empty() ? "" : " > ") + link.get<std::string>();
  }
  return text.empty() ? "-" : text;
}

/// "s1 > s3 (24.0 mm)": the chain that would have been next, and its error.
std::string next_shown(const nlohmann::json& sensor) {
  if (client::part_at(sensor, "nextChain").empty()) return "-";
  return fmt::format("{} ({} mm)", chain_shown(sensor, "nextChain"),
                     shown(to_mm(client::number_at(sensor, "nextError")), 1));
}

/// A line about the pair whose loops close worst; empty if there are no loops.
std::string worst_loop_shown(const nlohmann::json& registration) {
  double worst = -1.0;
  std::string text;
  for (const auto& edge : client::part_at(registration, "edges")) {
    const double error = client::number_at(edge, "loopError");
    if (!(error > worst)) continue;
    worst = error;
    const double turn = client::number_at(edge, "loopDegrees");
    text = fmt::format("  loops close to within {:.0f} mm{} (worst: {} and {})\n", to_mm(error),
                       std::isfinite(turn) ? fmt::format(", {:.2f} deg", turn) : std::string(),
                       printable(client::text_at(edge, "target")),
                       printable(client::text_at(edge, "source")));
  }
  return text;
}

/// A line such as "the clocks of s2 and s5 differ by 212 ms +- 4" for each clock whose offset from
/// the common clock, as found from the walk, is larger than its uncertainty.
std::string clocks_shown(const nlohmann::json& registration) {
  std::vector<std::pair<std::string, double>> clocks;
  std::map<std::string, double> sigmas;
  for (const auto& [name, sensor] : client::part_at(registration, "sensors").items()) {
    const double offset = client::number_at(sensor, "clockOffsetMilliseconds");
    if (!std::isfinite(offset)) continue;
    clocks.emplace_back(name, offset);
    sigmas[name] = client::number_at(sensor, "clockUncertaintyMilliseconds");
  }
  // The sensor that the others are compared with is the one whose uncertainty is zero.
  const auto common =
      std::ranges::find_if(clocks, [&](const auto& each) { return sigmas[each.first] == 0.0; });
  if (common == clocks.end()) return {};
  std::string text;
  for (const auto& [name, added] : clocks) {
    const double offset = added - common->second;
    const double open = kSigmas95 * sigmas[name];
    if (name == common->first || std::abs(offset) <= open) continue;
    text +=
        fmt::format("  the clocks of {} and {} differ by {:.0f} ms +- {:.0f}\n",
                    printable(common->first), printable(name), std::abs(offset), std::ceil(open));
  }
  return text;
}

/// A line such as "s3: latency 42 ms +- 4 relative to the others, taken off" for each sensor whose
/// latency is corrected, and one about those of which the walk told next to nothing.
std::string latencies_shown(const nlohmann::json& registration) {
  constexpr double kOpen = 20.0;  // [ms] 1 sigma
  std::string text;
  std::vector<std::string> open;
  for (const auto& [name, sensor] : client::part_at(registration, "sensors").items()) {
    const double latency = client::number_at(sensor, "latencyMilliseconds");
    const double sigma = client::number_at(sensor, "latencyUncertaintyMilliseconds");
    const auto corrected = sensor.find("latencyCorrected");
    if (corrected != sensor.end() && *corrected == true)
      text += fmt::format("  {}: latency {:.0f} ms +- {:.0f} relative to the others, taken off\n",
                          printable(name), latency, std::ceil(kSigmas95 * sigma));
    if (sigma > kOpen) open.push_back(printable(name));
  }
  if (open.empty()) return text;
  return text + fmt::format("  the walk does not tell the latency of {}: left at zero\n",
                            fmt::join(open, ", "));
}

}  // namespace

std::string registration_report(const nlohmann::json& registration) {
  std::string text =
      fmt::format("registration: {}", printable(client::text_at(registration, "verdict", "None")));
  const std::string master = client::text_at(registration, "master", "");
  if (!master.empty()) text += fmt::format(", master {}", printable(master));
  text += "\n";
  for (const std::string& alarm : lines_at(registration, "alarms"))
    text += "  ALARM: " + alarm + "\n";
  for (const std::string& reason : lines_at(registration, "reasons")) text += "  " + reason + "\n";
  for (const std::string& next : lines_at(registration, "awaits")) text += "  next: " + next + "\n";
  text +=
      clocks_shown(registration) + latencies_shown(registration) + worst_loop_shown(registration);
  const std::string problem = client::text_at(registration, "storeProblem", "");
  const auto stored = registration.find("stored");
  const bool kept = stored != registration.end() && *stored == true;
  if (!problem.empty()) text += (kept ? "  " : "  not stored: ") + printable(problem) + "\n";
  std::vector<std::vector<std::string>> rows{{"sensor", "verdict", "x [m]", "y [m]", "z [m]",
                                              "yaw [deg]", "95 % [mm]", "error [mm]", "chain",
                                              "next best"}};
  for (const auto& [name, sensor] : client::part_at(registration, "sensors").items()) {
    const auto polled = sensor.find("polled");
    const bool idle = polled != sensor.end() && *polled == false;
    rows.push_back({name, client::text_at(sensor, "verdict") + (idle ? ", not polled" : ""),
                    shown(client::number_at(sensor, "x"), 3),
                    shown(client::number_at(sensor, "y"), 3),
                    shown(client::number_at(sensor, "z"), 3), yaw_shown(sensor),
                    shown(to_mm(client::number_at(sensor, "presentRadius")), 0),
                    shown(to_mm(client::number_at(sensor, "error")), 1),
                    chain_shown(sensor, "chain"), next_shown(sensor)});
  }
  for (const auto& [name, sensor] : client::part_at(registration, "unplaced").items())
    rows.push_back(
        {name, client::text_at(sensor, "verdict"), "-", "-", "-", "-", "-", "-", "-", "-"});
  if (rows.size() > 1) text += table(std::move(rows));
  return text;
}

}  // namespace chorus::ctl
