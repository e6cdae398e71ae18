#include "common/resource/decimal_reader.h"

#include <cmath>

#include "common/base/parse.h"

namespace chorus::resource {

std::optional<double> read_decimal(std::string_view text) noexcept {
  const auto value = parse_signed<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace chorus::resource
