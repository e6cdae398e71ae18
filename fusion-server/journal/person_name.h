// The name that an operator gives a person.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus::journal {

inline constexpr std::size_t kLongestName = 40;  ///< Characters (code points).

/// The name without spaces at its ends; empty: no name.  InvalidArgument if it is not UTF-8, has
/// more than kLongestName characters, a slash or backslash (names may become file names), a control
/// character, or one that is not seen or turns the direction of the text around it.
[[nodiscard]] Result<std::string> checked_name(std::string_view text);

}  // namespace chorus::journal
