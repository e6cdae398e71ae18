// C3D: labelled points over time, binary (https://www.c3d.org, "The C3D File Format: User Guide").
//
// Blocks of 512 bytes: a header, parameters in groups, then frames of four numbers per point (x, y,
// z, residual and camera mask): 16-bit integers times POINT:SCALE or, if that is negative, floats.
// Reads Intel, DEC (VAX floats) and MIPS byte orders; skips analog samples.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/motion/markers.h"

namespace chorus::motion {

/// Points over time; world_from_file follows POINT:X_SCREEN and Y_SCREEN.  In a file without these,
/// +z is up, as is usual in biomechanics.
struct C3d : MarkerTracks {
  std::string processor;  ///< "Intel", "DEC" or "MIPS"
};

/// A larger file is refused.
inline constexpr std::size_t kMaxC3dBytes = 128u << 20;

/// Parses a file.  Refuses headers and parameters that point outside the file.  The frames that are
/// there count, not those that are announced: fewer, or more than a 16-bit count can say, are read
/// with a note.  Coordinates that are not finite, beyond 10 km, or 0, 0, 0 count as missing.
/// `metres_per_unit` replaces the unit that the file states; without either, an unknown unit is
/// refused.
[[nodiscard]] Result<C3d> parse_c3d(std::string_view bytes, std::string_view origin,
                                    std::optional<double> metres_per_unit = std::nullopt);

}  // namespace chorus::motion
