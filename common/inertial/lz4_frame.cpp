#include "common/inertial/lz4_frame.h"

#include <array>
#include <memory>

#include <lz4frame.h>

namespace chorus::inertial {

bool is_lz4_frame(std::string_view bytes) { return bytes.starts_with("\x04\x22\x4d\x18"); }

Result<std::string> unpacked_lz4(std::string_view bytes, std::size_t most) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0U)
    return fail(ErrorCode::Internal, "LZ4", "has no memory");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, &LZ4F_freeDecompressionContext);
  std::string out;
  std::array<char, 16'384> piece{};
  std::size_t hint = 1;  // what is still expected; 0: the frame has ended
  while (hint != 0) {
    std::size_t taken = bytes.size();
    std::size_t given = piece.size();
    hint = LZ4F_decompress(context.get(), piece.data(), &given, bytes.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0U)
      return fail(ErrorCode::Malformed, "LZ4",
                  std::string("cannot be unpacked: ") + LZ4F_getErrorName(hint));
    if (out.size() + given > most)
      return fail(ErrorCode::TooLarge, "LZ4", "holds more than " + std::to_string(most) + " bytes");
    out.append(piece.data(), given);
    bytes.remove_prefix(taken);
    if (hint != 0 && taken == 0 && given == 0)
      return fail(ErrorCode::Malformed, "LZ4", "is cut off");
  }
  return out;
}

}  // namespace chorus::inertial
