// The methods, each in a file of its own name.
#pragma once

#include "common/ergonomics/method.h"

namespace chorus::ergonomics {

extern const Method kReba, kRula, kOwas, kIso11226, kEn1005, kEaws;

}  // namespace chorus::ergonomics
