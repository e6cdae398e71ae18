// How much a better body than capsules could gain at most: `outline` on masks of a person who is
// drawn with the method's own capsules (a model that is exactly right), and of the judge's mesh.
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "common/positioning/outline_sight.h"
#include "common/synthetic/walker.h"
#include "tests/bench/positioner/position_errors.h"
#include "tests/bench/positioner/positioner_cases.h"
#include "tests/bench/positioner/rendered_scenes.h"

namespace chorus::bench {
namespace {

const Intrinsics kShapeLens{640, 480, 600.0, 600.0, 319.5, 239.5, {}};
constexpr double kShapeRate = 2.5;  // [Hz]

struct ShapeScene {
  Eigen::Isometry3d camera = looking({0, 2.0, 4.6}, {0, 0.9, 0});
  positioning::SightCamera sight{camera, positioning::sight_lens(kShapeLens),
                                 silhouette::usual_shape(kSceneStature)};
  std::vector<Skeleton<WorldSpace>> bodies = {};
};

/// The person as the method's capsules with this girth.
cv::Mat capsule_mask(const ShapeScene& scene, const Skeleton<WorldSpace>& body, double girth) {
  const auto capsules = silhouette::flat_capsules(
      body, silhouette::usual_shape(kSceneStature, girth), scene.camera, kShapeLens);
  cv::Mat mask = cv::Mat::zeros(kShapeLens.height, kShapeLens.width, CV_8U);
  mask.forEach<std::uint8_t>([&](std::uint8_t& cell, const int* at) {
    for (const auto& capsule : capsules)
      if (silhouette::distance(capsule, {at[1], at[0]}) < 0.0) cell = 255;
  });
  return mask;
}

/// The person as the judge's mesh: what differs from the same picture without them.
cv::Mat mesh_mask(const ShapeScene& scene, const Skeleton<WorldSpace>& body, double girth) {
  const cv::Mat with = picture_of({scene.camera, kShapeLens, {{body, girth, 40}}, {}, {}, 7});
  const cv::Mat without = picture_of({scene.camera, kShapeLens, {}, {}, {}, 7});
  cv::Mat mask;
  cv::absdiff(with, without, mask);
  cv::threshold(mask, mask, 0.0, 255.0, cv::THRESH_BINARY);
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, {7, 7}));
  return mask;
}

using Masked = std::function<cv::Mat(const Skeleton<WorldSpace>&)>;

struct ShapeScores {
  PlaceScores all;
  double bias = 0.0;  ///< Mean along the line of sight, away from the camera [m].
};

ShapeScores shape_scores(const ShapeScene& scene, const suit::SuitTake& suit,
                         const Masked& masked) {
  std::vector<FoundPlace> found;
  std::vector<Eigen::Vector3d> truth;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    cv::Mat small;
    cv::resize(masked(scene.bodies[i]), small, {}, 0.5, 0.5, cv::INTER_AREA);
    cv::threshold(small, small, 127.0, 255.0, cv::THRESH_BINARY);
    const auto sight =
        positioning::outline_sight(scene.sight, silhouette::evidence_of_mask(small, 0.5));
    truth.push_back(scene.bodies[i][JointId::SpineBase].position);
    const Eigen::Vector3d expected = truth.back() + Eigen::Vector3d(0.06, 0.0, -0.08);
    const auto seen = sight->outlined({suit.poses[i], 0.0, expected});
    FoundPlace one;
    if (seen) one = {seen->place, seen->covariance};
    found.push_back(one);
  }
  const Eigen::Vector3d eye = scene.camera.translation();
  ShapeScores out{scores_of(found, truth, eye), 0.0};
  double count = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i].place) continue;
    out.bias += (*found[i].place - truth[i]).dot((truth[i] - eye).normalized());
    count += 1.0;
  }
  out.bias /= std::max(1.0, count);
  return out;
}

/// The judge's person and the outline of the method's, side by side for four pictures.
void draw_shapes(const ShapeScene& scene, const std::string& file) {
  cv::Mat row;
  for (std::size_t i = 0; i < scene.bodies.size();
       i += std::max<std::size_t>(1, scene.bodies.size() / 4)) {
    cv::Mat drawn;
    cv::cvtColor(mesh_mask(scene, scene.bodies[i], 1.0) / 3, drawn, cv::COLOR_GRAY2BGR);
    const auto capsules =
        silhouette::flat_capsules(scene.bodies[i], scene.sight.shape, scene.camera, kShapeLens);
    for (const auto& point : silhouette::outline_of(capsules, 2.0))
      cv::circle(drawn, {static_cast<int>(point.pixel.x()), static_cast<int>(point.pixel.y())}, 1,
                 cv::Scalar(80, 255, 80), cv::FILLED);
    if (row.empty())
      row = drawn;
    else
      cv::hconcat(row, drawn, row);
  }
  cv::imwrite(file, row);
}

}  // namespace

Result<void> shape_gain(Report& report) {
  ShapeScene scene;
  const synthetic::Walker walker({.seed = report.seed() + 2, .reach = 1.4});
  for (int i = 0; i < (report.quick() ? 6 : 80); ++i)
    scene.bodies.push_back(walker.at(from_seconds(10.0 + i / kShapeRate)));
  if (!report.plots().empty()) draw_shapes(scene, report.plots() + "/body-shape.png");
  const std::vector<std::pair<std::string, Masked>> bodies{
      {"own-capsules", [&](const auto& body) { return capsule_mask(scene, body, 1.0); }},
      {"capsules-8%-wider", [&](const auto& body) { return capsule_mask(scene, body, 1.08); }},
      {"mesh", [&](const auto& body) { return mesh_mask(scene, body, 1.0); }},
      {"mesh-8%-wider", [&](const auto& body) { return mesh_mask(scene, body, 1.08); }}};
  for (const double degrees : {0.0, 2.0}) {
    const suit::SuitTake suit =
        suit_of(scene.bodies, kShapeRate, {.bone = degrees * 0.01745, .memory = 4.0});
    for (const auto& [name, masked] : bodies) {
      const std::string row = "shape/" + name + (degrees > 0.0 ? "/pose-2deg" : "/pose-right");
      const auto [scores, bias] = shape_scores(scene, suit, masked);
      report.row(row, "bias_mm", 1e3 * bias, "mm");
      report.row(row, "rms_mm", 1e3 * scores.rms, "mm");
      report.row(row, "along_mm", 1e3 * scores.rms_along, "mm");
      report.row(row, "across_mm", 1e3 * scores.rms_across, "mm");
      report.row(row, "answered_percent", 100.0 * scores.answered, "%");
    }
  }
  return {};
}

}  // namespace chorus::bench
