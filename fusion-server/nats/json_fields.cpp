#include "fusion-server/nats/json_fields.h"

#include <utility>

namespace chorus::nats {

JsonFields::JsonFields(const nlohmann::json& object, std::string where)
    : object_(object), where_(std::move(where)) {
  if (!object_.is_object()) complain("", "is no object");
}

void JsonFields::complain(const std::string& key, std::string message) {
  if (error_) return;
  const std::string dot = where_.empty() || key.empty() ? "" : ".";
  error_ = Error{ErrorCode::Malformed, where_ + dot + key, std::move(message)};
}

const nlohmann::json* JsonFields::find(const char* key) const {
  if (!object_.is_object()) return nullptr;
  const auto it = object_.find(key);
  return it == object_.end() || it->is_null() ? nullptr : &*it;
}

std::optional<double> JsonFields::maybe_number(const char* key) {
  const nlohmann::json* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (value->is_number()) {
    const double number = value->get<double>();
    if (std::isfinite(number) && std::abs(number) <= kLargest) return number;
  }
  complain(key, "must be a number of at most a million");
  return std::nullopt;
}

double JsonFields::number(const char* key) {
  const auto value = maybe_number(key);
  if (!value) complain(key, "is missing");
  return value.value_or(0.0);
}

std::uint64_t JsonFields::count(const char* key) {
  const nlohmann::json* value = find(key);
  if (value != nullptr && value->is_number_unsigned()) return value->get<std::uint64_t>();
  complain(key, "must be a whole number from 0");
  return 0;
}

std::string JsonFields::text(const char* key, std::size_t most) {
  const nlohmann::json* value = find(key);
  if (value == nullptr) return {};
  if (value->is_string() && value->get_ref<const std::string&>().size() <= most)
    return value->get<std::string>();
  complain(key, "must be a text of at most " + std::to_string(most) + " bytes");
  return {};
}

std::optional<Timestamp> JsonFields::maybe_time(const char* key) {
  constexpr std::int64_t kFirst = 0;
  constexpr std::int64_t kLast = 4'102'444'800'000'000'000;  // the year 2100
  const nlohmann::json* value = find(key);
  if (value == nullptr) return std::nullopt;
  if (value->is_string()) {
    const auto ns = parse_number<std::int64_t>(value->get_ref<const std::string&>());
    if (ns && *ns >= kFirst && *ns <= kLast) return from_unix_ns(*ns);
  }
  complain(key, "must be nanoseconds since 1970, as a text");
  return std::nullopt;
}

Timestamp JsonFields::time(const char* key) {
  const auto value = maybe_time(key);
  if (!value) complain(key, "is missing");
  return value.value_or(Timestamp{});
}

site::CellId JsonFields::cell(const char* key) {
  auto id = site::CellId::parse(text(key, 64));
  if (id) return std::move(*id);
  complain(key, "must be the name of a cell: 1 to 64 letters, digits, _ or -");
  return {};
}

std::optional<site::SiteId> JsonFields::maybe_site_id(const char* key) {
  if (find(key) == nullptr) return std::nullopt;
  auto id = site::SiteId::parse(text(key, 64));
  if (id) return std::move(*id);
  complain(key, "must be an id of the site: 1 to 64 letters, digits, _ or -");
  return std::nullopt;
}

std::optional<std::vector<double>> JsonFields::maybe_numbers(const char* key, std::size_t size) {
  const nlohmann::json* value = find(key);
  if (value == nullptr) return std::nullopt;
  auto all = numbers_in(*value, size);
  if (!all) complain(key, "must be " + std::to_string(size) + " numbers of at most a million");
  return all;
}

Eigen::Vector3d JsonFields::vector(const char* key) {
  const auto all = maybe_numbers(key, 3);
  if (!all) {
    complain(key, "is missing");
    return Eigen::Vector3d::Zero();
  }
  return {(*all)[0], (*all)[1], (*all)[2]};
}

std::optional<std::vector<double>> numbers_in(const nlohmann::json& array, std::size_t size) {
  if (!array.is_array() || array.size() != size) return std::nullopt;
  std::vector<double> all;
  for (const nlohmann::json& each : array) {
    if (!each.is_number()) return std::nullopt;
    all.push_back(each.get<double>());
    if (!std::isfinite(all.back()) || std::abs(all.back()) > kLargest) return std::nullopt;
  }
  return all;
}

double rounded(double value, int digits) {
  if (!std::isfinite(value)) return 0.0;
  const double scale = std::pow(10.0, digits);
  return std::round(value * scale) / scale;
}

nlohmann::json rounded(const Eigen::Vector3d& value, int digits) {
  return {rounded(value.x(), digits), rounded(value.y(), digits), rounded(value.z(), digits)};
}

std::string time_text(Timestamp time) { return std::to_string(to_unix_ns(time)); }

}  // namespace chorus::nats
