#include "common/calibration/calibrate.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "common/base/median.h"

namespace chorus::calibration {
namespace {

constexpr std::size_t kLeastViews = 3;
constexpr int kRounds = 6;
constexpr double kOddView = 2.5;      // times the median error of the views
constexpr double kGoodViewPx = 0.25;  // a view this good is never left out
// An error of a flat board's corners, relative to the picture's longer side, that no lens's
// distortion explains.  Solving for a lens would take minutes then, and find none.
constexpr double kNoFlatBoard = 0.06;
constexpr double kNoFlatBoardFisheye = 0.15;  // A fisheye bends straight lines far more.
constexpr std::size_t kTerms = 9;             // fx fy cx cy k1 k2 p1 p2 k3

/// The output of OpenCV.
struct Solution {
  Intrinsics camera;
  std::array<double, kTerms> sigma{};
  double error = 0.0;
  std::vector<double> view_errors;
  std::vector<double> tilts;
};

struct Points {
  std::vector<std::vector<cv::Point3f>> on_board;
  std::vector<std::vector<cv::Point2f>> pixels;
};

Points for_opencv(const std::vector<const View*>& views) {
  Points out;
  for (const View* view : views) {
    auto& on_board = out.on_board.emplace_back();
    auto& pixels = out.pixels.emplace_back();
    for (const Corner& corner : view->corners) {
      on_board.emplace_back(static_cast<float>(corner.on_board.x()),
                            static_cast<float>(corner.on_board.y()), 0.0F);
      pixels.emplace_back(static_cast<float>(corner.pixel.x()),
                          static_cast<float>(corner.pixel.y()));
    }
  }
  return out;
}

/// Tilt against the picture's plane, not against the line of sight: a board parallel to that plane
/// says nothing about the focal length, even if it is off-centre and therefore seen obliquely.
double tilt_of(const cv::Mat& turn) {
  cv::Mat rotation;
  cv::Rodrigues(turn, rotation);
  return std::acos(std::min(1.0, std::abs(rotation.at<double>(2, 2))));
}

Intrinsics intrinsics_of(const cv::Mat& matrix, const cv::Mat& distortion, PictureSize size) {
  Intrinsics out{size.width,
                 size.height,
                 matrix.at<double>(0, 0),
                 matrix.at<double>(1, 1),
                 matrix.at<double>(0, 2),
                 matrix.at<double>(1, 2),
                 {}};
  for (std::size_t i = 0; i < out.distortion.size(); ++i)
    out.distortion[i] = distortion.at<double>(static_cast<int>(i));
  return out;
}

Solution solve(const std::vector<const View*>& views, PictureSize size, bool with_k3) {
  const Points points = for_opencv(views);
  cv::Mat matrix;
  cv::Mat distortion = cv::Mat::zeros(5, 1, CV_64F);
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> places;
  cv::Mat sigma;
  cv::Mat sigma_of_views;
  cv::Mat errors;
  Solution out;
  out.error = cv::calibrateCamera(points.on_board, points.pixels, {size.width, size.height}, matrix,
                                  distortion, turns, places, sigma, sigma_of_views, errors,
                                  with_k3 ? 0 : cv::CALIB_FIX_K3,
                                  {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-9});
  out.camera = intrinsics_of(matrix, distortion, size);
  for (std::size_t i = 0; i < kTerms; ++i) out.sigma[i] = sigma.at<double>(static_cast<int>(i));
  for (std::size_t i = 0; i < views.size(); ++i) {
    out.view_errors.push_back(errors.at<double>(static_cast<int>(i)));
    out.tilts.push_back(tilt_of(turns[i]));
  }
  return out;
}

/// One solution by cv::fisheye: the lens, and the turns of the views.
struct FisheyeSolution {
  Intrinsics camera;
  double error = 0.0;
  std::vector<cv::Mat> turns, places;
};

FisheyeSolution fisheye_once(const Points& points, PictureSize size) {
  cv::Mat matrix = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat terms = cv::Mat::zeros(4, 1, CV_64F);
  std::vector<std::vector<cv::Point3d>> on_board;
  std::vector<std::vector<cv::Point2d>> pixels;
  for (const auto& view : points.on_board) on_board.emplace_back(view.begin(), view.end());
  for (const auto& view : points.pixels) pixels.emplace_back(view.begin(), view.end());
  FisheyeSolution out;
  out.error = cv::fisheye::calibrate(
      on_board, pixels, {size.width, size.height}, matrix, terms, out.turns, out.places,
      cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW,
      {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-9});
  cv::Mat five = cv::Mat::zeros(5, 1, CV_64F);
  terms.copyTo(five.rowRange(0, 4));
  out.camera = intrinsics_of(matrix, five, size);
  out.camera.model = LensModel::Fisheye;
  return out;
}

double fisheye_error(const Points& points, const FisheyeSolution& solution, std::size_t view) {
  const Intrinsics& c = solution.camera;
  const cv::Matx33d matrix(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  const cv::Vec4d terms(c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3]);
  std::vector<cv::Point3d> on_board(points.on_board[view].begin(), points.on_board[view].end());
  std::vector<cv::Point2d> seen(points.pixels[view].begin(), points.pixels[view].end());
  std::vector<cv::Point2d> made;
  cv::fisheye::projectPoints(on_board, made, cv::Mat(solution.turns[view]).reshape(1, 3),
                             cv::Mat(solution.places[view]).reshape(1, 3), matrix, terms);
  return cv::norm(made, seen) / std::sqrt(static_cast<double>(seen.size()));
}

std::array<double, kTerms> terms_in(const Intrinsics& c) {
  return {
      c.fx, c.fy, c.cx, c.cy, c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3],
      0.0};
}

/// Every `groups`-th view, from `first` on, is left out.
Points without_group(const Points& points, std::size_t first, std::size_t groups) {
  Points rest;
  for (std::size_t i = 0; i < points.on_board.size(); ++i) {
    if (i % groups == first) continue;
    rest.on_board.push_back(points.on_board[i]);
    rest.pixels.push_back(points.pixels[i]);
  }
  return rest;
}

/// Standard deviations by the grouped jackknife, because cv::fisheye tells none: each group of
/// views is left out once.
std::array<double, kTerms> jackknifed(const Points& points, PictureSize size) {
  constexpr std::size_t kGroups = 8;
  const std::size_t groups = std::min(kGroups, points.on_board.size());
  std::vector<std::array<double, kTerms>> all;
  for (std::size_t group = 0; group < groups; ++group)
    all.push_back(terms_in(fisheye_once(without_group(points, group, groups), size).camera));
  std::array<double, kTerms> sigma{};
  const double n = static_cast<double>(groups);
  for (std::size_t term = 0; term < kTerms; ++term) {
    double mean = 0.0;
    double squares = 0.0;
    for (const auto& each : all) mean += each[term] / n;
    for (const auto& each : all) squares += (each[term] - mean) * (each[term] - mean);
    sigma[term] = std::sqrt((n - 1.0) / n * squares);
  }
  return sigma;
}

Solution solve_fisheye(const std::vector<const View*>& views, PictureSize size) {
  const Points points = for_opencv(views);
  const FisheyeSolution solved = fisheye_once(points, size);
  Solution out;
  out.camera = solved.camera;
  out.error = solved.error;
  for (std::size_t i = 0; i < views.size(); ++i) {
    out.view_errors.push_back(fisheye_error(points, solved, i));
    out.tilts.push_back(tilt_of(cv::Mat(solved.turns[i]).reshape(1, 3)));
  }
  out.sigma = jackknifed(points, size);
  return out;
}

/// Estimates k3 if its standard deviation is below a third of its value and it improves the fit.
Solution solve_well(const std::vector<const View*>& views, PictureSize size, LensModel model) {
  if (model == LensModel::Fisheye) return solve_fisheye(views, size);
  Solution plain = solve(views, size, false);
  Solution full = solve(views, size, true);
  const bool needed = full.error < 0.98 * plain.error &&
                      3.0 * full.sigma.back() < std::abs(full.camera.distortion.back());
  return needed ? full : plain;
}

/// The views whose error is far above that of the others, at most `most` of them, worst first.
std::vector<std::size_t> odd_views(const std::vector<double>& errors, std::size_t most) {
  const double limit = std::max(kGoodViewPx, kOddView * median(errors));
  std::vector<std::size_t> odd;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!(errors[i] <= limit)) odd.push_back(i);
  }
  std::sort(odd.begin(), odd.end(),
            [&](std::size_t a, std::size_t b) { return errors[a] > errors[b]; });
  odd.resize(std::min(odd.size(), most));
  return odd;
}

std::vector<const View*> used_of(const Calibration& calibration) {
  std::vector<const View*> used;
  for (const SolvedView& each : calibration.views) {
    if (each.used) used.push_back(&each.view);
  }
  return used;
}

/// Copies the solution to `out`: the lens, and the error and tilt of each used view.
void tell(const Solution& solution, Calibration& out) {
  std::size_t i = 0;
  for (SolvedView& each : out.views) {
    if (!each.used) continue;
    each.error_px = solution.view_errors[i];
    each.tilt = solution.tilts[i++];
  }
  out.intrinsics = solution.camera;
  out.sigma = solution.sigma;
  out.error_px = solution.error;
}

/// Leaves out the odd views, at most `most` of them, and returns how many.
std::size_t leave_out(const Solution& solution, Calibration& out, std::size_t most) {
  const auto odd = odd_views(solution.view_errors, most);
  std::vector<SolvedView*> used;
  for (SolvedView& each : out.views) {
    if (each.used) used.push_back(&each);
  }
  for (const std::size_t i : odd) used[i]->used = false;
  return odd.size();
}

/// How far the corners of a view are from the best map of a flat board onto the picture [px]: the
/// lens's distortion, and the mistake of another board.
double flat_error(const std::vector<cv::Point3f>& corners, const std::vector<cv::Point2f>& pixels) {
  std::vector<cv::Point2f> on_board;
  for (const cv::Point3f& corner : corners) on_board.emplace_back(corner.x, corner.y);
  const cv::Mat map = cv::findHomography(on_board, pixels);
  if (map.empty()) return 0.0;
  std::vector<cv::Point2f> mapped;
  cv::perspectiveTransform(on_board, mapped, map);
  return cv::norm(mapped, pixels) / std::sqrt(static_cast<double>(pixels.size()));
}

double median_flat_error(const std::vector<const View*>& views) {
  const Points points = for_opencv(views);
  std::vector<double> errors;
  for (std::size_t i = 0; i < views.size(); ++i)
    errors.push_back(flat_error(points.on_board[i], points.pixels[i]));
  return median(errors);
}

}  // namespace

double Calibration::focal_sigma() const {
  return std::max(sigma[0] / intrinsics.fx, sigma[1] / intrinsics.fy);
}

std::size_t Calibration::used() const { return used_of(*this).size(); }

Result<Calibration> calibrate(const std::vector<View>& views, PictureSize size, LensModel model) {
  if (views.size() < kLeastViews)
    return fail(ErrorCode::InvalidArgument, "calibration",
                "needs three views of the board or more");
  Calibration out;
  out.intrinsics = {size.width, size.height, 0.0, 0.0, 0.0, 0.0, {}};
  for (const View& view : views) out.views.push_back({view});
  std::size_t may_leave = views.size() / 3;
  try {
    out.error_px = median_flat_error(used_of(out));
    const double most = model == LensModel::Fisheye ? kNoFlatBoardFisheye : kNoFlatBoard;
    if (out.error_px > most * std::max(size.width, size.height)) return out;
    for (int round = 0; round < kRounds; ++round) {
      const Solution solution = solve_well(used_of(out), size, model);
      tell(solution, out);
      const std::size_t left = leave_out(solution, out, may_leave);
      if (left == 0) break;
      may_leave -= left;
    }
    tell(solve_well(used_of(out), size, model), out);
  } catch (const cv::Exception&) {
    return fail(ErrorCode::InvalidArgument, "calibration",
                "no lens fits these views; are --board and --squares those of the board?");
  }
  return out;
}

}  // namespace chorus::calibration
