#include "services/ctl/calibrate/board_options.h"

#include <CLI/CLI.hpp>

#include "common/base/parse.h"
#include "services/ctl/line/number_range.h"

namespace chorus::ctl {
namespace {

// Default side of a marker, relative to that of a square.
constexpr double kMarkerShare = 0.75;

}  // namespace

std::optional<std::pair<int, int>> pair_in(std::string_view text) {
  const auto first = take_number<int>(text);
  if (!first || !text.starts_with('x')) return std::nullopt;
  const auto second = parse_number<int>(text.substr(1));
  if (!second || *first < 1 || *second < 1) return std::nullopt;
  return std::pair(*first, *second);
}

std::string check_pair(const std::string& text) {
  return pair_in(text) ? std::string() : "must be two numbers, as 8x6 or 1280x720";
}

Result<calibration::Board> board_of(const BoardOptions& options) {
  const auto [columns, rows] = pair_in(options.squares).value();  // checked while parsing
  calibration::Board board;
  board.kind = options.kind == "charuco" ? calibration::BoardKind::Charuco
                                         : calibration::BoardKind::Chessboard;
  board.columns = columns;
  board.rows = rows;
  board.square_mm = options.square_mm;
  board.marker_mm = options.marker_mm > 0.0 ? options.marker_mm : kMarkerShare * options.square_mm;
  board.marker_bits = options.marker_bits;
  if (const auto ok = check(board); !ok) return pass(ok);
  return board;
}

void add_board_options(CLI::App& options, BoardOptions& board) {
  options.add_option("--board", board.kind, "What is printed on it")
      ->check(CLI::IsMember({"charuco", "chessboard"}))
      ->capture_default_str();
  options.add_option("--squares", board.squares, "Squares across x down, as printed")
      ->check(CLI::Validator(check_pair, "WxH"))
      ->capture_default_str();
  options.add_option("--square-mm", board.square_mm, "Side of a square, measured")
      ->check(number_range(1.0, 1000.0))
      ->capture_default_str();
  options.add_option("--marker-mm", board.marker_mm, "Side of a marker; default: 0.75 of a square")
      ->check(number_range(0.5, 1000.0));
  options
      .add_option("--marker-bits", board.marker_bits,
                  "Of OpenCV's dictionaries DICT_4X4 to DICT_7X7")
      ->check(number_range(4, 7))
      ->capture_default_str();
}

}  // namespace chorus::ctl
