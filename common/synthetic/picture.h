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

/// A JPEG from red, green and blue, row by row from the top.  Errors: InvalidArgument unless
/// `pixels` has three bytes per pixel, Internal if libjpeg fails.
[[nodiscard]] Result<std::string> jpeg_of(std::span<const std::uint8_t> pixels, PictureSize size);

/// A lossless PNG with one channel of 16 bits.  Errors: InvalidArgument unless `pixels` has one
/// value per pixel, Internal if zlib fails.
[[nodiscard]] Result<std::string> png_of(std::span<const std::uint16_t> pixels, PictureSize size);

}  // namespace chorus::synthetic
