// The two profiles: keys of the configurations of chorus-fusion and chorus-sensor.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "services/ctl/calibrate/characterise_report.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

using characteristics::FrontRear;
using characteristics::Kind;

std::string head_of(const SensorReport& report) {
  std::string sensors;
  for (const auto& sensor : report.measured.sensors)
    sensors += fmt::format(" {} ({:.0f} s)", sensor.sensor.str(), sensor.seconds);
  return fmt::format("// Measured by chorus characterise from {}:{}\n", printable(report.source),
                     sensors);
}

std::string noise_part(const Kind& kind) {
  if (!kind.noise) {
    return fmt::format(
        "  // fusion.noise keeps its default: it holds errors that last, which one sensor alone "
        "does not show.\n  // Jitter alone is {:.2f} mm along and {:.2f} mm across the line of "
        "sight. A walk recorded with several sensors says more.\n",
        to_mm(kind.jitter.along), to_mm(kind.jitter.across));
  }
  return fmt::format(
      "  // For all sensors; of one kind among others: \"noise\" of each of these \"sensors\".\n"
      "  \"fusion\": {{ \"noise\": {{ \"along_m\": {:.4f}, \"across_m\": {:.4f} }} }}",
      kind.noise->along, kind.noise->across);
}

std::string bias_part(const Kind& kind) {
  if (!kind.depth_bias) {
    return "  // registration.depth_bias_m keeps its default: nothing was measured that differs "
           "from 0 by two sigma.\n";
  }
  return fmt::format(
      "  \"registration\": {{ \"depth_bias_m\": {:.4f}, \"depth_bias_sigma_m\": {:.4f} }}",
      std::clamp(kind.depth_bias->bias, 0.0, 0.2), std::clamp(kind.depth_bias->sigma, 0.0, 0.2));
}

std::string front_rear_part(FrontRear front_rear) {
  const char* const says = front_rear == FrontRear::Tells ? "It tells front from rear"
                           : front_rear == FrontRear::TakesForFacing
                               ? "It takes everybody for facing it"
                               : "Whether it tells front from rear was not seen";
  return fmt::format(
      "  // {}: not a key, because the server learns that of each sensor within seconds\n  // "
      "(facing.telling, facing.habit) and would believe a wrong statement.\n",
      says);
}

}  // namespace

std::string fusion_profile(const SensorReport& report) {
  const Kind& kind = report.kind;
  const bool both = kind.noise && kind.depth_bias;
  return head_of(report) +
         "// For chorus-fusion and chorus fuse: copy the keys into the server's "
         "configuration, or --config this file.\n{\n" +
         noise_part(kind) +
         (both         ? ",\n"
          : kind.noise ? "\n"
                       : "") +
         bias_part(kind) + (kind.depth_bias ? "\n" : "") + front_rear_part(kind.front_rear) + "}\n";
}

std::string simulation_profile(const SensorReport& report) {
  if (report.measured.sensors.empty())
    return head_of(report) +
           "{\n  // No single sensor could be measured, so every key keeps its default.\n}\n";
  const Kind& kind = report.kind;
  const auto& delivery = kind.delivery;
  // Uniform within +- jitter.
  const double jitter_ms = std::min(10.0, 1e3 * std::sqrt(3.0) * delivery.step_sigma);
  return head_of(report) +
         fmt::format(
             "// For chorus-sensor --config: white noise as large as that of the spine. Exchanged "
             "sides, bias and errors that\n// last are not in it; the profiles A to D have them, "
             "each with its own.\n{{\n  \"device\": {{ \"kind\": \"simulated\", \"simulated\": {{ "
             "\"profile\": \"gauss\", \"noise\": {{\n    \"along_mm\": {:.2f}, \"across_mm\": "
             "{:.2f}, \"jitter_ms\": {:.2f}, \"drop_percent\": {:.2f}\n  }} }} }}\n}}\n",
             to_mm(kind.jitter.along), to_mm(kind.jitter.across), jitter_ms,
             100.0 * delivery.lost_share);
}

}  // namespace chorus::ctl
