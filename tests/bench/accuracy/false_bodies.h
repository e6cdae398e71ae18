// Bodies that sensors show where nobody is, and on which two of them agree.
#pragma once

#include "tests/judge/judge.h"

namespace chorus::bench {

/// A mirror of 3 m stands upright before the second and the third sensor, which look into it: both
/// show everybody a second time behind it, as its image, 0.5 m to 2 m beside people who cross.
void stand_a_mirror(Workshop& workshop);

/// The second and the third sensor show everybody 1 m beside where they are, both to the same side.
void let_two_lie(Workshop& workshop);

}  // namespace chorus::bench
