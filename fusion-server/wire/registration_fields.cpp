#include "fusion-server/wire/registration_fields.h"

#include <utility>

#include "common/sensor/limits.h"

namespace chorus::wire {

using nlohmann::json;

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
    return tl::unexpected(wrong(where + "." + key, "this number is not finite or absurdly large"));
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

}  // namespace chorus::wire
