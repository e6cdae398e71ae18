#include "tests/bench/hand/hand_methods.h"

#include <algorithm>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "services/sensor/device/camera/hand_finder.h"
#include "services/sensor/device/camera/shipped_runner.h"

namespace chorus::bench {

struct HandEyes::Network {
  camera::HandFinder finder;
};

std::string_view name_of(HandMethod method) {
  constexpr std::array<std::string_view, 3> kNames{"network and outline", "outline", "paper"};
  return kNames[static_cast<std::size_t>(method)];
}

HandEyes::HandEyes(Report& report) {
  camera::CameraSettings settings;
  settings.model = "hands";
  const auto command = camera::runner_command(settings);
  auto finder = command ? camera::HandFinder::start(*command)
                        : Result<camera::HandFinder>(tl::unexpected<Error>(command.error()));
  if (finder)
    network_ = std::make_unique<Network>(Network{std::move(*finder)});
  else
    report.note("network and outline: left out; " + to_string(finder.error()));
}

HandEyes::~HandEyes() = default;

Result<std::vector<hand::SeenHand>> HandEyes::look(const cv::Mat& picture) {
  if (!network_) return fail(ErrorCode::Unavailable, "network", "is not there");
  return network_->finder.look(
      {std::make_shared<const cv::Mat>(picture), {picture.cols, picture.rows}});
}

Result<hand::HandShape> hand_by(HandMethod method, const cv::Mat& picture, bool back,
                                HandEyes& eyes) {
  hand::ScanOptions options;
  options.back = back;
  options.paper = method == HandMethod::Paper;
  if (method != HandMethod::Both) return hand::hand_in(picture, {}, options);
  const auto seen = eyes.look(picture);
  if (!seen) return pass(seen);
  return hand::hand_in(picture, *seen, options);
}

cv::Mat of_working_size(const cv::Mat& picture) {
  const int side = std::max(picture.cols, picture.rows);
  if (side <= hand::kWorkingSide) return picture;
  cv::Mat out;
  const double factor = 1.0 * hand::kWorkingSide / side;
  cv::resize(picture, out, {}, factor, factor, cv::INTER_AREA);
  return out;
}

double share_quantile(std::vector<double> values, double share) {
  if (values.empty()) return kNoRatio;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void draw_sheet(const Report& report, const std::string& name, const std::vector<cv::Mat>& tiles) {
  if (report.plots().empty() || tiles.empty()) return;
  constexpr int kAcross = 8;
  std::vector<cv::Mat> rows;
  for (std::size_t i = 0; i < tiles.size(); i += kAcross) {
    std::vector<cv::Mat> row(
        tiles.begin() + static_cast<std::ptrdiff_t>(i),
        tiles.begin() + static_cast<std::ptrdiff_t>(std::min(tiles.size(), i + kAcross)));
    while (row.size() < kAcross) row.emplace_back(tiles[0].size(), CV_8UC3, cv::Scalar(0, 0, 0));
    cv::hconcat(row, rows.emplace_back());
  }
  cv::Mat sheet;
  cv::vconcat(rows, sheet);
  cv::imwrite(report.plots() + "/" + name + ".jpg", sheet);
}

cv::Mat tile_of(const cv::Mat& picture, bool right) {
  constexpr int kWide = 240, kHigh = 200;
  cv::Mat out(kHigh, kWide, CV_8UC3, cv::Scalar(0, right ? 120 : 0, right ? 0 : 160)), small;
  const double factor = std::min((kWide - 8.0) / picture.cols, (kHigh - 8.0) / picture.rows);
  cv::resize(picture, small, {}, factor, factor, cv::INTER_AREA);
  small.copyTo(out({4, 4, small.cols, small.rows}));
  return out;
}

}  // namespace chorus::bench
