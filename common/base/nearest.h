// Spelling help: finds the known word nearest to an unknown one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace chorus {

/// Levenshtein distance: the least number of inserted, deleted and replaced characters.
[[nodiscard]] std::size_t levenshtein(std::string_view a, std::string_view b);

/// The word of `known` that `word` was most likely meant to be; empty when none is close enough: at
/// most a third of the longer word's characters may differ, but two are always allowed, or one if
/// the longer word has fewer than four characters.
[[nodiscard]] std::string nearest(std::string_view word, std::span<const std::string> known);

}  // namespace chorus
