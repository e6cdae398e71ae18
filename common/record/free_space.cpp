#include "common/record/free_space.h"

#include <string>
#include <system_error>

namespace chorus::record {

Result<void> enough_space(const std::filesystem::path& folder, std::uintmax_t wanted) {
  std::error_code error;
  const auto space = std::filesystem::space(folder.empty() ? "." : folder, error);
  if (error) return fail(ErrorCode::Io, folder.string(), error.message());
  if (space.available >= wanted) return {};
  constexpr std::uintmax_t kMegabyte = 1u << 20;
  return fail(ErrorCode::Unavailable, folder.string(),
              "only " + std::to_string(space.available / kMegabyte) +
                  " MB are free; a recording leaves " + std::to_string(wanted / kMegabyte) +
                  " MB (min_free_mb)");
}

}  // namespace chorus::record
