// How many pixels a metre of a scan has, as its file states.
#pragma once

#include <optional>
#include <string_view>

namespace chorus::hand {

/// Pixels per metre: of a PNG (pHYs), a JPEG (JFIF, else Exif) or a TIFF (XResolution); none if the
/// file states none, a mere ratio, or different densities across and down.
[[nodiscard]] std::optional<double> pixels_per_metre(std::string_view bytes);

}  // namespace chorus::hand
