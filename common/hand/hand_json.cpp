#include "common/hand/hand_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "common/base/json.h"

namespace chorus::hand {
namespace {

using nlohmann::json;

constexpr std::string_view kFormat = "chorus-hand";
constexpr double kMillimetres = 1000.0;

double rounded(double value) { return std::round(value * 1000.0) / 1000.0; }

json point(const Eigen::Vector3d& metres) {
  return {rounded(kMillimetres * metres.x()), rounded(kMillimetres * metres.y()),
          rounded(kMillimetres * metres.z())};
}

json pixel(const Pixel& p) { return {rounded(p.x()), rounded(p.y())}; }

json finger_json(const HandShape& hand, const Skeleton& skeleton, std::size_t f) {
  json out;
  for (std::size_t i = 1; i < kFingerJoints; ++i)
    out["partsMm"].push_back(rounded(kMillimetres * part_length(skeleton, f, i)));
  const FingerShape& finger = hand.fingers[f];
  const double scale = skeleton.palm_radius / hand.outline.palm_radius;
  out["fromWebMm"] = rounded(kMillimetres * scale * finger.length());
  out["widthMm"] =
      skeleton.widths[f] > 0.0 ? json(rounded(kMillimetres * skeleton.widths[f])) : json();
  out["tip"] = pixel(finger.tip);
  out["base"] = {pixel(finger.base[0]), pixel(finger.base[1])};
  return out;
}

constexpr std::array<std::string_view, 3> kOrigins{"paper", "contour", "contour and network"};

/// Reads three numbers [mm]; false if there are none.
bool read_point(const json& value, Eigen::Vector3d& out) {
  if (!value.is_array() || value.size() != 3) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!value[i].is_number()) return false;
    out[static_cast<Eigen::Index>(i)] = value[i].get<double>() / kMillimetres;
  }
  return out.allFinite() && out.norm() < 1.0;
}

tl::unexpected<Error> wrong(std::string place, std::string what) {
  return fail(ErrorCode::Malformed, std::move(place), std::move(what));
}

}  // namespace

std::string scan_json(const HandShape& hand, const Skeleton& skeleton, const ScanRecord& record) {
  json out{{"format", kFormat}, {"version", 1}, {"picture", record.source}};
  out["side"] = name_of(skeleton.side);
  out["sideFrom"] = hand.side_seen ? "network" : "assumed";
  out["seen"] = hand.back_seen ? "back" : "palm";
  out["method"] = kOrigins[static_cast<std::size_t>(hand.origin)];
  out["network"] = record.network.empty() ? json() : json(record.network);
  out["relative"] = skeleton.relative;
  out["scale"] = skeleton.relative
                     ? json{{"from", "none: a hand of 187 mm is assumed"}}
                     : json{{"from", record.scale_from}, {"mmPerPixel", record.mm_per_pixel}};
  out["lengthMm"] = rounded(kMillimetres * length_of(skeleton));
  for (std::size_t f = 0; f < kFingers; ++f)
    out["fingers"][std::string(kFingerNames[f])] = finger_json(hand, skeleton, f);
  out["layout"] = layout::kHandLayout;
  for (const Pixel& each : hand.joints) out["pixels"].push_back(pixel(each));
  for (const auto& each : skeleton.joints) out["restMm"].push_back(point(each));
  out["palmMm"] = point(skeleton.palm);
  out["palmRadiusMm"] = rounded(kMillimetres * skeleton.palm_radius);
  out["notes"] = hand.notes;
  return out.dump(1, ' ', true) + "\n";
}

Result<Skeleton> read_skeleton(std::string_view text) {
  const auto parsed = parse_json(text);
  if (!parsed) return pass(parsed);
  const json& in = *parsed;
  if (!in.is_object() || in.value("format", json()) != json(kFormat))
    return wrong("format", "must be \"chorus-hand\": the .json that chorus scan writes");
  Skeleton out;
  const json side = in.value("side", json());
  if (side != "left" && side != "right") return wrong("side", "must be \"left\" or \"right\"");
  out.side = side == "left" ? Side::Left : Side::Right;
  const json rest = in.value("restMm", json());
  if (!rest.is_array() || rest.size() != kHandJoints)
    return wrong("restMm", "must be 21 places, in millimetres");
  for (std::size_t i = 0; i < kHandJoints; ++i) {
    if (!read_point(rest[i], out.joints[i]))
      return wrong("restMm", "must be three numbers for each joint");
  }
  if (!read_point(in.value("palmMm", json()), out.palm))
    return wrong("palmMm", "must be three numbers");
  const json radius = in.value("palmRadiusMm", json());
  if (!radius.is_number() || !(radius.get<double>() > 0.0))
    return wrong("palmRadiusMm", "must be a number above 0");
  out.palm_radius = radius.get<double>() / kMillimetres;
  const json relative = in.value("relative", json(false));
  out.relative = relative.is_boolean() && relative.get<bool>();
  const json fingers = in.value("fingers", json::object());
  for (std::size_t f = 0; f < kFingers; ++f) {
    const json finger =
        fingers.is_object() ? fingers.value(std::string(kFingerNames[f]), json()) : json();
    const json width = finger.is_object() ? finger.value("widthMm", json()) : json();
    out.widths[f] = width.is_number() ? width.get<double>() / kMillimetres : 0.0;
  }
  return out;
}

}  // namespace chorus::hand
