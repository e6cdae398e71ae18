#include "fusion-server/wire/registration_fields.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "common/sensor/limits.h"

namespace chorus::wire {

using nlohmann::json;

namespace {

constexpr double kAnyQuaternion = 1e9;  // Its length is looked at, not its parts.
constexpr double kMaxNormError = 0.01;  // Tolerates quaternions that were rounded to a few digits.

/// Replaces the pose's rotation, which was read from the quaternion, with the matrix if there is
/// one, because the matrix is more exact.
Result<void> read_rotation(const json& object, const std::string& where, Eigen::Isometry3d& pose) {
  Eigen::Matrix3d rotation = pose.linear();
  if (auto ok = read_matrix(object, where, "rotation", rotation); !ok) return ok;
  if ((rotation - pose.linear()).cwiseAbs().maxCoeff() > kMaxNormError) {
    return tl::unexpected(wrong(where + ".rotation", "differs from qx qy qz qw"));
  }
  pose.linear() = rotation;
  return {};
}

}  // namespace

Error wrong(std::string where, std::string what) {
  return {ErrorCode::Malformed, "registration: " + std::move(where), std::move(what)};
}

Result<double> number(const json& object, const std::string& where, const char* key, double most,
                      std::optional<double> fallback) {
  const auto it = object.find(key);
  if (it == object.end() && fallback) return *fallback;
  if (it == object.end() || !it->is_number()) {
    return tl::unexpected(wrong(where + "." + key, "a number is missing here"));
  }
  const double value = it->get<double>();
  if (!std::isfinite(value) || std::abs(value) > most) {
    return tl::unexpected(wrong(
        where + "." + key, fmt::format("{} is beyond {}, the most that is read", value, most)));
  }
  return value;
}

Result<std::string> text_of(const json& object, const std::string& where, const char* key,
                            const std::string& fallback) {
  const auto it = object.find(key);
  if (it == object.end()) return fallback;
  if (!it->is_string()) return tl::unexpected(wrong(where + key, "a text is wanted"));
  return it->get<std::string>();
}

Result<std::vector<SensorId>> ids_of(const json& object, const std::string& where,
                                     const std::string& key) {
  std::vector<SensorId> ids;
  const auto it = object.find(key);
  if (it == object.end()) return ids;
  if (!it->is_array() || it->size() > kMaxSensors) {
    return tl::unexpected(wrong(where + "." + key, "a list of sensor names is wanted"));
  }
  for (const json& entry : *it) {
    auto id = SensorId::parse(entry.is_string() ? entry.get<std::string>() : "");
    if (!id) return tl::unexpected(wrong(where + "." + key, id.error().message));
    ids.push_back(std::move(*id));
  }
  return ids;
}

Result<void> check_covariance(const Eigen::Matrix<double, 6, 6>& covariance,
                              const std::string& where) {
  constexpr double kMost = 1e6;        // [rad^2, m^2]
  constexpr double kRounding = 1e-9;   // of numbers that were written with ten digits
  constexpr double kAsymmetry = 1e-3;  // of the largest entry
  const double largest = covariance.cwiseAbs().maxCoeff();
  if (largest > kMost) return tl::unexpected(wrong(where, "a number is absurdly large"));
  if (covariance.diagonal().minCoeff() < -kRounding)
    return tl::unexpected(wrong(where, "a variance is negative"));
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() >
      kAsymmetry * largest + kRounding)
    return tl::unexpected(wrong(where, "a symmetric matrix is wanted"));
  return {};
}

json pose_json(const Eigen::Isometry3d& pose) {
  json rotation = json::array();
  for (const double value : pose.linear().reshaped()) rotation.push_back(value);
  const Eigen::Vector3d p = pose.translation();
  const Eigen::Quaterniond q(pose.rotation());
  return {{"x", p.x()},  {"y", p.y()},  {"z", p.z()},  {"qx", q.x()},
          {"qy", q.y()}, {"qz", q.z()}, {"qw", q.w()}, {"rotation", std::move(rotation)}};
}

Result<Eigen::Isometry3d> pose_of(const json& object, const std::string& where) {
  std::array<double, 7> parts{};
  constexpr std::array kKeys{"x", "y", "z", "qx", "qy", "qz", "qw"};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto value = number(object, where, kKeys[i], i < 3 ? kMaxPlace : kAnyQuaternion);
    if (!value && i < 3 && object.contains(kKeys[i]))
      value.error().message += "; places are in metres: is it in millimetres?";
    if (!value) return pass(value);
    parts[i] = *value;
  }
  const Eigen::Quaterniond q(parts[6], parts[3], parts[4], parts[5]);
  if (std::abs(q.norm() - 1.0) > kMaxNormError) {
    return tl::unexpected(
        wrong(where,
              fmt::format("qx qy qz qw is not a unit quaternion: its length is {:.3g}", q.norm())));
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = q.normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(parts[0], parts[1], parts[2]);
  if (auto ok = read_rotation(object, where, pose); !ok) return pass(ok);
  return pose;
}

}  // namespace chorus::wire
