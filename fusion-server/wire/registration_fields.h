// Reads single members of a registration's JSON; the error names the member and says what is
// wanted.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/base/strong_id.h"

namespace chorus::wire {

[[nodiscard]] Error wrong(std::string where, std::string what);

/// A finite number of magnitude up to `most`. An absent key gives `fallback`; without a fallback it
/// is an error.
[[nodiscard]] Result<double> number(const nlohmann::json& object, const std::string& where,
                                    const char* key, double most,
                                    std::optional<double> fallback = {});

/// A text; an absent key gives `fallback`.  `where` is empty or ends with a dot.
[[nodiscard]] Result<std::string> text_of(const nlohmann::json& object, const std::string& where,
                                          const char* key, const std::string& fallback = {});

/// A list of sensor names; empty when the key is absent.
[[nodiscard]] Result<std::vector<SensorId>> ids_of(const nlohmann::json& object,
                                                   const std::string& where,
                                                   const std::string& key);

/// Success if the matrix can be a covariance: symmetric, no negative variance, nothing absurdly
/// large.
[[nodiscard]] Result<void> check_covariance(const Eigen::Matrix<double, 6, 6>& covariance,
                                            const std::string& where);

/// Reads a matrix, column by column; `out` stays unchanged when the key is absent.
template <class Matrix>
[[nodiscard]] Result<void> read_matrix(const nlohmann::json& object, const std::string& where,
                                       const char* key, Matrix& out) {
  const auto it = object.find(key);
  if (it == object.end()) return {};
  const auto wanted = static_cast<std::size_t>(out.size());
  const bool numbers = it->is_array() && it->size() == wanted &&
                       std::all_of(it->begin(), it->end(), [](const nlohmann::json& value) {
                         return value.is_number() && std::isfinite(value.get<double>());
                       });
  if (!numbers) {
    return tl::unexpected(
        wrong(where + "." + key, std::to_string(wanted) + " finite numbers are wanted"));
  }
  for (std::size_t i = 0; i < wanted; ++i)
    out.reshaped()(static_cast<Eigen::Index>(i)) = (*it)[i].get<double>();
  return {};
}

}  // namespace chorus::wire
