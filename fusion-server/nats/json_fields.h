// Internal: reads members of a JSON object that another cell wrote, and keeps the first mistake.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "common/base/parse.h"
#include "common/base/result.h"
#include "common/time/timestamp.h"
#include "fusion-server/site/site_id.h"

namespace chorus::nats {

/// No number of a message is larger; metres, radians and their squares.
inline constexpr double kLargest = 1e6;

class JsonFields {
 public:
  /// `object` must outlive this; what is no object has no members.
  JsonFields(const nlohmann::json& object, std::string where);

  void complain(const std::string& key, std::string message);
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  [[nodiscard]] const nlohmann::json* find(const char* key) const;

  [[nodiscard]] double number(const char* key);
  [[nodiscard]] std::optional<double> maybe_number(const char* key);
  [[nodiscard]] std::uint64_t count(const char* key);
  [[nodiscard]] std::string text(const char* key, std::size_t most);
  /// Nanoseconds since the Unix epoch as a text; JavaScript's numbers are too short for them.
  [[nodiscard]] Timestamp time(const char* key);
  [[nodiscard]] std::optional<Timestamp> maybe_time(const char* key);
  [[nodiscard]] site::CellId cell(const char* key);
  [[nodiscard]] std::optional<site::SiteId> maybe_site_id(const char* key);
  /// Exactly so many numbers, or none if the key is absent.
  [[nodiscard]] std::optional<std::vector<double>> maybe_numbers(const char* key, std::size_t size);
  [[nodiscard]] Eigen::Vector3d vector(const char* key);

 private:
  const nlohmann::json& object_;
  std::string where_;
  std::optional<Error> error_;
};

/// The numbers of an array of exactly `size` that are all finite and at most kLargest; else none.
[[nodiscard]] std::optional<std::vector<double>> numbers_in(const nlohmann::json& array,
                                                            std::size_t size);
/// Rounded to `digits` decimals, so that it is written in few characters.
[[nodiscard]] double rounded(double value, int digits);
[[nodiscard]] nlohmann::json rounded(const Eigen::Vector3d& value, int digits);
[[nodiscard]] std::string time_text(Timestamp time);

}  // namespace chorus::nats
