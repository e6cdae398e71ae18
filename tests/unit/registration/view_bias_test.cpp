#include "fusion-server/registration/view_bias.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"

namespace chorus::registration {
namespace {

constexpr double kRatio = 2.0;
constexpr double kSigma = 0.003;  // [m] of a coefficient

/// Two sensors at a right angle that see one point without error.
struct BiasScene {
  std::vector<Eigen::Isometry3d> places;
  PointMeasurements seen;
  Eigen::Vector3d x;

  explicit BiasScene(const Eigen::Vector3d& point = {0.2, 1.3, 0.1}) : x(point) {
    for (const double yaw : {0.0, deg(90)}) {
      Eigen::Isometry3d place(about_y(yaw));
      place.translation() = place.linear() * Eigen::Vector3d(0, 1.6, -3);
      const Eigen::Vector3d own = place.inverse() * x;
      seen.push_back({places.size(), own, own.normalized(), 0.01, 1.0, own.normalized()});
      places.push_back(place);
    }
  }
  [[nodiscard]] Eigen::Matrix3d axes(std::size_t sensor) const {
    Eigen::Vector3d view = x - places[sensor].translation();
    view.y() = 0.0;
    Eigen::Matrix3d axes;
    axes.col(0) = view.normalized();
    axes.col(1) = Eigen::Vector3d::UnitY().cross(axes.col(0));
    axes.col(2) = Eigen::Vector3d::UnitY();
    return axes;
  }
  /// The score if what one sensor sees is moved by `off` (world).
  [[nodiscard]] Eigen::VectorXd score(std::size_t sensor, const Eigen::Vector3d& off) const {
    PointMeasurements wrong = seen;
    wrong[sensor].x += places[sensor].linear().transpose() * off;
    PlaceEquations equations{Eigen::MatrixXd::Zero(13, 13), Eigen::VectorXd::Zero(13)};
    add_point(equations, wrong, fuse_point(wrong, places, kRatio), 1.0);
    return equations.right;
  }
  [[nodiscard]] Eigen::MatrixXd scores(const std::optional<Eigen::Vector3d>& walking) const {
    ViewBias bias({places[0].translation(), places[1].translation()}, mm(3.0));
    bias.add(seen, fuse_point(seen, places, kRatio), 1.0, x, walking);
    return bias.scores();
  }
};

TEST(ViewBias, IsWhatDisplacedSightsDoToTheScores) {
  const BiasScene scene;
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(13, 13);
  for (std::size_t sensor = 0; sensor < 2; ++sensor) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd score =
          scene.score(sensor, kStep * scene.axes(sensor).col(axis)) / kStep;
      expected += kSigma * kSigma * score * score.transpose();
    }
  }
  const Eigen::MatrixXd found = scene.scores(std::nullopt);
  EXPECT_LT((found - expected).norm(), 1e-4 * expected.norm());
}

/// The five terms are a constant and the cosine and sine of two harmonics.  Each harmonic counts
/// once, because cos^2 + sin^2 = 1, so a point counts three times, whichever way the person walks.
TEST(ViewBias, KnowsFiveTermsWhereTheWayIsKnown) {
  const BiasScene scene;
  const Eigen::MatrixXd constant = scene.scores(std::nullopt);
  for (const Eigen::Vector3d& way : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.3, 0, -0.8)})
    EXPECT_LT((scene.scores(way) - 3.0 * constant).norm(), 1e-9 * constant.norm());
}

TEST(ViewBias, CancelsInPartWhereThePersonTurnsAround) {
  const BiasScene scene;
  ViewBias bias({scene.places[0].translation(), scene.places[1].translation()}, mm(3.0));
  const FusedPoint fused = fuse_point(scene.seen, scene.places, kRatio);
  bias.add(scene.seen, fused, 1.0, scene.x, Eigen::Vector3d(0, 0, 1));
  bias.add(scene.seen, fused, 1.0, scene.x, Eigen::Vector3d(0, 0, -1));
  // The first harmonic cancels out.  The constant and the second harmonic add up over both calls,
  // which gives 2^2 = 4 for each: 4 (1 + 1) instead of 4 (1 + 2).
  const Eigen::MatrixXd constant = scene.scores(std::nullopt);
  EXPECT_LT((bias.scores() - 8.0 * constant).norm(), 1e-9 * constant.norm());
}

/// On the circle through both sensors and about the origin, both views turn by half of the angle by
/// which the point moves.  If the way turns with them, the biases stay as they are.
TEST(ViewBias, AddsUpWhereTheWayTurnsWithTheViews) {
  const auto on_circle = [](double yaw) {
    return BiasScene(about_y(yaw) * Eigen::Vector3d(0, 1.3, 3));
  };
  const BiasScene first = on_circle(0.0);
  const BiasScene second = on_circle(deg(60));
  const auto scores_of = [&](const std::optional<Eigen::Vector3d>& way,
                             const std::optional<Eigen::Vector3d>& turned) {
    ViewBias bias({first.places[0].translation(), first.places[1].translation()}, mm(3.0));
    bias.add(first.seen, fuse_point(first.seen, first.places, kRatio), 1.0, first.x, way);
    bias.add(second.seen, fuse_point(second.seen, second.places, kRatio), 1.0, second.x, turned);
    return bias.scores();
  };
  const Eigen::Vector3d way(0.6, 0, -0.8);
  const Eigen::MatrixXd constant = scores_of(std::nullopt, std::nullopt);
  const Eigen::MatrixXd turning = scores_of(way, about_y(deg(30)) * way);
  EXPECT_LT((turning - 3.0 * constant).norm(), 1e-9 * constant.norm());
  EXPECT_GT((scores_of(way, way) - 3.0 * constant).norm(), 0.01 * constant.norm());
}

}  // namespace
}  // namespace chorus::registration
