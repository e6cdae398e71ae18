#include "common/importers/camera_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "common/importers/json_values.h"
#include "common/importers/landmark_fit.h"

namespace chorus::importers {
namespace {

constexpr std::size_t kMaxCameras = 64;  // As many as a Snapshot can name.
constexpr double kRotationSlack = 1e-3;  // Largest |R R^T - 1|; files round.

Result<Eigen::Matrix3d> read_matrix(const nlohmann::json& rows, double bound,
                                    const std::string& at) {
  Eigen::Matrix3d matrix;
  if (!rows.is_array() || rows.size() != 3)
    return fail(ErrorCode::Malformed, at, "must be three rows of three numbers.");
  for (Eigen::Index r = 0; r < 3; ++r) {
    std::array<double, 3> row{};
    const auto read = read_numbers(rows[static_cast<std::size_t>(r)], row, bound, at);
    if (!read) return pass(read);
    matrix.row(r) = Eigen::RowVector3d(row[0], row[1], row[2]);
  }
  return matrix;
}

Result<int> read_size(const nlohmann::json& camera, const char* key, const std::string& at) {
  const auto value = member(camera, key, at);
  if (!value) return pass(value);
  std::array<double, 1> size{};
  const auto read = read_numbers(nlohmann::json::array({**value}), size, kMaxPixel, at);
  if (!read) return pass(read);
  if (size[0] < 1.0) return fail(ErrorCode::Malformed, at, "image sizes must be 1 or more.");
  return static_cast<int>(size[0]);
}

Result<Intrinsics> read_intrinsics(const nlohmann::json& camera, const std::string& at) {
  const auto width = read_size(camera, "width", at);
  if (!width) return pass(width);
  const auto height = read_size(camera, "height", at);
  if (!height) return pass(height);
  const auto k = member(camera, "K", at);
  if (!k) return pass(k);
  const auto matrix = read_matrix(**k, kMaxPixel, at + ".K");
  if (!matrix) return pass(matrix);
  const auto distortion = member(camera, "distortion_k1k2p1p2k3", at);
  if (!distortion) return pass(distortion);
  Intrinsics out{*width,          *height, (*matrix)(0, 0), (*matrix)(1, 1), (*matrix)(0, 2),
                 (*matrix)(1, 2), {}};
  const auto read = read_numbers(**distortion, out.distortion, kMaxPixel, at + ".distortion");
  if (!read) return pass(read);
  if (out.fx <= 0.0 || out.fy <= 0.0)
    return fail(ErrorCode::Malformed, at + ".K", "focal lengths must be positive.");
  return out;
}

/// x_in_camera = R x_in_world + t, both in the file's axes.
Result<Eigen::Isometry3d> read_camera_from_world(const nlohmann::json& camera,
                                                 const std::string& at) {
  const auto pose = member(camera, "camera_from_world", at);
  if (!pose) return pass(pose);
  const auto rotation = member(**pose, "R", at + ".camera_from_world");
  if (!rotation) return pass(rotation);
  const auto shift = member(**pose, "t_m", at + ".camera_from_world");
  if (!shift) return pass(shift);
  const auto matrix = read_matrix(**rotation, 1.0 + kRotationSlack, at + ".R");
  if (!matrix) return pass(matrix);
  std::array<double, 3> t{};
  const auto read = read_numbers(**shift, t, kMaxImported, at + ".t_m");
  if (!read) return pass(read);
  if (!(*matrix * matrix->transpose()).isIdentity(kRotationSlack) || matrix->determinant() < 0.0)
    return fail(ErrorCode::Malformed, at + ".R", "is not a rotation.");
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  camera_from_world.linear() = Eigen::Quaterniond(*matrix).normalized().toRotationMatrix();
  camera_from_world.translation() = Eigen::Vector3d(t[0], t[1], t[2]);
  return camera_from_world;
}

Result<CalibratedCamera> read_camera(const nlohmann::json& entry, const std::string& at) {
  const auto name = member(entry, "camera", at);
  if (!name) return pass(name);
  if (!(*name)->is_string()) return fail(ErrorCode::Malformed, at, "\"camera\" must be a name.");
  const auto sensor = SensorId::parse((*name)->get<std::string>());
  if (!sensor) return pass(sensor);
  const auto intrinsics = read_intrinsics(entry, at);
  if (!intrinsics) return pass(intrinsics);
  const auto camera_from_world = read_camera_from_world(entry, at);
  if (!camera_from_world) return pass(camera_from_world);
  const Eigen::Isometry3d opencv_from_sensor(sensor_from_opencv());
  const Eigen::Isometry3d ours_from_theirs(world_from_z_up());
  return CalibratedCamera{*sensor, *intrinsics,
                          ours_from_theirs * camera_from_world->inverse() * opencv_from_sensor};
}

}  // namespace

Result<std::vector<CalibratedCamera>> read_cameras(const std::filesystem::path& file,
                                                   const ImportLimits& limits) {
  const auto document = read_json(file, limits.max_json_bytes);
  if (!document) return pass(document);
  if (!document->is_array() || document->empty() || document->size() > kMaxCameras)
    return fail(ErrorCode::Malformed, file.string(),
                fmt::format("must be an array of 1 to {} cameras.", kMaxCameras));
  std::vector<CalibratedCamera> cameras;
  for (std::size_t i = 0; i < document->size(); ++i) {
    const std::string at = fmt::format("{}: [{}]", file.string(), i);
    const auto camera = read_camera((*document)[i], at);
    if (!camera) return pass(camera);
    const auto same = [&](const CalibratedCamera& c) { return c.sensor == camera->sensor; };
    if (std::any_of(cameras.begin(), cameras.end(), same))
      return fail(ErrorCode::Malformed, at, "names a camera a second time.");
    cameras.push_back(*camera);
  }
  return cameras;
}

Eigen::Matrix3d world_from_z_up() {
  Eigen::Matrix3d turn;
  turn << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return turn;
}

}  // namespace chorus::importers
