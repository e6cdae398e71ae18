// Internal to common/resource: reads the members of a JSON object that others wrote.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/time/timestamp.h"

namespace chorus::resource {

/// Keeps the first thing that is wrong, with `where` and the key.  A decimal is a number in JSON
/// and a string in JSON-LD; both are read.
class JsonMembers {
 public:
  /// `object` must be an object and outlive this.
  JsonMembers(const nlohmann::json& object, std::string where)
      : object_(object), where_(std::move(where)) {}

  void complain(const char* key, const char* message);
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  [[nodiscard]] const nlohmann::json* find(const char* key) const;
  /// The string; empty if there is none.
  std::string text(const char* key);
  /// None, with a complaint unless it is absent, if it is no finite number of at most 1e6.
  std::optional<double> number(const char* key);
  /// A whole number from 0, as a number or as a string of digits; it must be there.
  std::uint64_t count(const char* key);
  /// The time in this member, which ends in Nanoseconds; it must be there.
  Timestamp time(const char* key = "capturedNanoseconds");
  /// All of these numbers or none.
  template <std::size_t N>
  std::optional<std::array<double, N>> numbers(const std::array<const char*, N>& keys) {
    std::array<double, N> all{};
    std::size_t there = 0;
    for (std::size_t i = 0; i < N; ++i) {
      const auto one = number(keys[i]);
      if (one) all[i] = *one;
      there += one ? 1 : 0;
    }
    if (there == 0) return std::nullopt;
    if (there < N) complain(keys[0], "comes without its other components");
    return all;
  }

 private:
  const nlohmann::json& object_;
  std::string where_;
  std::optional<Error> error_;
};

}  // namespace chorus::resource
