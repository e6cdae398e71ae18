#include "common/sensor/impossible_lens.h"

#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"

namespace chorus {

std::optional<LensObjection> objection_to(const Intrinsics& lens) {
  const bool fisheye = lens.model == LensModel::Fisheye;
  // What a pinhole can still show; no fisheye sees as much as all around.
  const double widest = deg(fisheye ? 320.0 : 160.0);
  const auto angle = [&](int side, double focal) {
    return fisheye ? side / focal : 2.0 * std::atan(0.5 * side / focal);
  };
  for (const auto& [key, side, focal] :
       {std::tuple{"fx", lens.width, lens.fx}, std::tuple{"fy", lens.height, lens.fy}}) {
    if (!(focal > 0.0) || angle(side, focal) <= widest) continue;
    return LensObjection{
        key, fmt::format("is {:.6g} px for pictures of {} px, a field of view of {:.0f} degrees; "
                         "focal lengths are counted in pixels: is it in millimetres?",
                         focal, side, to_deg(angle(side, focal)))};
  }
  return std::nullopt;
}

}  // namespace chorus
