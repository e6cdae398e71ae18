// What the methods take from a posture: the measures, and on what the person stands, sits or
// kneels.
#pragma once

#include <optional>

#include "common/posture/measures.h"

namespace chorus::ergonomics {

using posture::Centre;
using posture::Limb;
using posture::Measures;
using posture::Side;

/// OWAS's seven, in its order; the others use them, too.
enum class Legs { Sitting = 1, Straight, OneStraight, Bent, OneBent, Kneeling, Walking };

struct Seen {
  Measures measures;
  bool walking = false;
};

/// How the legs bear the person; none if not all joints of the legs are seen.
[[nodiscard]] std::optional<Legs> legs_of(const Seen& seen);

/// The larger knee flexion [rad]; NaN if a knee is not seen.
[[nodiscard]] double knee_of(const Seen& seen);

/// The trunk is twisted or leans sideways by more than these [rad]; none if it is not measured.
[[nodiscard]] std::optional<bool> trunk_asymmetric(const Seen& seen, double twist, double side);

}  // namespace chorus::ergonomics
