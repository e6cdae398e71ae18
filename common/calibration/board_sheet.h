// A board as a file to print, in its true size.
#pragma once

#include <string>

#include "common/calibration/board.h"

namespace chorus::calibration {

/// A PDF of one page with the board, a margin, and a ruler to check the printer.  The page is the
/// smallest of A4 to A0 on which it fits, or Letter if `letter` is true.  TooLarge when the board
/// does not fit.
[[nodiscard]] Result<std::string> board_pdf(const Board& board, bool letter = false);

/// A PNG at 300 dots per inch (stated in the file), with a white margin of half a square.  TooLarge
/// above 400 million pixels.
[[nodiscard]] Result<std::string> board_png(const Board& board);

}  // namespace chorus::calibration
