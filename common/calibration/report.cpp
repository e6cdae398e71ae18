#include "common/calibration/report.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace chorus::calibration {
namespace {

/// Rounds to 1/`parts`.  Divides last, so that the result prints in few digits.
double rounded(double value, double parts) { return std::round(value * parts) / parts; }

void draw_thirds(cv::Mat& picture) {
  const cv::Scalar grey(110, 110, 110);
  for (int third = 1; third <= 2; ++third) {
    const int x = picture.cols * third / 3;
    const int y = picture.rows * third / 3;
    cv::line(picture, {x, 0}, {x, picture.rows - 1}, grey);
    cv::line(picture, {0, y}, {picture.cols - 1, y}, grey);
  }
}

}  // namespace

std::string intrinsics_json(const Intrinsics& camera, double focal_sigma) {
  constexpr double kPixels = 1e3;
  constexpr double kRounding = 1e6;
  nlohmann::ordered_json out{{"width", camera.width},
                             {"height", camera.height},
                             {"fx", rounded(camera.fx, kPixels)},
                             {"fy", rounded(camera.fy, kPixels)},
                             {"cx", rounded(camera.cx, kPixels)},
                             {"cy", rounded(camera.cy, kPixels)},
                             {"distortion", nlohmann::ordered_json::array()}};
  if (camera.model == LensModel::Fisheye) out["model"] = "fisheye";
  for (const double term : camera.distortion) out["distortion"].push_back(rounded(term, kRounding));
  // Rounded up, because 0 would mean that the focal length is known exactly.
  out["focal_sigma_percent"] = std::ceil(focal_sigma * 1e4) / 100.0;
  return out.dump(1) + "\n";
}

Result<std::string> coverage_png(const std::vector<SolvedView>& views, PictureSize size) {
  cv::Mat picture(size.height, size.width, CV_8UC3, cv::Scalar(40, 40, 40));
  draw_thirds(picture);
  const int radius = std::max(2, std::max(size.width, size.height) / 320);
  for (const SolvedView& each : views) {
    const cv::Scalar colour = each.used ? cv::Scalar(90, 220, 90) : cv::Scalar(80, 80, 255);
    for (const Corner& corner : each.view.corners) {
      const cv::Point at(static_cast<int>(std::lround(corner.pixel.x())),
                         static_cast<int>(std::lround(corner.pixel.y())));
      cv::circle(picture, at, radius, colour, cv::FILLED, cv::LINE_AA);
    }
  }
  std::vector<uchar> bytes;
  if (!cv::imencode(".png", picture, bytes))
    return fail(ErrorCode::Internal, "coverage", "the picture could not be encoded");
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace chorus::calibration
