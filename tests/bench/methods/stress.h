// The sources of error that stress sweeps vary, by name.
#pragma once

#include <array>

#include "common/synthetic/kinect/error_source.h"

namespace chorus::bench {

struct NamedSource {
  const char* name;
  synthetic::kinect::Source source;
};

using enum synthetic::kinect::Source;
inline constexpr std::array kSources{
    NamedSource{"visibility", Visibility}, NamedSource{"yaw", Yaw},     NamedSource{"bias", Bias},
    NamedSource{"coloured", Coloured},     NamedSource{"white", White}, NamedSource{"gross", Gross},
    NamedSource{"delivery", Delivery},     NamedSource{"clock", Clock}};

/// The factors that are applied to each source of errors: 0 switches it off, 1 leaves it
/// unchanged.
inline constexpr std::array kFactors{0.0, 0.5, 1.0, 2.0, 3.0};

}  // namespace chorus::bench
