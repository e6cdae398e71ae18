#include "services/ctl/align/alignment_report.h"

#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

using nlohmann::json;

/// Of sorted values; `share` in [0, 1].
double at_share(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return std::nan("");
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// Median and 95 % of one kind of residual [m].
struct Measure {
  const char* name;
  double median = 0.0;
  double most = 0.0;
};

std::vector<Measure> measures_of(const std::vector<Eigen::Vector3d>& residuals) {
  struct Kind {
    const char* name;
    double (*of)(const Eigen::Vector3d&);
  };
  constexpr Kind kKinds[] = {
      {"all", [](const Eigen::Vector3d& r) { return r.norm(); }},
      {"horizontal", [](const Eigen::Vector3d& r) { return std::hypot(r.x(), r.z()); }},
      {"vertical", [](const Eigen::Vector3d& r) { return std::abs(r.y()); }}};
  std::vector<Measure> all;
  for (const Kind& kind : kKinds) {
    std::vector<double> values;
    for (const Eigen::Vector3d& each : residuals) values.push_back(kind.of(each));
    std::ranges::sort(values);
    all.push_back({kind.name, at_share(values, 0.5), at_share(values, 0.95)});
  }
  return all;
}

/// Angle between our vertical and the reference's.
double tilt_of(const Eigen::Isometry3d& ours_from_reference) {
  return std::acos(std::clamp(ours_from_reference.linear()(1, 1), -1.0, 1.0));
}

std::string marker_text(const Eigen::Vector3d& marker, const AlignmentFindings& found) {
  return fmt::format(
      "{} is at {:.0f}, {:.0f}, {:.0f} mm from the marker (x, y, z by the axes that "
      "turn with it)\n",
      found.joint, to_mm(marker.x()), to_mm(marker.y()), to_mm(marker.z()));
}

std::string walk_text(const AlignmentFindings& found) {
  const alignment::Alignment& walk = *found.walk;
  std::string text = fmt::format("{} beside {}: {} samples in {:.1f} s\n", found.joint,
                                 found.body.empty() ? "the reference" : printable(found.body),
                                 walk.times.size(), walk.times.back() - walk.times.front());
  const std::string offset = std::abs(walk.clock_offset) < 10.0
                                 ? fmt::format("{:.1f} ms", 1e3 * walk.clock_offset)
                                 : fmt::format("{:.4f} s", walk.clock_offset);
  text += fmt::format("clock: {} +- {:.1f} ms are added to the reference's stamps{}\n", offset,
                      1.96e3 * walk.clock_sigma, found.utc ? "" : " (they are not UTC)");
  if (walk.marker_offset) text += marker_text(*walk.marker_offset, found);
  std::vector<std::vector<std::string>> rows{{"residual", "median [mm]", "95 % [mm]"}};
  for (const Measure& each : measures_of(walk.residuals))
    rows.push_back({each.name, shown(to_mm(each.median), 1), shown(to_mm(each.most), 1)});
  text += table(std::move(rows));
  return text + fmt::format(
                    "the front is known to {:.2f} deg, the middle of the walk to {:.0f} mm "
                    "(95 %, without errors that last the whole walk)\n",
                    1.96 * to_deg(walk.yaw_sigma), 1.96 * to_mm(walk.place_sigma));
}

std::string degrees_shown(const std::optional<double>& angle) {
  return angle ? shown(to_deg(*angle), 2) : "-";
}

std::string sensors_text(const char* how, const std::vector<SensorDeviation>& sensors) {
  if (sensors.empty()) return {};
  std::vector<std::vector<std::string>> rows{
      {how, "horizontal [mm]", "vertical [mm]", "yaw [deg]", "pitch [deg]"}};
  for (const SensorDeviation& each : sensors)
    rows.push_back({each.sensor.str(), shown(to_mm(each.horizontal), 1),
                    shown(to_mm(each.vertical), 1), degrees_shown(each.yaw),
                    degrees_shown(each.pitch)});
  return table(std::move(rows));
}

json sensors_json(const std::vector<SensorDeviation>& sensors) {
  json all = json::array();
  for (const SensorDeviation& each : sensors) {
    all.push_back({{"sensorId", each.sensor.str()},
                   {"horizontalMillimetres", to_mm(each.horizontal)},
                   {"verticalMillimetres", to_mm(each.vertical)}});
    if (each.yaw) all.back()["yawDegrees"] = to_deg(*each.yaw);
    if (each.pitch) all.back()["pitchDegrees"] = to_deg(*each.pitch);
  }
  return all;
}

json walk_json(const AlignmentFindings& found) {
  const alignment::Alignment& walk = *found.walk;
  json out{{"body", found.body},
           {"joint", found.joint},
           {"samples", walk.times.size()},
           {"clockOffsetMilliseconds", 1e3 * walk.clock_offset},
           {"clockSigmaMilliseconds", 1e3 * walk.clock_sigma},
           {"yawSigmaDegrees", to_deg(walk.yaw_sigma)},
           {"placeSigmaMillimetres", to_mm(walk.place_sigma)}};
  for (const Measure& each : measures_of(walk.residuals))
    out["residuals"][each.name] = {{"medianMillimetres", to_mm(each.median)},
                                   {"percentile95Millimetres", to_mm(each.most)}};
  if (walk.marker_offset) {
    const Eigen::Vector3d marker = *walk.marker_offset;
    out["markerOffsetMillimetres"] = {to_mm(marker.x()), to_mm(marker.y()), to_mm(marker.z())};
  }
  return out;
}

}  // namespace

alignment::FloorPose origin_of(const Eigen::Isometry3d& ours_from_reference) {
  const Eigen::Vector3d place = ours_from_reference.translation();
  return {place.x(), place.z(), yaw_of(ours_from_reference.linear())};
}

std::string alignment_text(const AlignmentFindings& found) {
  std::string text = found.walk ? walk_text(found) : std::string();
  text += sensors_text(found.walk ? "sensor, by the walk" : "sensor, best fit", found.sensors);
  text += sensors_text("sensor, from the master", found.from_master);
  const alignment::FloorPose origin = origin_of(found.ours_from_reference);
  const double height = found.ours_from_reference.translation().y();
  text += fmt::format("the reference's floor (y = 0) is {:.0f} mm {} ours", to_mm(std::abs(height)),
                      height < 0 ? "below" : "above");
  const double tilt = to_deg(tilt_of(found.ours_from_reference));
  if (tilt > 1e-6) text += fmt::format(", and tilted by {:.2f} deg", tilt);
  if (found.walk && !found.walk->marker_height)
    text +=
        fmt::format(", or the marker so far {} {}", height < 0 ? "above" : "below", found.joint);
  text += '\n';
  return text + fmt::format("the same origin and front: chorus origin --x={} --z={} --yaw={}\n",
                            shown(origin.x, 4), shown(origin.z, 4), shown(to_deg(origin.yaw), 3));
}

json alignment_json(const AlignmentFindings& found) {
  const alignment::FloorPose origin = origin_of(found.ours_from_reference);
  json out{{"origin", {{"x", origin.x}, {"z", origin.z}, {"yawDegrees", to_deg(origin.yaw)}}},
           {"floorHeightMillimetres", to_mm(found.ours_from_reference.translation().y())},
           {"tiltDegrees", to_deg(tilt_of(found.ours_from_reference))},
           {"sensors", sensors_json(found.sensors)},
           {"sensorsFromMaster", sensors_json(found.from_master)}};
  if (found.walk) out["walk"] = walk_json(found);
  return out;
}

}  // namespace chorus::ctl
