// The options that describe a printed board, for the commands that look for one.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/result.h"
#include "common/calibration/board.h"

namespace CLI {
class App;
}

namespace chorus::ctl {

struct BoardOptions {
  std::string kind = "charuco";
  std::string squares = "8x6";
  double square_mm = 30.0;
  double marker_mm = 0.0;  ///< 0: three quarters of a square.
  int marker_bits = 4;
};

void add_board_options(CLI::App& options, BoardOptions& board);

/// InvalidArgument when there can be no such board; the context is the option to change.
[[nodiscard]] Result<calibration::Board> board_of(const BoardOptions& options);

/// "8x6" as two whole numbers, each at least 1.
[[nodiscard]] std::optional<std::pair<int, int>> pair_in(std::string_view text);
/// For CLI11: what is wrong with such a text; empty if nothing.
[[nodiscard]] std::string check_pair(const std::string& text);

}  // namespace chorus::ctl
