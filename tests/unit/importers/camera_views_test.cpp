#include "common/importers/camera_views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/importers/formats.h"
#include "tests/support/matchers.h"
#include "tests/unit/importers/import_files.h"

namespace chorus::importers {
namespace {

using testing::FailsWith;
using ::testing::HasSubstr;
using testing::IsOk;

const std::filesystem::path kFolder = kShippedRecordings / "pose2sim_mediapipe";

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Distance of each joint from the truth, and its part across the sensor's line of sight [m].
struct Errors {
  std::vector<double> whole;
  std::vector<double> across;
};

Errors errors_of(const record::FrameRecording& view, const Eigen::Isometry3d& world_from_sensor,
                 const std::vector<TruthFrame>& truth) {
  Errors errors;
  for (std::size_t i = 0; i < view.frames.size(); ++i) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Vector3d x = view.frames[i].bodies.at(0).skeleton.joints[j].position;
      const Eigen::Vector3d wanted =
          world_from_sensor.inverse() * truth[i].skeleton.joints[j].position;
      const Eigen::Vector3d off = x - wanted;
      errors.whole.push_back(off.norm());
      errors.across.push_back((off - wanted.normalized() * off.dot(wanted.normalized())).norm());
    }
  }
  return errors;
}

TEST(CameraViews, ImportTheShippedFolderInStep) {
  const auto set = import_files(FileFormat::Pose2Sim, {kFolder});
  ASSERT_THAT(set, IsOk());
  ASSERT_EQ(set->recordings.size(), 4u);
  EXPECT_EQ(set->truth.size(), 100u);
  for (const auto& view : set->recordings) {
    EXPECT_EQ(view.frames.size(), 100u);
    EXPECT_EQ(view.frames.front().captured, kDefaultStart);
    EXPECT_EQ(view.frames[30].captured, kDefaultStart + std::chrono::milliseconds(500));
    EXPECT_EQ(view.notes.at("set_origin"), "2020-01-01T00:00:00.000000000Z");
    EXPECT_NEAR(std::stod(view.notes.at("set_period_ns")), 100e9 / 60, 1e3);
    EXPECT_EQ(view.intrinsics->width, 1080);
  }
}

/// The ceilings are the committed results of tests/bench/accuracy/real_bench.cpp plus ten percent.
TEST(CameraViews, LieNearTheTriangulationAndBestAcrossTheLineOfSight) {
  const auto set = import_files(FileFormat::Pose2Sim, {kFolder});
  ASSERT_THAT(set, IsOk());
  const double ceilings[] = {0.125, 0.21, 0.25, 0.17};
  for (std::size_t c = 0; c < 4; ++c) {
    const auto& view = set->recordings[c];
    const Errors errors = errors_of(view, set->world_from_sensor.at(view.sensor), set->truth);
    EXPECT_LT(median(errors.whole), ceilings[c]) << view.sensor.str();
    EXPECT_LT(median(errors.across), 0.04) << view.sensor.str();
  }
}

TEST(CameraViews, PixelRaysBeatTheRigidBodyAcrossTheLineOfSight) {
  const auto cameras = read_cameras(kFolder / "cameras.json");
  const auto truth = read_triangulation(kFolder / "triangulated.json");
  ASSERT_THAT(cameras, IsOk());
  ASSERT_THAT(truth, IsOk());
  for (const CalibratedCamera& camera : *cameras) {
    const auto file = kFolder / (camera.sensor.str() + ".json");
    const auto on_rays = read_camera_view(file, *cameras);
    const auto rigid = read_camera_view(file, *cameras, {}, Lateral::RigidBody);
    ASSERT_THAT(on_rays, IsOk());
    ASSERT_THAT(rigid, IsOk());
    const auto& pose = camera.world_from_sensor;
    EXPECT_LT(median(errors_of(*on_rays, pose, *truth).across),
              median(errors_of(*rigid, pose, *truth).across));
  }
}

TEST(CameraViews, AsRaysPointAtTheTriangulation) {
  ImportOptions options;
  options.rays = true;
  const auto set = import_files(FileFormat::Pose2Sim, {kFolder}, options);
  ASSERT_THAT(set, IsOk());
  for (const auto& view : set->recordings) {
    const Eigen::Isometry3d sensor_from_world = set->world_from_sensor.at(view.sensor).inverse();
    std::vector<double> across;
    for (std::size_t i = 0; i < view.frames.size(); ++i) {
      for (std::size_t j = 0; j < kJointCount; ++j) {
        const Joint& joint = view.frames[i].bodies.at(0).skeleton.joints[j];
        ASSERT_TRUE(joint.bears());
        const Eigen::Vector3d wanted =
            sensor_from_world * set->truth[i].skeleton.joints[j].position;
        across.push_back((wanted - joint.position * joint.position.dot(wanted)).norm());
      }
    }
    EXPECT_LT(median(across), 0.04) << view.sensor.str();
  }
}

/// A triangulation in which one camera exchanges left and right lies between both sides: hips of
/// half their width, thighs that change.
TEST(CameraViews, ComeWithATriangulationWhoseBonesDoNotChange) {
  const auto truth = read_triangulation(kFolder / "triangulated.json");
  ASSERT_THAT(truth, IsOk());
  constexpr std::array kBones{std::pair{JointId::HipLeft, JointId::HipRight},
                              std::pair{JointId::ShoulderLeft, JointId::ShoulderRight},
                              std::pair{JointId::HipLeft, JointId::KneeLeft},
                              std::pair{JointId::HipRight, JointId::KneeRight}};
  for (const auto& [from, to] : kBones) {
    std::vector<double> lengths;
    for (const TruthFrame& frame : *truth)
      lengths.push_back((frame.skeleton[from].position - frame.skeleton[to].position).norm());
    const double usual = median(lengths);
    for (std::size_t i = 0; i < lengths.size(); ++i)
      EXPECT_NEAR(lengths[i], usual, 0.13 * usual) << name_of(from) << " frame " << i;
  }
}

/// Our axes: x to the sensor's left, y up, z forward.  All four cameras are upright and above the
/// floor.
TEST(CameraViews, SpeakOurAxes) {
  const auto set = import_files(FileFormat::Pose2Sim, {kFolder});
  ASSERT_THAT(set, IsOk());
  for (const auto& view : set->recordings) {
    const Eigen::Isometry3d pose = set->world_from_sensor.at(view.sensor);
    EXPECT_NEAR(pose.linear().determinant(), 1.0, 1e-9);
    EXPECT_GT(pose.linear()(1, 1), 0.8) << "the sensor's up is the world's up";
    EXPECT_GT(pose.translation().y(), 0.5);
    EXPECT_LT(pose.translation().y(), 3.0);
    const auto& body = view.frames[0].bodies.at(0).skeleton;
    EXPECT_GT(body[JointId::Head].position.y(), body[JointId::SpineBase].position.y() + 0.4);
    EXPECT_GT(body[JointId::SpineBase].position.z(), 2.0);
    const Joint& hip = body[JointId::SpineBase];
    const Eigen::Vector3d ray = hip.position.normalized();
    ASSERT_TRUE(hip.covariance.known());
    EXPECT_GT(ray.dot(hip.covariance.matrix() * ray), 0.01) << "a decimetre along the ray";
  }
  const auto& truth = set->truth[0].skeleton;
  EXPECT_NEAR(truth[JointId::Head].position.y(), 1.55, 0.05);
  EXPECT_LT(truth[JointId::FootRight].position.y(), 0.2);
}

/// A synthetic body seen by a synthetic camera is recovered exactly, distortion included.
TEST(LandmarkFit, RecoversAKnownPose) {
  Intrinsics camera;
  camera.fx = camera.fy = 900.0;
  camera.cx = 640.0;
  camera.cy = 360.0;
  DetectedLandmarks detected;
  const Eigen::Isometry3d camera_from_body =
      Eigen::Translation3d(0.4, -0.2, 3.1) *
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.2, 1.0, 0.1).normalized());
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const double t = static_cast<double>(i);
    detected.in_body[i] = {0.3 * std::sin(t), 0.8 * std::cos(1.7 * t), 0.25 * std::sin(2.3 * t)};
    const Eigen::Vector3d x = camera_from_body * detected.in_body[i];
    detected.pixel[i] = {camera.fx * x.x() / x.z() + camera.cx,
                         camera.fy * x.y() / x.z() + camera.cy};
    detected.visibility[i] = i == 16 ? 0.3 : 0.9;
  }
  for (const Lateral lateral : {Lateral::PixelRay, Lateral::RigidBody}) {
    const auto landmarks = fit_landmarks(detected, camera, lateral);
    ASSERT_THAT(landmarks, IsOk());
    for (std::size_t i = 0; i < kLandmarkCount; ++i) {
      const Eigen::Vector3d x = camera_from_body * detected.in_body[i];
      EXPECT_THAT((*landmarks)[i].position,
                  testing::VectorNear(Eigen::Vector3d(-x.x(), -x.y(), x.z()), 1e-4));
    }
    EXPECT_EQ((*landmarks)[16].state, JointState::Inferred);
    EXPECT_EQ((*landmarks)[15].state, JointState::Tracked);
  }
}

/// The detector's body looks straight ahead; the pixels show a head that is turned on it.
TEST(LandmarkFit, TakesTheHeadsTurnFromThePixelsOfTheFace) {
  Intrinsics camera;
  camera.fx = camera.fy = 900.0;
  camera.cx = 640.0;
  camera.cy = 360.0;
  // A larger face than most, in the detector's axes: x to its left, y down, z behind it.
  const std::array<Eigen::Vector3d, 11> face{{{0, 0.014, -0.025},
                                              {0.0145, -0.015, -0.0105},
                                              {0.0235, -0.015, -0.007},
                                              {0.0335, -0.016, -0.0025},
                                              {-0.0145, -0.015, -0.0105},
                                              {-0.0235, -0.015, -0.007},
                                              {-0.0335, -0.016, -0.0025},
                                              {0.049, -0.005, 0.039},
                                              {-0.049, -0.005, 0.039},
                                              {0.016, 0.0435, -0.007},
                                              {-0.016, 0.0435, -0.007}}};
  const Eigen::Vector3d middle(0, -0.62, 0);
  for (const double turned : {-50.0, 0.0, 50.0}) {
    DetectedLandmarks detected;
    for (std::size_t i = 0; i < kLandmarkCount; ++i) {
      const double t = static_cast<double>(i);
      detected.in_body[i] = i < face.size()
                                ? Eigen::Vector3d(1.2 * face[i] + middle)
                                : Eigen::Vector3d(0.3 * std::sin(t), 0.5 + 0.4 * std::cos(1.7 * t),
                                                  0.1 * std::sin(2.3 * t));
      Eigen::Vector3d x = detected.in_body[i];
      if (i < face.size())
        x = middle + Eigen::AngleAxisd(deg(turned), Eigen::Vector3d::UnitY()) * (x - middle);
      x += Eigen::Vector3d(0, 0, 3);
      detected.pixel[i] = {camera.fx * x.x() / x.z() + camera.cx,
                           camera.fy * x.y() / x.z() + camera.cy};
      detected.visibility[i] = 0.9;
    }
    const auto head = fit_head(detected, camera);
    ASSERT_TRUE(head);
    const Eigen::Vector3d looks = *head * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(std::atan2(looks.x(), -looks.z()), deg(turned), deg(3));
  }
}

TEST(LandmarkFit, DepthIsWorseThanDirection) {
  Joint joint;
  joint.position = {0.0, 0.0, 4.0};
  EXPECT_FALSE(fit_error(joint).known()) << "not seen";
  joint.state = JointState::Tracked;
  const Eigen::Matrix3d straight = fit_error(joint).matrix();
  EXPECT_NEAR(std::sqrt(straight(0, 0)), 0.025, 1e-6);
  EXPECT_NEAR(std::sqrt(straight(2, 2)), std::hypot(0.24, 0.025), 1e-6);
  joint.position = {4.0, 0.0, 0.0};
  joint.state = JointState::Inferred;
  const Eigen::Matrix3d aside = fit_error(joint).matrix();
  EXPECT_NEAR(std::sqrt(aside(0, 0)), 2.0 * std::hypot(0.24, 0.025), 1e-6);
  EXPECT_NEAR(std::sqrt(aside(2, 2)), 0.05, 1e-6);
}

TEST(LandmarkFit, RefusesSightsThatFitNoBody) {
  DetectedLandmarks detected;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    detected.in_body[i].setZero();
    detected.pixel[i].setConstant(100.0);
  }
  EXPECT_FALSE(fit_landmarks(detected, Intrinsics{}).has_value());
  for (auto& pixel : detected.pixel) pixel.setConstant(std::nan(""));
  EXPECT_FALSE(fit_landmarks(detected, Intrinsics{}).has_value());
  EXPECT_FALSE(fit_head(detected, Intrinsics{}).has_value());
}

TEST(CameraViews, RefuseBadCalibrations) {
  const TemporaryFolder folder;
  const auto good = nlohmann::json::parse(bytes_of(kFolder / "cameras.json"));
  const auto refused = [&](auto change, const char* says) {
    nlohmann::json cameras = good;
    change(cameras);
    const auto read = read_cameras(folder.write("cameras.json", cameras.dump()));
    ASSERT_THAT(read, FailsWith(ErrorCode::Malformed)) << says;
    EXPECT_THAT(to_string(read.error()), HasSubstr(says));
  };
  refused([](auto& c) { c[1]["camera_from_world"]["R"][0][0] = 0.9; }, "[1].R: is not a rotation");
  refused([](auto& c) { c[1]["camera"] = "cam01"; }, "a second time");
  refused([](auto& c) { c[2].erase("K"); }, "[2]: has no \"K\"");
  refused([](auto& c) { c[0]["K"][0][0] = -1.0; }, "focal lengths");
  refused([](auto& c) { c[0]["width"] = "wide"; }, "not a number");
  refused([](auto& c) { c = nlohmann::json::array(); }, "array of 1 to 64");
  refused([](auto& c) { c = nlohmann::json::object(); }, "array of 1 to 64");
}

TEST(CameraViews, RefuseBadLandmarksAndMissingFiles) {
  const TemporaryFolder folder;
  const auto cameras = read_cameras(kFolder / "cameras.json").value();
  const auto good = nlohmann::json::parse(bytes_of(kFolder / "cam01.json"));
  const auto refused = [&](auto change, const char* says) {
    nlohmann::json view = good;
    change(view);
    const auto read = read_camera_view(folder.write("cam01.json", view.dump()), cameras);
    ASSERT_FALSE(read.has_value()) << says;
    EXPECT_THAT(to_string(read.error()), HasSubstr(says));
  };
  refused([](auto& v) { v["camera"] = "cam09"; }, "no camera \"cam09\"");
  refused([](auto& v) { v["fps"] = 0; }, "\"fps\" must be");
  refused([](auto& v) { v["frames"][3]["t_s"] = 0.0; }, "frames[3]: \"t_s\" must grow");
  refused([](auto& v) { v["frames"][2]["t_s"] = -1.0; }, "frames[2]: \"t_s\"");
  refused([](auto& v) { v["frames"][5]["image"].erase(0); }, "frames[5].image: must hold 33");
  refused([](auto& v) { v["frames"][5]["world"][7][1] = nullptr; }, "frames[5].world[7]: value 2");
  EXPECT_THAT(import_files(FileFormat::Pose2Sim, {folder.path()}), FailsWith(ErrorCode::NotFound));
  const auto file = import_files(FileFormat::Pose2Sim, {folder.write("cam01.json", "{}")});
  ASSERT_THAT(file, FailsWith(ErrorCode::InvalidArgument));
  EXPECT_THAT(to_string(file.error()), HasSubstr("name the folder"));
}

TEST(CameraViews, KeepFramesInWhichNobodyWasFound) {
  const TemporaryFolder folder;
  auto view = nlohmann::json::parse(bytes_of(kFolder / "cam01.json"));
  view["frames"][4]["image"] = nullptr;
  const auto read = read_camera_view(folder.write("cam01.json", view.dump()),
                                     read_cameras(kFolder / "cameras.json").value());
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->frames.size(), 100u);
  EXPECT_TRUE(read->frames[4].bodies.empty());
}

}  // namespace
}  // namespace chorus::importers
