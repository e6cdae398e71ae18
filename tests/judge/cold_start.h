// Somebody whom the tracker sees for the first time while they do anything but walk ahead: nothing
// that was learned of them before helps to tell front from rear.
//
// The beginning lasts three to six seconds and ends standing; then they walk at random as everybody
// else.  World: the workspace centre is the origin, metres.
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
  Enter,  ///< Comes from outside, from behind the sensors, between two of them.
};

inline constexpr std::array<std::string_view, 4> kColdStarts{"stand", "wave", "back", "enter"};

struct ColdScript {
  ColdStart start = ColdStart::Stand;
  std::uint64_t seed = 1;
  Timestamp begin;  ///< When the first of it happens.
  double body_scale = 1.0;
  synthetic::Ring ring = {};  ///< Between whose sensors they come in.
};

/// Time counts from 1970.
[[nodiscard]] synthetic::Person cold_starter(const ColdScript& script);

}  // namespace chorus::bench
