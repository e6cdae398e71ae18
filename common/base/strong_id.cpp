#include "common/base/strong_id.h"

#include <algorithm>

namespace chorus {
namespace {

constexpr std::size_t kMaxSensorIdLength = 64;

bool allowed(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

}  // namespace

Result<SensorId> SensorId::parse(std::string_view text) {
  if (text.empty() || text.size() > kMaxSensorIdLength || !std::ranges::all_of(text, allowed)) {
    return fail(ErrorCode::InvalidArgument, "sensor id '" + std::string(text.substr(0, 80)) + "'",
                "use 1 to 64 letters, digits, '_' or '-'");
  }
  return SensorId(std::string(text));
}

}  // namespace chorus
