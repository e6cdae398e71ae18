// Unpacks what is packed by LZ4 (frame format 1.6.x), by Debian's liblz4.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus::inertial {

/// True if the bytes begin like a frame.
[[nodiscard]] bool is_lz4_frame(std::string_view bytes);

/// What one whole frame holds.  Malformed: it is damaged or cut off; TooLarge: it holds more than
/// `most` bytes, of which no more than that is ever unpacked.
[[nodiscard]] Result<std::string> unpacked_lz4(std::string_view bytes, std::size_t most);

}  // namespace chorus::inertial
