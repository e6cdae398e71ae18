#include "common/calibration/board_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace chorus::calibration {
namespace {

constexpr double kMargin = 8.0;    // [mm]; printers leave it white
constexpr double kRulerStrip = 9;  // [mm], below the board
constexpr double kRuler = 100.0;   // [mm]
constexpr double kInch = 25.4;     // [mm]
constexpr double kDots = 300.0;    // per inch
constexpr std::size_t kMaxPixels = 400'000'000;

struct Page {
  const char* name;
  double width;  ///< [mm]
  double height;
};
constexpr std::array kPages{Page{"A4", 210, 297}, Page{"A3", 297, 420}, Page{"A2", 420, 594},
                            Page{"A1", 594, 841}, Page{"A0", 841, 1189}};
constexpr std::array kLetter{Page{"Letter", 215.9, 279.4}};

/// The smallest page on which a drawing of this size fits, upright or turned; none if none is large
/// enough.
std::optional<Page> page_for(double width, double height, bool letter) {
  const auto holds = [&](const Page& page) {
    return width + 2 * kMargin <= page.width && height + 2 * kMargin + kRulerStrip <= page.height;
  };
  const Page* const begin = letter ? kLetter.data() : kPages.data();
  for (const Page* page = begin; page != begin + (letter ? kLetter.size() : kPages.size());
       ++page) {
    if (holds(*page)) return *page;
    const Page turned{page->name, page->height, page->width};
    if (holds(turned)) return turned;
  }
  return std::nullopt;
}

/// What is drawn on the page; the unit is the millimetre.
std::string drawing(const Board& board, const Page& page) {
  const double left = 0.5 * (page.width - board.columns * board.square_mm);
  const double below =
      0.5 * (page.height - kRulerStrip - board.rows * board.square_mm) + kRulerStrip;
  std::string out = fmt::format("{0:.8f} 0 0 {0:.8f} 0 0 cm 0 g\n", 72.0 / kInch);
  for (const BlackPart& part : black_parts(board))
    out += fmt::format("{:.4f} {:.4f} {:.4f} {:.4f} re\n", left + part.x, below + part.y,
                       part.width, part.height);
  const double ruler = std::min(kRuler, std::floor(0.1 * (page.width - 2 * kMargin)) * 10.0);
  out +=
      fmt::format("{:.4f} {:.4f} {:.4f} 0.3 re {:.4f} {:.4f} 0.3 2 re {:.4f} {:.4f} 0.3 2 re f\n",
                  kMargin, kMargin, ruler, kMargin, kMargin, kMargin + ruler - 0.3, kMargin);
  out += fmt::format(
      "BT /F 3 Tf {:.2f} {:.2f} Td ({:.0f} mm: measure it.  Print at 100 %, glue it on something "
      "flat.) Tj ET\n",
      kMargin + 2.0, kMargin + 1.5, ruler);
  return out;
}

/// A PDF: numbered objects, and a table of the offsets at which they begin.
class Pdf {
 public:
  void object(const std::string& text) {
    begins_.push_back(text_.size());
    text_ += fmt::format("{} 0 obj\n{}\nendobj\n", begins_.size(), text);
  }
  [[nodiscard]] std::string finished() {
    const std::size_t table = text_.size();
    text_ += fmt::format("xref\n0 {}\n0000000000 65535 f \n", begins_.size() + 1);
    for (const std::size_t begin : begins_) text_ += fmt::format("{:010} 00000 n \n", begin);
    text_ += fmt::format("trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n",
                         begins_.size() + 1, table);
    return std::move(text_);
  }

 private:
  std::string text_ = "%PDF-1.4\n";
  std::vector<std::size_t> begins_;
};

/// CRC-32 as used in PNG (ISO 3309).
std::uint32_t crc_of(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  return ~crc;
}

std::string big_endian(std::uint32_t value) {
  std::string out;
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((value >> shift) & 0xFFU);
  return out;
}

/// The PNG chunk (pHYs) that states the pixels per metre, so that programs print the true size.
std::string resolution_chunk() {
  const auto per_metre = static_cast<std::uint32_t>(std::lround(kDots * 1000.0 / kInch));
  const std::string body = "pHYs" + big_endian(per_metre) + big_endian(per_metre) + '\1';
  return big_endian(static_cast<std::uint32_t>(body.size() - 4)) + body + big_endian(crc_of(body));
}

}  // namespace

Result<std::string> board_pdf(const Board& board, bool letter) {
  if (const auto ok = check(board); !ok) return pass(ok);
  const double width = board.columns * board.square_mm;
  const double height = board.rows * board.square_mm;
  const auto page = page_for(width, height, letter);
  if (!page)
    return fail(ErrorCode::TooLarge, "--square-mm",
                fmt::format("{:.0f} x {:.0f} mm fit no page up to {}; fewer or smaller squares",
                            width, height, letter ? "Letter" : "A0"));
  const std::string content = drawing(board, *page);
  Pdf pdf;
  pdf.object("<< /Type /Catalog /Pages 2 0 R >>");
  pdf.object("<< /Type /Pages /Kids [3 0 R] /Count 1 >>");
  pdf.object(
      fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.3f} {:.3f}] /Contents 4 0 "
                  "R /Resources << /Font << /F 5 0 R >> >> >>",
                  page->width * 72.0 / kInch, page->height * 72.0 / kInch));
  pdf.object(fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content));
  pdf.object("<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>");
  return pdf.finished();
}

Result<std::string> board_png(const Board& board) {
  if (const auto ok = check(board); !ok) return pass(ok);
  const double scale = kDots / kInch;
  const double margin = 0.5 * board.square_mm;
  const auto dots = [&](double mm) { return static_cast<int>(std::lround(mm * scale)); };
  const int width = dots(board.columns * board.square_mm + 2 * margin);
  const int height = dots(board.rows * board.square_mm + 2 * margin);
  if (static_cast<std::size_t>(width) * static_cast<std::size_t>(height) > kMaxPixels)
    return fail(ErrorCode::TooLarge, "--print-board", "is too large for a picture; make a PDF");
  cv::Mat picture(height, width, CV_8UC1, cv::Scalar(255));
  const double top = margin + board.rows * board.square_mm;
  for (const BlackPart& part : black_parts(board)) {
    const cv::Point from(dots(margin + part.x), dots(top - part.y - part.height));
    const cv::Point to(dots(margin + part.x + part.width), dots(top - part.y));
    picture(cv::Rect(from, to)).setTo(0);
  }
  std::vector<uchar> bytes;
  if (!cv::imencode(".png", picture, bytes))
    return fail(ErrorCode::Internal, "board", "the picture could not be encoded");
  std::string out(bytes.begin(), bytes.end());
  constexpr std::size_t kBehindHeader = 33;  // after the signature and the chunk IHDR
  return out.insert(kBehindHeader, resolution_chunk());
}

}  // namespace chorus::calibration
