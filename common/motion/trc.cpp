#include "common/motion/trc.h"

#include <algorithm>
#include <cmath>

#include "common/base/not_seen.h"
#include "common/base/parse.h"
#include "common/base/unit_name.h"
#include "common/motion/text_lines.h"
#include "common/sensor/limits.h"

namespace chorus::motion {
namespace {

constexpr std::size_t kMaxMarkers = 4096;
constexpr std::size_t kMaxCells = 3 * kMaxMarkers + 16;
constexpr double kMaxTrcRateHz = 1e5;
constexpr std::string_view kTrcBlanks = " \r\f\v";

using Cells = std::vector<std::string_view>;

std::string_view stripped(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kTrcBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kTrcBlanks) - begin + 1);
}

/// What separates the cells of a file: tabs, else commas, else blanks.
char separator_of(std::string_view text) {
  const std::string_view head = text.substr(0, 4096);
  for (const char separator : {'\t', ','}) {
    if (head.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

/// The cells of a line.  Between tabs and commas, they may be empty.
Cells cells_of(std::string_view line, char separator) {
  Cells cells;
  while (cells.size() < kMaxCells) {
    if (separator == ' ') {
      line.remove_prefix(std::min(line.find_first_not_of(" \r"), line.size()));
      if (line.empty()) break;
    }
    const std::size_t end = std::min(line.find(separator), line.size());
    cells.push_back(stripped(line.substr(0, end)));
    if (end == line.size()) break;
    line.remove_prefix(end + 1);
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
  return cells;
}

class TrcReader {
 public:
  TrcReader(std::string_view text, std::string_view origin)
      : rest_(text), origin_(origin), separator_(separator_of(text)) {}
  Result<MarkerTracks> read(std::optional<double> unit);

 private:
  bool next();
  Result<void> read_head(std::optional<double> unit);
  Result<void> read_names();
  void read_row();
  Result<void> settle_rows();
  [[nodiscard]] std::string_view cell(std::size_t i) const {
    return i < cells_.size() ? cells_[i] : std::string_view();
  }
  [[nodiscard]] tl::unexpected<Error> wrong(std::string message) const {
    return fail(ErrorCode::Malformed, origin_ + ":" + std::to_string(line_), std::move(message));
  }

  std::string_view rest_;
  std::string origin_;
  char separator_;
  std::size_t line_ = 0;
  Cells cells_;
  std::optional<double> announced_;
  std::size_t unread_ = 0;
  MarkerTracks out_;
};

/// Moves to the next line that is not blank.
bool TrcReader::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    cells_ = cells_of(rest_.substr(0, end), separator_);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    if (!cells_.empty()) return true;
  }
  return false;
}

Result<void> TrcReader::read_head(std::optional<double> unit) {
  if (!next() || !cell(0).starts_with("PathFileType")) return wrong("expected PathFileType");
  if (!next() || cell(0) != "DataRate") return wrong("expected the line DataRate, CameraRate, ...");
  const std::vector<std::string> keys(cells_.begin(), cells_.end());
  if (!next()) return wrong("the file ends before the values of DataRate, ...");
  std::string unit_name = "mm";
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto number = parse_finite(cell(i));
    if (keys[i] == "DataRate" && number) out_.rate_hz = *number;
    if (keys[i] == "NumFrames") announced_ = number;
    if (keys[i] == "Units") unit_name = std::string(cell(i));
  }
  const auto metres = unit ? unit : metres_in(unit_name);
  if (!metres)
    return wrong("gives its points in \"" + unit_name.substr(0, 16) +
                 "\", a unit we do not know: say which with --unit mm, cm, m or in");
  out_.metres_per_unit = *metres;
  return {};
}

Result<void> TrcReader::read_names() {
  if (!next() || !cell(0).starts_with("Frame"))
    return wrong("expected Frame#, Time and the markers");
  for (std::size_t i = 2; i < cells_.size(); ++i) {
    if (!cells_[i].empty()) out_.labels.emplace_back(cells_[i]);
  }
  if (out_.labels.empty()) return wrong("names no markers");
  if (out_.labels.size() > kMaxMarkers) return wrong("names more than 4096 markers");
  return {};
}

/// A row is its number, its time and three cells for each marker.
void TrcReader::read_row() {
  const auto time = parse_finite(cell(1));
  if (!parse_finite(cell(0)) || !time) {
    if (!cell(0).starts_with("X") && !cell(0).empty()) ++unread_;
    return;  // also the line "X1 Y1 Z1 ..."
  }
  std::vector<MarkerPoint> points(out_.labels.size());
  for (std::size_t m = 0; m < points.size(); ++m) {
    Eigen::Vector3d place = Eigen::Vector3d::Constant(std::nan(""));
    for (std::size_t i = 0; i < 3; ++i) {
      const auto number = parse_finite(cell(2 + 3 * m + i));
      if (number) place[static_cast<Eigen::Index>(i)] = *number * out_.metres_per_unit;
    }
    if (is_nowhere(place) || place.cwiseAbs().maxCoeff() > kMaxCoordinate) continue;
    points[m] = {place.cast<float>(), 0.0f};
  }
  out_.frames.push_back(std::move(points));
  out_.times.push_back(*time);
}

/// Checks times and counts.
Result<void> TrcReader::settle_rows() {
  if (out_.frames.empty()) return wrong("holds no row of a number, a time and markers");
  for (std::size_t i = 1; i < out_.times.size(); ++i) {
    if (out_.times[i] > out_.times[i - 1]) continue;
    if (!(out_.rate_hz > 0)) return wrong("its times do not ascend, and it states no DataRate");
    out_.notes.emplace_back("its times do not ascend: its DataRate is taken instead");
    out_.times.clear();
  }
  const auto steps = static_cast<double>(out_.frames.size() - 1);
  if (!(out_.rate_hz > 0) && out_.times.size() > 1)
    out_.rate_hz = steps / (out_.times.back() - out_.times.front());
  if (!(out_.rate_hz > 0) || out_.rate_hz > kMaxTrcRateHz) return wrong("states no DataRate");
  if (announced_ && *announced_ != static_cast<double>(out_.frames.size() + unread_))
    out_.notes.push_back("announces " + std::to_string(static_cast<long long>(*announced_)) +
                         " frames and holds " + std::to_string(out_.frames.size()) +
                         ", which were read");
  if (unread_ > 0)
    out_.notes.push_back(std::to_string(unread_) + " rows cannot be read and were left out");
  return {};
}

Result<MarkerTracks> TrcReader::read(std::optional<double> unit) {
  if (auto ok = read_head(unit); !ok) return pass(ok);
  if (auto ok = read_names(); !ok) return pass(ok);
  while (next()) {
    if (out_.frames.size() >= kMaxFrames)
      return fail(ErrorCode::TooLarge, origin_, "has more than 200000 frames");
    read_row();
  }
  if (auto ok = settle_rows(); !ok) return pass(ok);
  return std::move(out_);
}

}  // namespace

Result<MarkerTracks> parse_trc(std::string_view text, std::string_view origin,
                               std::optional<double> metres_per_unit) {
  if (text.size() > kMaxTextBytes)
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 64 MB");
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return TrcReader(text, origin).read(metres_per_unit);
}

}  // namespace chorus::motion
