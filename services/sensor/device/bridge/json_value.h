// Reads values from untrusted JSON: each is valid, or an Error says where it is and what it must
// be.
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

/// The place of a value in a message; spelt out only for an error: "bodies[0].points[3]".
struct At {
  const At* in = nullptr;
  std::string_view key = {};
  std::optional<std::size_t> index = {};

  /// Only for an At with a name, because the inner one points to it.  `At{}` is the message itself.
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

/// A Malformed error at `at`.
[[nodiscard]] tl::unexpected<Error> wrong(const At& at, std::string what_it_must_be);

/// Null when the object has no such key.
[[nodiscard]] const nlohmann::json* find(const nlohmann::json& object, const char* key);

[[nodiscard]] Result<double> read_number(const nlohmann::json& value, Bounds bounds, const At& at);
/// Reads exactly out.size() numbers.
[[nodiscard]] Result<void> read_numbers(const nlohmann::json& value, std::span<double> out,
                                        Bounds bounds, const At& at);
/// Reads a non-negative integer, also as decimal text, because JavaScript's numbers are exact only
/// to 2^53.
[[nodiscard]] Result<std::uint64_t> read_whole(const nlohmann::json& value, const At& at);
/// Reads nanoseconds since 1970, later than 2001: an integer or its text.
[[nodiscard]] Result<Timestamp> read_stamp(const nlohmann::json& value, const At& at);

}  // namespace chorus::bridge
