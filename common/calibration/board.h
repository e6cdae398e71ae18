// A calibration board: what it looks like, and where its inner corners are.  All functions are
// pure.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::calibration {

enum class BoardKind {
  Charuco,    ///< Has markers in the white squares; found even if only a part is visible.
  Chessboard  ///< Has no markers; must be entirely visible.
};

/// Colour of the square at the upper left of a ChArUco board: black up to OpenCV 4.6 and in ours;
/// OpenCV 4.7 and later begin boards with an even number of rows with white.
enum class FirstSquare { Black, White };

struct Board {
  BoardKind kind = BoardKind::Charuco;
  int columns = 8;          ///< Number of squares, not of inner corners.
  int rows = 6;             ///< Squares.
  double square_mm = 30.0;  ///< Side of a square.
  double marker_mm = 22.5;  ///< Side of a marker.
  int marker_bits = 4;      ///< 4 to 7, as in OpenCV's dictionaries DICT_4X4 to DICT_7X7.
  FirstSquare first = FirstSquare::Black;  ///< How it is printed; both are found (board_finder.h).
};

/// Refuses a board that cannot be made: an InvalidArgument error whose context is the option to
/// change.
[[nodiscard]] Result<void> check(const Board& board);

/// Size of the smallest predefined dictionary of OpenCV that suffices for the board.  (Each begins
/// with the markers of the next smaller one.)
[[nodiscard]] int markers_in_dictionary(const Board& board);

/// "charuco, 8 x 6 squares of 30 mm, markers of 22.5 mm (DICT_4X4_50)"
[[nodiscard]] std::string description(const Board& board);

/// A black rectangle [mm]: x and y of its lower left corner, to the right and up from that of the
/// board.
struct BlackPart {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// Everything that is black; neighbouring cells in a row of a marker make one part.
[[nodiscard]] std::vector<BlackPart> black_parts(const Board& board);

}  // namespace chorus::calibration
