// Ids of distinct types, so that none can be mistaken for another.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus {

/// Names one sensor: 1-64 characters of [A-Za-z0-9_-], safe in a URI, a file name and a metric
/// label.
class SensorId {
 public:
  SensorId() = default;
  [[nodiscard]] static Result<SensorId> parse(std::string_view text);
  [[nodiscard]] const std::string& str() const noexcept { return text_; }
  auto operator<=>(const SensorId&) const = default;

 private:
  explicit SensorId(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

/// A sensor's own number for a body that it tracks.  Unique within the sensor at one time; the
/// numbers of two bodies may swap, and a number may be reused.
struct BodyId {
  std::uint64_t value = 0;
  auto operator<=>(const BodyId&) const = default;
};

/// The fusion server's number for a person, stable while the person is tracked.
struct PersonId {
  std::uint64_t value = 0;
  auto operator<=>(const PersonId&) const = default;
};

}  // namespace chorus

template <>
struct std::hash<chorus::SensorId> {
  std::size_t operator()(const chorus::SensorId& id) const noexcept {
    return std::hash<std::string>{}(id.str());
  }
};
