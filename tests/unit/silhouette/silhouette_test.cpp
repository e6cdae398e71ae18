#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "common/sensor/pixel_ray.h"
#include "common/silhouette/floor_search.h"
#include "common/silhouette/outline_fit.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::silhouette {
namespace {

const Intrinsics kCamera{640, 480, 600.0, 600.0, 319.5, 239.5, {}};

Eigen::Isometry3d camera_at(const Eigen::Vector3d& place, const Eigen::Vector3d& at) {
  const Eigen::Vector3d z = (at - place).normalized();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitY().cross(z).normalized();
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() << x, z.cross(x), z;
  out.translation() = place;
  return out;
}

const Eigen::Isometry3d kPlace = camera_at({0.0, 2.0, 4.5}, {0.0, 0.9, 0.0});

/// A picture of a person: grey in grey, with noise.  The judge's body is a tenth thinner than ours,
/// and drawn pixel by pixel.
cv::Mat picture_of(const Skeleton<WorldSpace>* body, std::uint64_t seed) {
  cv::Mat picture(kCamera.height, kCamera.width, CV_8U, cv::Scalar(120));
  for (int i = 0; i < 12; ++i)
    cv::rectangle(picture, {37 * i + 20, 29 * i, 30, 60}, cv::Scalar(60 + 11 * i), cv::FILLED);
  if (body != nullptr) {
    const auto shape = usual_shape(1.75, 0.9);
    const auto capsules = flat_capsules(*body, shape, kPlace, kCamera);
    for (int row = 0; row < picture.rows; ++row) {
      for (int column = 0; column < picture.cols; ++column) {
        for (const FlatCapsule& capsule : capsules) {
          if (distance(capsule, {column, row}) < 0.0) picture.at<std::uint8_t>(row, column) = 20;
        }
      }
    }
  }
  cv::RNG random(seed);
  cv::Mat noise(picture.size(), CV_8S);
  random.fill(noise, cv::RNG::NORMAL, 0, 4);
  cv::add(picture, noise, picture, cv::noArray(), CV_8U);
  return picture;
}

Background empty_room() {
  Background background;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) background.learn(picture_of(nullptr, seed));
  return background;
}

struct Scene {
  Skeleton<WorldSpace> truth = chorus::testing::t_pose_person({0.2, 0.0, 0.1});
  std::vector<ShapedBone> shape = usual_shape(1.75);
  Background background = empty_room();
  EvidenceSource source = background.evidence(picture_of(&truth, 99)).value();
  std::optional<Evidence> evidence = source.whole();

  [[nodiscard]] Skeleton<WorldSpace> off_by(const Eigen::Vector3d& by) const {
    Skeleton<WorldSpace> body = truth;
    for (Joint& joint : body.joints) joint.position += by;
    return body;
  }
};

SearchView view_of(const Scene& scene, const Skeleton<WorldSpace>& body) {
  return {body, scene.shape, kPlace, kCamera, *scene.evidence};
}

TEST(BodyShape, PointsOfTheOutlineAreOnItAndNoneIsInside) {
  const Scene scene;
  const auto capsules = flat_capsules(scene.truth, scene.shape, kPlace, kCamera);
  const auto outline = outline_of(capsules, 4.0);
  ASSERT_GT(outline.size(), 100u);
  for (const OutlinePoint& point : outline) {
    double nearest = 1e9;
    for (const FlatCapsule& capsule : capsules)
      nearest = std::min(nearest, distance(capsule, point.pixel));
    EXPECT_NEAR(nearest, 0.0, 0.6);
    double beyond = 1e9;
    for (const FlatCapsule& capsule : capsules)
      beyond = std::min(beyond, distance(capsule, point.pixel - 3.0 * point.normal));
    EXPECT_LT(beyond, 0.0) << "normals point outwards";
  }
}

TEST(BodyShape, BehindTheCameraThereIsNothing) {
  const Scene scene;
  EXPECT_TRUE(flat_capsules(scene.off_by({0, 0, 20.0}), scene.shape, kPlace, kCamera).empty());
  EXPECT_TRUE(outline_of({}, 4.0).empty());
}

TEST(BodyShape, ABoneNearTheLensPlaneHasBoundedlyManyPoints) {
  FlatCapsule bone{{0.0, 0.0}, {1e9, 3e8}, 1e6, 2e8, 1e-6, 1.0};
  EXPECT_LE(outline_of(std::span(&bone, 1), 0.5).size(), 4000u);
  bone.b = bone.a;
  EXPECT_LE(outline_of(std::span(&bone, 1), 0.5).size(), 4000u);
}

TEST(Evidence, IsZeroOnTheOutlineAndFarthestAwayFromIt) {
  Scene scene;
  ASSERT_TRUE(scene.evidence);
  EXPECT_NEAR(scene.evidence->distance({5.0, 470.0}), scene.evidence->farthest(), 1e-9);
  EXPECT_NEAR(scene.evidence->distance({-1e9, std::nan("")}), scene.evidence->farthest(), 1e-9);
  const auto outline =
      outline_of(flat_capsules(scene.truth, usual_shape(1.75, 0.9), kPlace, kCamera), 4.0);
  double sum = 0.0;
  for (const OutlinePoint& point : outline) sum += scene.evidence->distance(point.pixel);
  // The field is half as large, and noise is opened away: corners are round by some pixels.
  EXPECT_LT(sum / static_cast<double>(outline.size()), 6.0);
}

TEST(Evidence, IsTheSameWithAnyNumberOfThreads) {
  const Scene scene;
  const cv::Mat picture = picture_of(&scene.truth, 5);
  const auto field_with = [&](int threads) {
    cv::setNumThreads(threads);
    Background background = empty_room();
    return background.evidence(picture)->whole().field().clone();
  };
  const cv::Mat one = field_with(1);
  for (const int threads : {2, 3, 8})
    EXPECT_EQ(cv::norm(one, field_with(threads), cv::NORM_INF), 0.0) << threads;
}

TEST(Evidence, NeedsABackgroundOfItsSize) {
  Background background;
  EXPECT_FALSE(background.evidence(picture_of(nullptr, 1)));
  background.learn(picture_of(nullptr, 1));
  EXPECT_FALSE(background.evidence(cv::Mat::zeros(20, 20, CV_8U)));
  EXPECT_FALSE(background.evidence({}));
}

TEST(Evidence, FromMixturesLeavesShadowsOut) {
  EvidenceSettings settings;
  settings.model = BackgroundModel::Mixtures;
  Background background(settings);
  EXPECT_FALSE(background.evidence(picture_of(nullptr, 1)));
  for (std::uint64_t seed = 1; seed <= 40; ++seed) background.learn(picture_of(nullptr, seed));
  const Scene scene;
  cv::Mat picture = picture_of(&scene.truth, 50);
  cv::Mat shaded = picture(cv::Rect(20, 380, 120, 80));
  shaded *= 0.7;  // A shadow on the floor.
  const auto source = background.evidence(picture);
  ASSERT_TRUE(source);
  const std::optional evidence = source->whole();
  EXPECT_FALSE(evidence->is_foreground({80, 420}));
  const Eigen::Vector3d chest = scene.truth[JointId::SpineMid].position;
  const auto pixel = pixel_of(camera_from_sensor_axes() * (kPlace.inverse() * chest), kCamera);
  ASSERT_TRUE(pixel);
  EXPECT_TRUE(evidence->is_foreground(*pixel));
}

TEST(Evidence, WithAThresholdOfTheSurroundingsStandsAChangeOfLightOnOneSide) {
  EvidenceSettings settings;
  settings.surroundings = 201;
  Background near(settings);
  Background far;
  for (std::uint64_t seed = 1; seed <= 9; ++seed) {
    near.learn(picture_of(nullptr, seed));
    far.learn(picture_of(nullptr, seed));
  }
  cv::Mat picture = picture_of(nullptr, 20);
  cv::Mat lit = picture(cv::Rect(0, 0, 200, 480));
  lit += cv::Scalar(30);  // A lamp lights a third of the room.
  EXPECT_LT(near.evidence(picture)->whole().foreground(),
            0.4 * far.evidence(picture)->whole().foreground());
}

TEST(Evidence, OfAMaskIsThatMask) {
  cv::Mat mask = cv::Mat::zeros(90, 160, CV_8U);
  cv::rectangle(mask, {40, 20, 30, 50}, cv::Scalar(255), cv::FILLED);
  const Evidence evidence = evidence_of_mask(mask, 0.25).whole();
  EXPECT_TRUE(evidence.is_foreground({4.0 * 55, 4.0 * 45}));
  EXPECT_FALSE(evidence.is_foreground({4.0 * 20, 4.0 * 45}));
  EXPECT_LT(evidence.distance({4.0 * 40, 4.0 * 45}), 6.0);
  EXPECT_NEAR(evidence.foreground(), 1500.0 / (90 * 160), 1e-9);
}

TEST(Evidence, OfARegionIsThatOfTheWholePicture) {
  const Scene scene;
  const auto same = [&](const EvidenceSource& source, const Region& region) {
    const Evidence whole = source.whole();
    const Evidence part = source.within(region);
    for (double y = region.min().y(); y <= region.max().y(); y += 3.7) {
      for (double x = region.min().x(); x <= region.max().x(); x += 3.7) {
        ASSERT_NEAR(part.distance({x, y}), whole.distance({x, y}), 1e-6) << x << ' ' << y;
        ASSERT_EQ(part.is_foreground({x, y}), whole.is_foreground({x, y})) << x << ' ' << y;
      }
    }
    EXPECT_LT(part.field().total(), whole.field().total());
  };
  EvidenceSettings adapting;
  adapting.surroundings = 51;
  Background room(adapting);
  for (std::uint64_t seed = 1; seed <= 9; ++seed) room.learn(picture_of(nullptr, seed));
  for (const Region& region : {Region(Eigen::Vector2d(300, 150), Eigen::Vector2d(420, 300)),
                               Region(Eigen::Vector2d(-50, -80), Eigen::Vector2d(200, 500)),
                               Region(Eigen::Vector2d(500, 300), Eigen::Vector2d(5000, 460))}) {
    same(scene.source, region);
    same(room.evidence(picture_of(&scene.truth, 99)).value(), region);
  }
}

TEST(Evidence, OfNoRegionIsThatOfTheWholePicture) {
  const Scene scene;
  const double all = static_cast<double>(scene.evidence->field().total());
  const double nan = std::nan("");
  for (const Region& region :
       {Region(), Region(Eigen::Vector2d(9000, 10), Eigen::Vector2d(9100, 20)),
        Region(Eigen::Vector2d(nan, 10), Eigen::Vector2d(90, 20))})
    EXPECT_EQ(static_cast<double>(scene.source.within(region).field().total()), all);
}

TEST(Search, IsTheSameInItsRegion) {
  const Scene scene;
  const auto body = scene.off_by({0.2, 0.0, 0.1});
  const auto region = region_around(view_of(scene, body), 0.3);
  ASSERT_TRUE(region);
  const Evidence part = scene.source.within(*region);
  ASSERT_LT(part.field().total(), 4 * scene.evidence->field().total() / 5);
  const auto there = search({body, scene.shape, kPlace, kCamera, part});
  const auto whole = search(view_of(scene, body));
  ASSERT_TRUE(there && whole);
  EXPECT_EQ(there->shift, whole->shift);
  EXPECT_NEAR(there->energy, whole->energy, 1e-6);
  EXPECT_EQ(there->ambiguous, whole->ambiguous);
  EXPECT_FALSE(region_around(view_of(scene, scene.off_by({0.0, 0.0, 4.4})), 0.3));
}

TEST(Background, KeepsPicturesSpreadOverAllThatItSaw) {
  // Dark for 100 pictures, light for 130: the median of all is light, that of the first 64 dark.
  Background background({.scale = 1.0});
  for (int i = 0; i < 230; ++i)
    background.learn(cv::Mat(8, 8, CV_8U, cv::Scalar(i < 100 ? 50 : 200)));
  cv::Mat light(8, 8, CV_8U, cv::Scalar(200));
  EXPECT_EQ(background.evidence(light)->whole().foreground(), 0.0);
  EXPECT_EQ(background.learned(), 230u);
}

TEST(Search, FindsTheShiftAmongTheTwentyFive) {
  const Scene scene;
  const auto body = scene.off_by({0.2, 0.0, 0.0});
  const auto found = search(view_of(scene, body));
  ASSERT_TRUE(found);
  EXPECT_THAT(found->shift, chorus::testing::VectorNear(Eigen::Vector3d(-0.2, 0, 0), 0.11));
}

TEST(Search, OfAPersonOutsideThePictureFindsNothing) {
  const Scene scene;
  const auto body = scene.off_by({0.0, 0.0, 20.0});
  EXPECT_FALSE(search(view_of(scene, body)));
}

TEST(OutlineFit, IsFinerThanTheSearch) {
  const Scene scene;
  double ours = 0.0;
  double theirs = 0.0;
  for (const Eigen::Vector3d& off :
       {Eigen::Vector3d(0.07, 0, 0.04), Eigen::Vector3d(-0.06, 0, 0.13),
        Eigen::Vector3d(0.04, 0, -0.16), Eigen::Vector3d(-0.14, 0, -0.05)}) {
    const auto body = scene.off_by(off);
    const auto fit = fit_outline(view_of(scene, body));
    const auto searched = search(view_of(scene, body));
    ASSERT_TRUE(fit && searched);
    ours += (fit->shift + off).squaredNorm();
    theirs += (searched->shift + off).squaredNorm();
    EXPECT_LT((fit->shift + off).norm(), 0.08);
  }
  EXPECT_LT(std::sqrt(ours), std::sqrt(theirs));
}

TEST(OutlineFit, RecoversFromHalfAMetre) {
  const Scene scene;
  const auto body = scene.off_by({0.45, 0, 0.2});
  const auto fit = fit_outline(view_of(scene, body));
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->shift + Eigen::Vector3d(0.45, 0, 0.2)).norm(), 0.1);
}

TEST(FloorSearch, FindsThePersonWithoutAStart) {
  const Scene scene;
  const auto body = scene.off_by({3.0, 0, -2.5});
  const auto fit = find_on_floor(view_of(scene, body));
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->shift + Eigen::Vector3d(3.0, 0, -2.5)).norm(), 0.12);
}

TEST(FloorSearch, WhereNobodyIsFindsNobody) {
  Scene scene;
  scene.evidence = scene.background.evidence(picture_of(nullptr, 77)).value().whole();
  EXPECT_FALSE(find_on_floor(view_of(scene, scene.truth)));
}

TEST(OutlineFit, WhereNobodyIsAnswersNothing) {
  Scene scene;
  scene.evidence = scene.background.evidence(picture_of(nullptr, 77)).value().whole();
  ASSERT_TRUE(scene.evidence);
  EXPECT_FALSE(fit_outline(view_of(scene, scene.truth)));
}

}  // namespace
}  // namespace chorus::silhouette
