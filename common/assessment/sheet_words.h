// The words of the sheet in both languages, from sheet_words.txt, which is part of the program.
#pragma once

#include <string_view>

#include "common/ergonomics/method.h"

namespace chorus::assessment {

/// The words with this key; the key itself in both languages if there are none.
[[nodiscard]] ergonomics::Text word(std::string_view key);

}  // namespace chorus::assessment
