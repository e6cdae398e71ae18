// The focal length that a camera writes into its photos (Exif 2.3).  All functions are pure.
#pragma once

#include <optional>
#include <string_view>

namespace chorus::calibration {

/// FocalLengthIn35mmFilm of a JPEG [mm]: the focal length that shows the same view on 36 x 24 mm
/// film; none if the photo does not state it.
[[nodiscard]] std::optional<double> focal_on_35mm_film(std::string_view jpeg);

/// Converts such a focal length to pixels, for a picture of this size; compares diagonals, as CIPA
/// DCG-001 does.
[[nodiscard]] double pixels_of_35mm(double focal_mm, int width, int height);

}  // namespace chorus::calibration
