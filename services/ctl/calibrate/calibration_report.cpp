#include "services/ctl/calibrate/calibration_report.h"

#include <array>

#include <fmt/format.h>

#include "common/base/units.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

using calibration::Calibration;
using calibration::SolvedView;

struct Term {
  const char* name;
  const char* unit;
  double value;
  double sigma;
};

std::vector<Term> terms_of(const Calibration& calibration) {
  const Intrinsics& c = calibration.intrinsics;
  const auto& [k1, k2, p1, p2, k3] = c.distortion;
  const auto& s = calibration.sigma;
  const bool fisheye = c.model == LensModel::Fisheye;
  std::vector<Term> out{{"fx", " px", c.fx, s[0]},
                        {"fy", " px", c.fy, s[1]},
                        {"cx", " px", c.cx, s[2]},
                        {"cy", " px", c.cy, s[3]},
                        {"k1", "", k1, s[4]},
                        {"k2", "", k2, s[5]},
                        {fisheye ? "k3" : "p1", "", p1, s[6]},
                        {fisheye ? "k4" : "p2", "", p2, s[7]},
                        {"k3", "", k3, s[8]}};
  if (fisheye) out.pop_back();  // It has four.
  return out;
}

std::string view_table(const Calibration& calibration) {
  std::vector<std::vector<std::string>> rows{{"view", "corners", "error, px", "tilt, deg", ""}};
  for (const SolvedView& each : calibration.views) {
    rows.push_back({each.view.name, std::to_string(each.view.corners.size()),
                    shown(each.error_px, 2), shown(to_deg(each.tilt), 0),
                    each.used ? "" : "left out: does not fit the others"});
  }
  return table(std::move(rows));
}

/// Only for views that determine the lens: other deviations would seem small where nothing is
/// known.
std::string term_lines(const Calibration& calibration) {
  std::string text;
  for (const Term& term : terms_of(calibration)) {
    text += term.sigma > 0.0 ? fmt::format("{} {:.5g} +- {:.2g}{}\n", term.name, term.value,
                                           term.sigma, term.unit)
                             : fmt::format("{} 0, not needed\n", term.name);
  }
  return text + fmt::format("mean error {:.2f} px; the focal length is known to {:.2f} %\n",
                            calibration.error_px, 100.0 * calibration.focal_sigma());
}

}  // namespace

std::string calibration_text(const Calibration& calibration, const BoardViews& found,
                             const std::vector<std::string>& weaknesses) {
  std::string text = fmt::format("the board in {} of {} pictures of {} x {}, {} different views\n",
                                 found.views.size(), found.pictures, found.size.width,
                                 found.size.height, calibration.views.size());
  for (const std::string& note : found.notes) text += "note: " + printable(note) + "\n";
  const bool solved = calibration.error_px > 0.0 && calibration.intrinsics.fx > 0.0;
  if (solved) text += view_table(calibration);
  if (weaknesses.empty()) return text + term_lines(calibration);
  if (solved) text += fmt::format("mean error {:.2f} px\n", calibration.error_px);
  text += "not good enough, and not written:\n";
  for (const std::string& weakness : weaknesses) text += "  - " + weakness + "\n";
  return text;
}

nlohmann::json calibration_json(const Calibration& calibration, const BoardViews& found,
                                const std::vector<std::string>& weaknesses) {
  nlohmann::json out{{"good", weaknesses.empty()},
                     {"weaknesses", weaknesses},
                     {"notes", found.notes},
                     {"pictures", found.pictures},
                     {"found", found.views.size()},
                     {"width", found.size.width},
                     {"height", found.size.height},
                     {"errorPixels", calibration.error_px},
                     {"focalSigmaPercent", 100.0 * calibration.focal_sigma()},
                     {"views", nlohmann::json::array()}};
  for (const Term& term : terms_of(calibration)) {
    out["lens"][term.name] = term.value;
    out["sigma"][term.name] = term.sigma;
  }
  for (const SolvedView& each : calibration.views) {
    out["views"].push_back({{"name", each.view.name},
                            {"corners", each.view.corners.size()},
                            {"errorPixels", each.error_px},
                            {"tiltDegrees", to_deg(each.tilt)},
                            {"used", each.used}});
  }
  return out;
}

}  // namespace chorus::ctl
