// Pixels as the bytes of a picture file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/base/result.h"

namespace chorus::synthetic {

struct PictureSize {
  int width = 0;  ///< Pixels; both above zero.
  int height = 0;
};

/// A JPEG of red, green, blue; row by row from the top.  Internal when there is no memory for it,
/// InvalidArgument when `pixels` has another number of bytes than three a pixel.
[[nodiscard]] Result<std::string> jpeg_of(std::span<const std::uint8_t> pixels, PictureSize size);

/// A PNG of one channel with 16 bits, without loss; errors as above, with one value a pixel.
[[nodiscard]] Result<std::string> png_of(std::span<const std::uint16_t> pixels, PictureSize size);

}  // namespace chorus::synthetic
