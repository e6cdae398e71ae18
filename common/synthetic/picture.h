// Encodes pixels as JPEG or PNG.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/base/result.h"

namespace chorus::synthetic {

struct PictureSize {
  int width = 0;  ///< [px]; both are above zero.
  int height = 0;
};

/// A JPEG from red, green and blue, row by row from the top.  Internal when out of memory,
/// InvalidArgument unless `pixels` has three bytes per pixel.
[[nodiscard]] Result<std::string> jpeg_of(std::span<const std::uint8_t> pixels, PictureSize size);

/// A lossless PNG with one channel of 16 bits; the same errors, but `pixels` needs one value per
/// pixel.
[[nodiscard]] Result<std::string> png_of(std::span<const std::uint16_t> pixels, PictureSize size);

}  // namespace chorus::synthetic
