#include "services/ctl/console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include <fmt/format.h>

namespace chorus::ctl {
namespace {

constexpr int kBarWidth = 30;  // characters

}  // namespace

std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c)
      line += fmt::format("{:<{}}", row[c], c + 1 < row.size() ? widths[c] + 2 : 0);
    text += line + "\n";
  }
  return text;
}

std::string shown(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

void Progress::show(double fraction, std::string_view remark) {
  const double part = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const int percent = static_cast<int>(std::floor(part * 100.0));
  if (terminal_) {
    const int full = static_cast<int>(part * kBarWidth);
    // "\x1b[K" clears what a longer line before this one left behind.
    out_ << fmt::format("\r{} [{:#<{}}{:.<{}}] {:3}% {}\x1b[K", label_, "", full, "",
                        kBarWidth - full, percent, remark)
         << std::flush;
    drawn_ = true;
    return;
  }
  const int tenth = percent / 10;
  if (tenth == tenth_ && remark == remark_) return;
  tenth_ = tenth;
  remark_ = remark;
  out_ << fmt::format("{}: {}% {}\n", label_, percent, remark) << std::flush;
}

void Progress::finish() {
  if (drawn_) out_ << '\n' << std::flush;
  drawn_ = false;
}

bool on_terminal() { return ::isatty(STDERR_FILENO) == 1; }

}  // namespace chorus::ctl
