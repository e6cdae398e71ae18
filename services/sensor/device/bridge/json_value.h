// Reads values from untrusted JSON: each value is valid, or an Error says where it is and what it
// must be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "common/base/result.h"
#include "common/time/timestamp.h"

namespace chorus::bridge {

/// The place of a value in a message, such as "bodies[0].points[3]"; the string is built only for
/// an error.
struct At {
  const At* in = nullptr;
  std::string_view key = {};
  std::optional<std::size_t> index = {};

  /// The result points to this At, which must therefore be a named variable.  Only `At{}`, which is
  /// the message itself, may be a temporary: nothing points to it.
  [[nodiscard]] At operator[](std::string_view inner) const { return {outer(), inner, {}}; }
  [[nodiscard]] At operator[](std::size_t inner) const { return {outer(), {}, inner}; }
  [[nodiscard]] std::string text() const;

 private:
  [[nodiscard]] const At* outer() const { return key.empty() && !index ? nullptr : this; }
};

struct Bounds {
  double least = 0.0;
  double most = 0.0;
};

/// Limit of a coordinate, length or focal length in a picture [px].
inline constexpr double kMaxPixels = 1e5;

/// A Malformed error that names the place.
[[nodiscard]] tl::unexpected<Error> wrong(const At& at, std::string what_it_must_be);

/// The value of the key; null when the object has no such key.
[[nodiscard]] const nlohmann::json* find(const nlohmann::json& object, const char* key);

[[nodiscard]] Result<double> read_number(const nlohmann::json& value, Bounds bounds, const At& at);
/// Reads an array of exactly out.size() numbers.
[[nodiscard]] Result<void> read_numbers(const nlohmann::json& value, std::span<double> out,
                                        Bounds bounds, const At& at);
/// Reads a non-negative integer, or a string of its decimal digits, because JavaScript's numbers
/// are exact only up to 2^53.
[[nodiscard]] Result<std::uint64_t> read_whole(const nlohmann::json& value, const At& at);
/// Reads nanoseconds since 1970, as an integer or a string of its digits; refuses times before 2001
/// or after 2223.
[[nodiscard]] Result<Timestamp> read_stamp(const nlohmann::json& value, const At& at);

}  // namespace chorus::bridge
