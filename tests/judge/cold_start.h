// A person whom the tracker first sees standing, waving, walking backwards or coming in: nothing
// learned about them earlier helps to distinguish front from rear.
//
// This opening lasts three to six seconds, and at its end the person stands; then they walk at
// random like everybody else.  World: the workspace centre is the origin, metres.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/synthetic/scene.h"

namespace chorus::bench {

enum class ColdStart {
  Stand,  ///< Stands still.
  Wave,   ///< Stands and waves one hand.
  Back,   ///< Walks backwards.
  Enter,  ///< Comes from outside, passing between two sensors.
};

inline constexpr std::array<std::string_view, 4> kColdStarts{"stand", "wave", "back", "enter"};

struct ColdScript {
  ColdStart start = ColdStart::Stand;
  std::uint64_t seed = 1;
  Timestamp begin;  ///< Start of the first action.
  double body_scale = 1.0;
  synthetic::Ring ring = {};  ///< The person comes in between two of its sensors.
};

/// Makes such a person, as a function of the time since 1970.
[[nodiscard]] synthetic::Person cold_starter(const ColdScript& script);

}  // namespace chorus::bench
