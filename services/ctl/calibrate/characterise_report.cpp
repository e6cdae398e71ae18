#include "services/ctl/calibrate/characterise_report.h"

#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

using namespace characteristics;

constexpr double kPercent = 100.0;
constexpr double kLeastShare = 0.005;  // shares below this are not worth a line

std::string_view name_of_state(JointState state) {
  return state == JointState::Inferred ? "inferred" : "tracked";
}

std::string degrees(const std::vector<double>& angles) {
  std::string text;
  for (const double angle : angles) text += fmt::format(" {:.0f}", to_deg(angle));
  return text;
}

std::string front_rear_text(const Characteristics& sensor) {
  switch (sensor.exchange.front_rear) {
    case FrontRear::Tells:
      return "left and right are right from behind, too: it tells front from rear";
    case FrontRear::TakesForFacing:
      return "left and right are exchanged from behind: it takes everybody for facing it";
    case FrontRear::Mirrored:
      return "left and right are exchanged in front: is its picture mirrored, or did the person "
             "begin with their back to it?";
    case FrontRear::Unclear:
      return "the person walks, or seems to end with their back to it: no turn was followed. Face "
             "it "
             "first and last, or say when each turn began and ended with --turn";
    case FrontRear::Mixed:
      return "from behind, left and right are now right and now exchanged";
    case FrontRear::Unknown:
      break;
  }
  return "nobody turned their back on it for a second, so how it labels left and right from behind "
         "is not known: record somebody who faces it, turns once and faces it again; if they did, "
         "say when with "
         "--turn";
}

bool is_known(FrontRear front_rear) {
  return front_rear != FrontRear::Unknown && front_rear != FrontRear::Unclear;
}

std::string exchange_text(const Characteristics& sensor) {
  std::string text = front_rear_text(sensor) + '\n';
  const Exchange& exchange = sensor.exchange;
  if (!is_known(exchange.front_rear)) return text;
  if (!exchange.out.empty()) text += fmt::format("exchanged at{} deg\n", degrees(exchange.out));
  if (!exchange.back.empty())
    text += fmt::format("changed back at{} deg\n", degrees(exchange.back));
  std::vector<std::vector<std::string>> rows{{"front away from it [deg]", "turning away [s]",
                                              "exchanged [%]", "turning back [s]",
                                              "exchanged [%]"}};
  for (std::size_t i = 0; i < kTurnSectors; ++i) {
    const TurnSector& own = exchange.sectors[i];
    rows.push_back({fmt::format("{} to {}", 15 * i, 15 * (i + 1)), shown(own.away_s, 1),
                    shown(kPercent * own.exchanged_away_s / own.away_s, 0), shown(own.back_s, 1),
                    shown(kPercent * own.exchanged_back_s / own.back_s, 0)});
  }
  return text + table(std::move(rows));
}

std::string jitter_text(const Jitter& jitter) {
  std::vector<std::vector<std::string>> rows{
      {"joint", "state", "distance [m]", "along [mm]", "across [mm]", "frames"}};
  for (const JitterCell& cell : jitter.cells) {
    rows.push_back({std::string(name_of(cell.joint)), std::string(name_of_state(cell.state)),
                    shown(cell.distance, 2), shown(to_mm(cell.along), 2),
                    shown(to_mm(cell.across), 2), std::to_string(cell.frames)});
  }
  std::string text = "jitter about a slow trend, rms:\n" + table(std::move(rows));
  std::vector<std::vector<std::string>> steps{{"joint", "front", "side", "rear"}};
  for (const JointId id : kCoreJoints) {
    std::vector<std::string> row{std::string(name_of(id)), "-", "-", "-"};
    for (const StepCell& cell : jitter.steps) {
      if (cell.joint == id)
        row.at(1 + static_cast<std::size_t>(cell.side)) = shown(to_mm(cell.step), 2);
    }
    steps.push_back(std::move(row));
  }
  return text + "displacement from frame to frame, mean [mm]:\n" + table(std::move(steps));
}

std::string view_text(const FieldOfView& view) {
  return fmt::format(
      "saw joints from {:.0f} deg right to {:.0f} deg left of its axis and from {:.0f} deg below "
      "to {:.0f} deg above, people {:.1f} to {:.1f} m away\n",
      -to_deg(view.aside.least), to_deg(view.aside.most), -to_deg(view.upwards.least),
      to_deg(view.upwards.most), view.distance.least, view.distance.most);
}

std::string delivery_text(const Delivery& delivery) {
  return fmt::format(
      "{:.2f} frames a second ({:.2f} ms +- {:.2f}), {:.1f} % lost, longest gap {:.0f} ms, {:.1f} "
      "% without the person\n",
      1.0 / delivery.step, 1e3 * delivery.step, 1e3 * delivery.step_sigma,
      kPercent * delivery.lost_share, 1e3 * delivery.longest_gap, kPercent * delivery.empty_share);
}

std::string shares_text(const Coverage& coverage) {
  std::vector<std::vector<std::string>> rows{{"joint", "inferred [%]", "missing [%]"}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const JointShares& own = coverage.joints[j];
    if (own.inferred < kLeastShare && own.missing < kLeastShare) continue;
    rows.push_back({std::string(kJointNames[j]), shown(kPercent * own.inferred, 1),
                    shown(kPercent * own.missing, 1)});
  }
  if (rows.size() == 1) return "every joint is tracked in every frame\n";
  return table(std::move(rows));
}

std::string bias_text(const Characteristics& sensor) {
  if (!sensor.depth_bias) return "depth bias: " + sensor.no_depth_bias + '\n';
  const MarkedDepthBias& bias = *sensor.depth_bias;
  return fmt::format(
      "depth bias: joints are {:.0f} mm +- {:.0f} too near (front {:.0f}, side {:.0f}, rear "
      "{:.0f})\n",
      to_mm(bias.mean.bias), to_mm(bias.mean.sigma), to_mm(bias.front), to_mm(bias.side),
      to_mm(bias.rear));
}

std::string sensor_text(const Characteristics& sensor) {
  return fmt::format("sensor {}: {:.0f} s, {} frames with the person, who stands in {:.0f} %\n",
                     sensor.sensor.str(), sensor.seconds, sensor.sights,
                     kPercent * sensor.standing) +
         delivery_text(sensor.coverage.delivery) + view_text(sensor.coverage.view) +
         exchange_text(sensor) + bias_text(sensor) + jitter_text(sensor.jitter) +
         shares_text(sensor.coverage);
}

nlohmann::json sectors_json(const Exchange& exchange) {
  nlohmann::json all = nlohmann::json::array();
  for (std::size_t i = 0; i < kTurnSectors; ++i) {
    const TurnSector& own = exchange.sectors[i];
    all.push_back({{"fromDegrees", 15 * i},
                   {"awaySeconds", own.away_s},
                   {"exchangedAwaySeconds", own.exchanged_away_s},
                   {"backSeconds", own.back_s},
                   {"exchangedBackSeconds", own.exchanged_back_s}});
  }
  return all;
}

nlohmann::json degrees_json(const std::vector<double>& angles) {
  nlohmann::json all = nlohmann::json::array();
  for (const double angle : angles) all.push_back(to_deg(angle));
  return all;
}

constexpr std::array<const char*, 6> kFrontRearNames{"unknown",  "tells",   "takes-for-facing",
                                                     "mirrored", "unclear", "mixed"};

const char* front_rear_name(FrontRear front_rear) {
  return kFrontRearNames.at(static_cast<std::size_t>(front_rear));
}

nlohmann::json bias_json(const MarkedDepthBias& bias) {
  return {{"millimetres", to_mm(bias.mean.bias)},
          {"sigmaMillimetres", to_mm(bias.mean.sigma)},
          {"frontMillimetres", to_mm(bias.front)},
          {"sideMillimetres", to_mm(bias.side)},
          {"rearMillimetres", to_mm(bias.rear)}};
}

nlohmann::json jitter_json(const Jitter& jitter) {
  nlohmann::json all = nlohmann::json::array();
  for (const JitterCell& cell : jitter.cells) {
    all.push_back({{"joint", name_of(cell.joint)},
                   {"state", name_of_state(cell.state)},
                   {"distance", cell.distance},
                   {"alongMillimetres", to_mm(cell.along)},
                   {"acrossMillimetres", to_mm(cell.across)},
                   {"frames", cell.frames}});
  }
  return all;
}

nlohmann::json steps_json(const Jitter& jitter) {
  constexpr std::array<const char*, 3> kSides{"front", "side", "rear"};
  nlohmann::json all = nlohmann::json::array();
  for (const StepCell& cell : jitter.steps) {
    all.push_back({{"joint", name_of(cell.joint)},
                   {"side", kSides.at(static_cast<std::size_t>(cell.side))},
                   {"millimetres", to_mm(cell.step)},
                   {"frames", cell.frames}});
  }
  return all;
}

nlohmann::json coverage_json(const Coverage& coverage) {
  const auto extent = [](const Extent& of) {
    return nlohmann::json{to_deg(of.least), to_deg(of.most)};
  };
  nlohmann::json joints = nlohmann::json::object();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints[std::string(kJointNames[j])] = {{"inferredShare", coverage.joints[j].inferred},
                                           {"missingShare", coverage.joints[j].missing}};
  }
  const FieldOfView& view = coverage.view;
  const Delivery& delivery = coverage.delivery;
  return {{"asideDegrees", extent(view.aside)},
          {"upwardsDegrees", extent(view.upwards)},
          {"guessedAsideDegrees", extent(view.guessed_aside)},
          {"guessedUpwardsDegrees", extent(view.guessed_upwards)},
          {"distance", {view.distance.least, view.distance.most}},
          {"stepMilliseconds", 1e3 * delivery.step},
          {"stepSigmaMilliseconds", 1e3 * delivery.step_sigma},
          {"lostShare", delivery.lost_share},
          {"longestGapMilliseconds", 1e3 * delivery.longest_gap},
          {"emptyShare", delivery.empty_share},
          {"joints", joints}};
}

nlohmann::json sensor_json(const Characteristics& sensor) {
  nlohmann::json json{{"sensor", sensor.sensor.str()},
                      {"seconds", sensor.seconds},
                      {"frames", sensor.sights},
                      {"standingShare", sensor.standing},
                      {"frontRear", front_rear_name(sensor.exchange.front_rear)},
                      {"exchangedAtDegrees", degrees_json(sensor.exchange.out)},
                      {"changedBackAtDegrees", degrees_json(sensor.exchange.back)},
                      {"turnedDegrees", to_deg(sensor.exchange.turned)},
                      {"sectors", sectors_json(sensor.exchange)},
                      {"jitter", jitter_json(sensor.jitter)},
                      {"steps", steps_json(sensor.jitter)},
                      {"coverage", coverage_json(sensor.coverage)}};
  if (sensor.depth_bias) json["depthBias"] = bias_json(*sensor.depth_bias);
  return json;
}

std::string cell_text(const Measured& measured) {
  std::string text;
  if (measured.agreement)
    text += fmt::format(
        "the sensors' views of neck and chest differ as if each erred by {:.1f} mm along its line "
        "of sight and {:.1f} mm across it ({} pairs), errors that last included\n",
        to_mm(measured.agreement->along), to_mm(measured.agreement->across),
        measured.agreement->pairs);
  if (measured.walked_bias)
    text += fmt::format("depth bias by the walk: {:.0f} mm +- {:.0f} too near\n",
                        to_mm(measured.walked_bias->bias), to_mm(measured.walked_bias->sigma));
  return text;
}

}  // namespace

std::string characterise_text(const SensorReport& report) {
  std::string text;
  for (const Characteristics& sensor : report.measured.sensors) text += sensor_text(sensor) + '\n';
  text += cell_text(report.measured);
  for (const std::string& note : report.notes) text += "note: " + note + '\n';
  return text;
}

nlohmann::json characterise_json(const SensorReport& report) {
  nlohmann::json sensors = nlohmann::json::array();
  for (const Characteristics& sensor : report.measured.sensors)
    sensors.push_back(sensor_json(sensor));
  nlohmann::json json{{"sensors", sensors}, {"notes", report.notes}};
  if (const auto& agreement = report.measured.agreement) {
    json["agreement"] = {{"alongMillimetres", to_mm(agreement->along)},
                         {"acrossMillimetres", to_mm(agreement->across)},
                         {"pairs", agreement->pairs}};
  }
  if (const auto& bias = report.measured.walked_bias) {
    json["walkedDepthBias"] = {{"millimetres", to_mm(bias->bias)},
                               {"sigmaMillimetres", to_mm(bias->sigma)}};
  }
  return json;
}

}  // namespace chorus::ctl
