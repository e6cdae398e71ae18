#include "common/calibration/place_fit.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "common/geometry/rotation.h"
#include "common/sensor/pixel_ray.h"

namespace chorus::calibration {
namespace {

constexpr int kCommon = 7;  // Rotation vector, position, focal.
constexpr int kOfBoard = 3;
constexpr int kSteps = 20;
constexpr double kSmall = 1e-6;  // Step of a numeric derivative.
constexpr double kConverged = 1e-9;
// Without a stated uncertainty of the focal length, it counts as exact to a hundredth of a percent.
constexpr double kLeastFocalSigma = 1e-4;

/// First parameter of each sight's board; -1: none.
std::vector<int> columns_of(const PlaceGuess& guess, int& count) {
  std::vector<int> columns;
  count = kCommon;
  for (const MovedBoard& board : guess.boards) {
    columns.push_back(board.moved ? count : -1);
    if (board.moved) count += kOfBoard;
  }
  return columns;
}

PlaceGuess moved_by(const PlaceGuess& guess, const Eigen::VectorXd& by) {
  PlaceGuess out = guess;
  out.world_from_camera.linear() =
      exp_map(by.head<3>()).toRotationMatrix() * guess.world_from_camera.linear();
  out.world_from_camera.translation() += by.segment<3>(3);
  out.focal += by[6];
  int at = kCommon;
  for (MovedBoard& board : out.boards) {
    if (!board.moved) continue;
    board.x += by[at];
    board.z += by[at + 1];
    board.yaw += by[at + 2];
    at += kOfBoard;
  }
  return out;
}

Eigen::Vector3d moved_point(const MovedBoard& board, const Eigen::Vector3d& point) {
  if (!board.moved) return point;
  return about_y(board.yaw) * point + Eigen::Vector3d(board.x, 0.0, board.z);
}

/// All residuals in standard deviations: two for each corner, then focal length and height.
std::optional<Eigen::VectorXd> residuals_of(const PlaceQuestion& question,
                                            const PlaceGuess& guess) {
  std::size_t corners = 0;
  for (const View& sight : question.sights) corners += sight.corners.size();
  Eigen::VectorXd out(static_cast<Eigen::Index>(2 * corners + 1 + (question.height ? 1 : 0)));
  Intrinsics lens = question.lens;
  lens.fx *= 1.0 + guess.focal;
  lens.fy *= 1.0 + guess.focal;
  const Eigen::Isometry3d camera_from_world = guess.world_from_camera.inverse();
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < question.sights.size(); ++i) {
    for (const Corner& corner : question.sights[i].corners) {
      const Eigen::Vector3d point =
          moved_point(guess.boards[i], world_point(question, corner.on_board));
      const auto pixel = pixel_of(camera_from_world * point, lens);
      if (!pixel) return std::nullopt;
      out.segment<2>(row) = (*pixel - corner.pixel) / question.pixel_sigma;
      row += 2;
    }
  }
  out[row++] = guess.focal / std::max(question.focal_sigma, kLeastFocalSigma);
  if (question.height)
    out[row] =
        (guess.world_from_camera.translation().y() - *question.height) / question.height_sigma;
  return out;
}

std::optional<Eigen::MatrixXd> derivative(const PlaceQuestion& question, const PlaceGuess& guess,
                                          int count) {
  Eigen::MatrixXd out;
  for (int i = 0; i < count; ++i) {
    Eigen::VectorXd by = Eigen::VectorXd::Zero(count);
    by[i] = kSmall;
    const auto above = residuals_of(question, moved_by(guess, by));
    const auto below = residuals_of(question, moved_by(guess, -by));
    if (!above || !below) return std::nullopt;
    if (i == 0) out.resize(above->size(), count);
    out.col(i) = (*above - *below) / (2.0 * kSmall);
  }
  return out;
}

/// Levenberg's damping, relative to the diagonal, so that a poor guess cannot leap.
bool step(const PlaceQuestion& question, int count, double& damping, PlaceGuess& guess,
          double& squares) {
  const auto residuals = residuals_of(question, guess);
  const auto jacobian = derivative(question, guess, count);
  if (!residuals || !jacobian) return false;
  Eigen::MatrixXd normal = jacobian->transpose() * *jacobian;
  squares = residuals->squaredNorm();
  constexpr int kTries = 8;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::VectorXd by = -damped.ldlt().solve(jacobian->transpose() * *residuals);
    if (!by.allFinite()) return false;
    const PlaceGuess next = moved_by(guess, by);
    const auto after = residuals_of(question, next);
    if (after && after->squaredNorm() <= squares) {
      guess = next;
      damping *= 0.1;
      squares = after->squaredNorm();
      return by.norm() > kConverged;
    }
    damping = std::max(1e-6, 10.0 * damping);
  }
  return false;
}

double corner_error(const PlaceQuestion& question, const Eigen::VectorXd& residuals) {
  double corners = 0.0;
  for (const View& sight : question.sights) corners += static_cast<double>(sight.corners.size());
  const auto rows = static_cast<Eigen::Index>(2.0 * corners);
  return question.pixel_sigma * std::sqrt(residuals.head(rows).squaredNorm() / corners);
}

}  // namespace

Eigen::Vector3d world_point(const PlaceQuestion& question, const Eigen::Vector2d& on_board) {
  if (question.stance == BoardStance::Lies) return {on_board.x(), 0.0, -on_board.y()};
  return {on_board.x(), on_board.y() + question.board_height, 0.0};
}

std::optional<PlaceFit> refine(const PlaceQuestion& question, PlaceGuess guess) {
  int count = 0;
  (void)columns_of(guess, count);
  double damping = 1e-3;
  double squares = 0.0;
  for (int i = 0; i < kSteps && step(question, count, damping, guess, squares); ++i) {
  }
  const auto residuals = residuals_of(question, guess);
  const auto jacobian = derivative(question, guess, count);
  if (!residuals || !jacobian || !residuals->allFinite()) return std::nullopt;
  const Eigen::MatrixXd normal = jacobian->transpose() * *jacobian;
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  const Eigen::MatrixXd covariance = solver.solve(Eigen::MatrixXd::Identity(count, count));
  if (!covariance.allFinite() || !(covariance.diagonal().minCoeff() > 0.0)) return std::nullopt;
  PlaceFit fit{std::move(guess), covariance.topLeftCorner<kCommon, kCommon>(),
               residuals->squaredNorm(), corner_error(question, *residuals), 1.0};
  fit.freedom = std::max(1.0, static_cast<double>(residuals->size() - count));
  return fit;
}

}  // namespace chorus::calibration
