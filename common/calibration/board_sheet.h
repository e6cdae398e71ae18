// A board as a file to print, in its real size.
#pragma once

#include <string>

#include "common/calibration/board.h"

namespace chorus::calibration {

/// A page of PDF: the smallest of A4 to A0, or Letter if that is wanted, that holds the board with
/// a margin, and a ruler to check the printer.  TooLarge when no page does.
[[nodiscard]] Result<std::string> board_pdf(const Board& board, bool letter = false);

/// A PNG of 300 dots per inch, which it states, with a white margin of half a square.
[[nodiscard]] Result<std::string> board_png(const Board& board);

}  // namespace chorus::calibration
