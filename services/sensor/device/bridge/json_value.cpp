#include "services/sensor/device/bridge/json_value.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/parse.h"

namespace chorus::bridge {
namespace {

using Json = nlohmann::json;

// Stamps from 2001 to 2223: converting such a stamp to our clock, ours + (a - b), cannot overflow
// while our clock is before 2040.
constexpr std::uint64_t kEarliestNs = 1'000'000'000'000'000'000;
constexpr std::uint64_t kLatestNs = 8'000'000'000'000'000'000;

}  // namespace

std::string At::text() const {
  std::string path = in != nullptr ? in->text() : std::string();
  if (index) return path + "[" + std::to_string(*index) + "]";
  if (!path.empty() && !key.empty()) path += ".";
  constexpr std::size_t kShown = 64;  // A key from outside may be long.
  return path.append(key.substr(0, kShown));
}

tl::unexpected<Error> wrong(const At& at, std::string what_it_must_be) {
  return fail(ErrorCode::Malformed, at.text(), std::move(what_it_must_be));
}

const Json* find(const Json& object, const char* key) {
  const auto it = object.find(key);
  return it == object.end() ? nullptr : &*it;
}

Result<double> read_number(const Json& value, Bounds bounds, const At& at) {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (number >= bounds.least && number <= bounds.most) return number;
  return wrong(at, fmt::format("must be a number from {} to {}", bounds.least, bounds.most));
}

Result<void> read_numbers(const Json& value, std::span<double> out, Bounds bounds, const At& at) {
  if (!value.is_array() || value.size() != out.size())
    return wrong(at, fmt::format("must be an array of {} numbers", out.size()));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto number = read_number(value[i], bounds, at[i]);
    if (!number) return pass(number);
    out[i] = *number;
  }
  return {};
}

Result<std::uint64_t> read_whole(const Json& value, const At& at) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (value.is_string()) {
    const auto number = parse_number<std::uint64_t>(value.get_ref<const std::string&>());
    if (number) return *number;
  }
  return wrong(at, "must be a whole number, 0 or more, or its decimal digits as a string");
}

Result<Timestamp> read_stamp(const Json& value, const At& at) {
  const auto ns = read_whole(value, at);
  if (ns && *ns >= kEarliestNs && *ns <= kLatestNs)
    return from_unix_ns(static_cast<std::int64_t>(*ns));
  return wrong(
      at,
      "must be nanoseconds since 1970 (UTC), a whole number or its digits, such as "
      "\"1795246200250000000\" (not 1.79e+18); a clock that is wrong is no harm, one that counts "
      "from another beginning is");
}

}  // namespace chorus::bridge
