#include "common/importers/json_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "common/base/json.h"
#include "common/base/not_seen.h"
#include "common/importers/text_rows.h"

namespace chorus::importers {
Result<nlohmann::json> read_json(const std::filesystem::path& file, std::uintmax_t max_bytes,
                                 Nan nan_in_file) {
  auto text = read_bounded(file, max_bytes);
  if (!text) return pass(text);
  if (nan_in_file == Nan::IsNull) text = null_for_nan(*text);
  auto parsed = parse_json(*text, {.bytes = max_bytes});
  if (!parsed) {
    const bool nan = text->find("NaN") != std::string::npos;
    return fail(
        parsed.error().code, file.string(),
        parsed.error().message +
            (nan ? "; JSON has no NaN: write 0 as the confidence of what is not seen" : ""));
  }
  return parsed;
}

Result<const nlohmann::json*> member(const nlohmann::json& object, const char* key,
                                     const std::string& at) {
  if (object.is_object()) {
    if (const auto found = object.find(key); found != object.end()) return &*found;
  }
  return fail(ErrorCode::Malformed, at, fmt::format("has no \"{}\".", key));
}

Result<void> read_numbers(const nlohmann::json& array, std::span<double> out, double bound,
                          const std::string& at) {
  if (!array.is_array() || array.size() != out.size())
    return fail(ErrorCode::Malformed, at, fmt::format("must be {} numbers.", out.size()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!array[i].is_number())
      return fail(ErrorCode::Malformed, at, fmt::format("value {} is not a number.", i + 1));
    out[i] = array[i].get<double>();
    if (!std::isfinite(out[i]) || std::abs(out[i]) > bound)
      return fail(ErrorCode::Malformed, at, fmt::format("value {} is beyond +-{}.", i + 1, bound));
  }
  return {};
}

Result<void> read_numbers_or_null(const nlohmann::json& array, std::span<double> out, double bound,
                                  const std::string& at) {
  nlohmann::json given = array;
  const double missing = std::nan("");
  std::vector<std::size_t> holes;
  for (std::size_t i = 0; given.is_array() && i < given.size(); ++i) {
    if (!given[i].is_null()) continue;
    given[i] = 0.0;
    holes.push_back(i);
  }
  if (auto read = read_numbers(given, out, bound, at); !read) return read;
  for (const std::size_t i : holes) out[i] = missing;
  return {};
}

}  // namespace chorus::importers
