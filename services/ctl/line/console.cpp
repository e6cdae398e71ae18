#include "services/ctl/line/console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include <fmt/format.h>

namespace chorus::ctl {
namespace {

constexpr int kBarWidth = 30;  // characters

/// True for characters of three bytes that order text from right to left or break lines: U+200E,
/// U+200F, U+2028 to U+202E and U+2066 to U+2069.  Shown, they let a line read as another one.
bool reorders(std::string_view character) {
  if (!character.starts_with("\xE2\x80") && !character.starts_with("\xE2\x81")) return false;
  const auto last = static_cast<unsigned char>(character[2]);
  if (character[1] == '\x81') return last >= 0xA6 && last <= 0xA9;
  return last == 0x8E || last == 0x8F || (last >= 0xA8 && last <= 0xAE);
}

/// Length in bytes of the control character at `i`; 0 if there is none.  Control characters are C0,
/// DEL, C1 in UTF-8 (0xC2, then 0x80 to 0x9F), and those that reorder text.
std::size_t control_at(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(text[at]); };
  if (byte(i) < 0x20 || byte(i) == 0x7F) return 1;
  if (i + 2 < text.size() && reorders(text.substr(i, 3))) return 3;
  const bool c1 =
      byte(i) == 0xC2 && i + 1 < text.size() && byte(i + 1) >= 0x80 && byte(i + 1) < 0xA0;
  return c1 ? 2 : 0;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t control = control_at(text, i);
    plain += control > 0 ? '?' : text[i];
    i += control > 0 ? control : 1;
  }
  return plain;
}

std::vector<std::string> lines_at(const nlohmann::json& object, const char* key) {
  std::vector<std::string> lines;
  if (!object.is_object()) return lines;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array()) return lines;
  for (const auto& line : *found) {
    if (line.is_string()) lines.push_back(printable(line.get<std::string>()));
  }
  return lines;
}

std::string json_text(const nlohmann::json& value) { return value.dump(2, ' ', true) + "\n"; }

std::string table(std::vector<std::vector<std::string>> rows) {
  for (auto& row : rows) {
    for (std::string& cell : row) cell = printable(cell);
  }
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
  if (!std::isfinite(value)) return "-";
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.find_first_not_of("-0.") == std::string::npos && text.front() == '-') text.erase(0, 1);
  return text;
}

void Progress::show(double fraction, std::string_view said) {
  const std::string remark = printable(said);
  const double part = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0.0;
  const int percent = static_cast<int>(std::floor(part * 100.0));
  if (terminal_) {
    const int full = static_cast<int>(part * kBarWidth);
    // "\x1b[K" clears what a longer previous line left behind.
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
