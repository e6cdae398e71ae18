// Helpers for JSON formats: read files up to a size limit, and check numbers.  Private to this
// folder's .cpp files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "common/base/result.h"

namespace chorus::importers {

/// Limit of a coordinate, length or focal length in a picture [px].
inline constexpr double kMaxPixel = 1e5;

/// NaN and Infinity, which JSON does not have, but which Python's json writes.
enum class Nan { Refused, IsNull };

/// Reads a whole document; errors name the file and, for broken syntax, line and column.
[[nodiscard]] Result<nlohmann::json> read_json(const std::filesystem::path& file,
                                               std::uintmax_t max_bytes,
                                               Nan nan_in_file = Nan::Refused);

/// The value for a key of an object; `at` names the object in error messages.
[[nodiscard]] Result<const nlohmann::json*> member(const nlohmann::json& object, const char* key,
                                                   const std::string& at);

/// Reads exactly `out.size()` finite numbers within +-bound from an array.
[[nodiscard]] Result<void> read_numbers(const nlohmann::json& array, std::span<double> out,
                                        double bound, const std::string& at);

/// The same, with NaN for null.
[[nodiscard]] Result<void> read_numbers_or_null(const nlohmann::json& array, std::span<double> out,
                                                double bound, const std::string& at);

}  // namespace chorus::importers
