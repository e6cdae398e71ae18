#include "tests/support/hands/shipped_scan.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace chorus::testing {
namespace {

using nlohmann::json;

double hundredth(double value) { return std::round(100.0 * value) / 100.0; }

}  // namespace

HandScene shipped_scene() {
  HandScene out;
  out.seed = 4;
  out.long_side = 1169;  // A4 at 100 dpi.
  out.upright = true;
  out.grain = 0.0;  // Grain makes PNG files large.
  return out;
}

std::string truth_json(const DrawnHand& drawn) {
  json out{{"side", hand::name_of(drawn.side)},
           {"seen", drawn.back ? "back" : "palm"},
           {"mmPerPixel", hundredth(100.0 / drawn.pixels_per_mm) / 100.0}};
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    const hand::Pixel& tip = drawn.joints[hand::hand_joint(f, 3)];
    out["fingers"][std::string(hand::kFingerNames[f])] = {
        {"fromWebMm", hundredth(drawn.free[f] / drawn.pixels_per_mm)},
        {"tip", {hundredth(tip.x()), hundredth(tip.y())}}};
  }
  return out.dump(1) + "\n";
}

}  // namespace chorus::testing
