#include "common/resource/json_members.h"

#include <algorithm>
#include <cmath>

#include "common/base/parse.h"
#include "common/resource/inertial_members.h"

namespace chorus::resource {
namespace {

constexpr std::uint64_t kLatestNs = 9'000'000'000'000'000'000u;

}  // namespace

void JsonMembers::complain(const char* key, const char* message) {
  if (!error_) error_ = Error{ErrorCode::Malformed, where_ + ": " + key, message};
}

const nlohmann::json* JsonMembers::find(const char* key) const {
  const auto found = object_.find(key);
  return found == object_.end() ? nullptr : &*found;
}

std::string JsonMembers::text(const char* key) {
  const nlohmann::json* value = find(key);
  if (value == nullptr) return {};
  if (value->is_string()) return value->get<std::string>();
  complain(key, "is not a string");
  return {};
}

std::optional<double> JsonMembers::number(const char* key) {
  const nlohmann::json* value = find(key);
  if (value == nullptr) return std::nullopt;
  std::optional<double> number;
  if (value->is_number()) number = value->get<double>();
  if (value->is_string()) number = parse_number<double>(value->get_ref<const std::string&>());
  if (number && std::abs(*number) <= kLargestMember) return number;  // NaN is not, either.
  complain(key, "is not a number, or beyond a million");
  return std::nullopt;
}

std::uint64_t JsonMembers::count(const char* key) {
  const nlohmann::json* value = find(key);
  std::optional<std::uint64_t> count;
  if (value != nullptr && value->is_number_unsigned()) count = value->get<std::uint64_t>();
  if (value != nullptr && value->is_string())
    count = parse_number<std::uint64_t>(value->get_ref<const std::string&>());
  if (!count) complain(key, "is missing, or not a whole number from 0");
  return count.value_or(0);
}

Timestamp JsonMembers::time(const char* key) {
  const std::uint64_t ns = count(key);
  if (ns > kLatestNs) complain(key, "is no time");
  return from_unix_ns(static_cast<std::int64_t>(std::min(ns, kLatestNs)));
}

}  // namespace chorus::resource
