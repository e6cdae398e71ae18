#include "common/motion/c3d.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>

#include "common/motion/text_lines.h"
#include "common/sensor/limits.h"

namespace chorus::motion {
namespace {

constexpr std::size_t kBlock = 512;
constexpr std::uint8_t kKey = 0x50;  // The second byte of every C3D file.
constexpr std::uint8_t kFirstProcessor = 84;
constexpr std::array<std::string_view, 3> kProcessors{"Intel", "DEC", "MIPS"};
constexpr std::size_t kMaxPoints = 4096;
constexpr double kMaxFrameRateHz = 1e5;
constexpr double kMaxWordFrames = 65535;

enum Processor : std::uint8_t { kIntel, kDec, kMips };

/// Reads numbers of one byte order; the caller has checked the offsets.
class Numbers {
 public:
  Numbers(std::string_view bytes, Processor processor) : bytes_(bytes), processor_(processor) {}

  [[nodiscard]] std::uint8_t byte(std::size_t at) const {
    return static_cast<std::uint8_t>(bytes_[at]);
  }
  /// A signed byte, -128 to 127.
  [[nodiscard]] int small(std::size_t at) const {
    const int value = byte(at);
    return value < 128 ? value : value - 256;
  }
  [[nodiscard]] std::uint16_t word(std::size_t at) const {
    const auto [low, high] = processor_ == kMips ? std::pair{at + 1, at} : std::pair{at, at + 1};
    return static_cast<std::uint16_t>(byte(low) | byte(high) << 8);
  }
  [[nodiscard]] std::int16_t integer(std::size_t at) const {
    return static_cast<std::int16_t>(word(at));
  }
  [[nodiscard]] float real(std::size_t at) const {
    const std::uint32_t first = word(at);
    const std::uint32_t second = word(at + 2);
    if (processor_ == kIntel) return std::bit_cast<float>(second << 16 | first);
    // A VAX F float is an IEEE float with its words swapped and its exponent larger by two.
    const float value = std::bit_cast<float>(first << 16 | second);
    return processor_ == kDec ? value / 4.0f : value;
  }
  [[nodiscard]] std::string_view text(std::size_t at, std::size_t count) const {
    return bytes_.substr(at, count);
  }

 private:
  std::string_view bytes_;
  Processor processor_;
};

struct Parameter {
  int type = 0;  ///< Bytes per element: 1, 2, 4 (float) or -1 (text).
  std::vector<std::size_t> dimensions;
  std::size_t at = 0;     ///< File offset of its first element.
  std::size_t count = 0;  ///< Number of elements.
};

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return out;
}

std::string trimmed(std::string_view text) {
  const std::size_t end = text.find_last_not_of(std::string_view(" \t\0", 3));
  return std::string(text.substr(0, end == std::string_view::npos ? 0 : end + 1));
}

struct Entry {
  int group = 0;
  std::string name;
  Parameter parameter;
};

/// Where each parameter's value is, by names such as "POINT:RATE".
using Parameters = std::map<std::string, Parameter>;

struct Layout {
  std::size_t points = 0;
  std::size_t analog = 0;  ///< Analog samples per frame.
  std::size_t frames = 0;
  std::size_t start = 0;
  double scale = 1.0;  ///< Negative: coordinates are floats.
  double metres_per_unit = 0.001;

  [[nodiscard]] std::size_t word_bytes() const { return scale < 0 ? 4 : 2; }
  [[nodiscard]] std::size_t frame_bytes() const { return (4 * points + analog) * word_bytes(); }
};

class C3dReader {
 public:
  C3dReader(std::string_view bytes, std::string_view origin) : bytes_(bytes), origin_(origin) {}
  Result<C3d> read();

 private:
  Result<void> read_processor();
  Result<void> read_parameters();
  Result<std::size_t> read_entry(std::size_t at, std::size_t end);
  [[nodiscard]] Result<Parameter> read_parameter(std::size_t at, std::size_t end) const;
  [[nodiscard]] Result<Layout> read_layout() const;
  [[nodiscard]] Result<double> metres_per_unit() const;
  [[nodiscard]] Result<void> check_extent(const Layout& layout) const;
  void read_frames(const Layout& layout, C3d& out) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> axis(const std::string& name) const;
  [[nodiscard]] Eigen::Matrix3d world_from_file() const;
  [[nodiscard]] C3dPoint read_point(const Layout& layout, std::size_t at) const;

  [[nodiscard]] std::optional<double> number(const std::string& name, std::size_t i = 0) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& name) const;
  [[nodiscard]] double frame_count() const;
  [[nodiscard]] std::vector<std::string> labels(std::size_t points) const;
  [[nodiscard]] tl::unexpected<Error> wrong(std::string message) const {
    return fail(ErrorCode::Malformed, std::string(origin_), std::move(message));
  }

  std::string_view bytes_;
  std::string_view origin_;
  std::size_t parameters_at_ = 0;
  Processor processor_ = kIntel;
  std::map<int, std::string> groups_;
  std::vector<Entry> entries_;
  Parameters parameters_;
};

Result<C3d> C3dReader::read() {
  if (const auto ok = read_processor(); !ok) return pass(ok);
  if (const auto ok = read_parameters(); !ok) return pass(ok);
  const auto layout = read_layout();
  if (!layout) return pass(layout);
  if (const auto ok = check_extent(*layout); !ok) return pass(ok);
  C3d out;
  out.processor = std::string(kProcessors[processor_]);
  out.labels = labels(layout->points);
  out.rate_hz = number("POINT:RATE").value_or(Numbers(bytes_, processor_).real(20));
  if (!(out.rate_hz > 0) || out.rate_hz > kMaxFrameRateHz) return wrong("has no rate of frames");
  out.world_from_file = world_from_file();
  read_frames(*layout, out);
  return out;
}

Result<void> C3dReader::read_processor() {
  if (bytes_.size() < 2 * kBlock) return wrong("is too short for a C3D file");
  const auto first = static_cast<std::uint8_t>(bytes_[0]);
  if (static_cast<std::uint8_t>(bytes_[1]) != kKey || first < 2)
    return wrong("does not begin as a C3D file does");
  parameters_at_ = (first - 1u) * kBlock;
  if (parameters_at_ + kBlock > bytes_.size())
    return wrong("has its parameters beyond its end; is it cut off?");
  const auto processor = static_cast<std::uint8_t>(bytes_[parameters_at_ + 3]);
  if (processor < kFirstProcessor ||
      processor - kFirstProcessor >= static_cast<int>(kProcessors.size()))
    return fail(ErrorCode::Unsupported, std::string(origin_),
                "names a processor that is neither Intel, DEC nor MIPS");
  processor_ = static_cast<Processor>(processor - kFirstProcessor);
  return {};
}

Result<void> C3dReader::read_parameters() {
  const std::size_t blocks = static_cast<std::uint8_t>(bytes_[parameters_at_ + 2]);
  // Some writers leave the count at 0; then the list of parameters ends by its own mark.
  const std::size_t end =
      std::min(bytes_.size(), parameters_at_ + (blocks == 0 ? 255 : blocks) * kBlock);
  std::size_t at = parameters_at_ + 4;
  while (at != 0 && at + 2 <= end && bytes_[at] != 0 && bytes_[at + 1] != 0) {
    const auto next = read_entry(at, end);
    if (!next) return pass(next);
    at = *next;
  }
  for (Entry& entry : entries_) {
    if (const auto found = groups_.find(entry.group); found != groups_.end())
      parameters_.emplace(found->second + ":" + entry.name, std::move(entry.parameter));
  }
  return {};
}

/// Reads one group (negative number) or parameter; returns the next one's offset, 0 after the last.
Result<std::size_t> C3dReader::read_entry(std::size_t at, std::size_t end) {
  const Numbers numbers(bytes_, processor_);
  // A negative length of the name means "locked".
  const auto length = static_cast<std::size_t>(std::abs(numbers.small(at)));
  const int group = numbers.small(at + 1);
  if (at + 2 + length + 2 > end) return wrong("has a parameter that is cut off");
  std::string name = upper(numbers.text(at + 2, length));
  const std::size_t link = at + 2 + length;
  const std::size_t step = numbers.word(link);
  if (group < 0) {
    groups_.emplace(-group, std::move(name));
  } else {
    auto parameter = read_parameter(link + 2, end);
    if (!parameter) return wrong("has a parameter " + name + " that reaches beyond the parameters");
    entries_.push_back({group, std::move(name), std::move(*parameter)});
  }
  return step == 0 ? 0 : link + step;
}

Result<Parameter> C3dReader::read_parameter(std::size_t at, std::size_t end) const {
  const Numbers numbers(bytes_, processor_);
  if (at + 2 > end) return wrong("is cut off");
  Parameter out;
  out.type = numbers.small(at);
  const std::size_t dimensions = numbers.byte(at + 1);
  if (at + 2 + dimensions > end || dimensions > 7) return wrong("is cut off");
  out.at = at + 2 + dimensions;
  out.count = 1;
  for (std::size_t d = 0; d < dimensions; ++d) {
    out.dimensions.push_back(numbers.byte(at + 2 + d));
    out.count *= out.dimensions.back();
    if (out.count > bytes_.size()) return wrong("is cut off");
  }
  const auto width = static_cast<std::size_t>(std::abs(out.type));
  if (out.at + out.count * width > end) return wrong("is cut off");
  return out;
}

std::optional<double> C3dReader::number(const std::string& name, std::size_t i) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end() || i >= found->second.count) return std::nullopt;
  const Numbers numbers(bytes_, processor_);
  const std::size_t at = found->second.at;
  switch (found->second.type) {
    case 1:
      return numbers.byte(at + i);
    case 2:
      return numbers.word(at + 2 * i);  // Counts above 32767 are stored unsigned.
    case 4:
      return numbers.real(at + 4 * i);
    default:
      return std::nullopt;
  }
}

std::vector<std::string> C3dReader::texts(const std::string& name) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end() || found->second.type != -1) return {};
  const Parameter& text = found->second;
  if (text.dimensions.empty() || text.dimensions[0] == 0) return {};
  std::vector<std::string> out;
  for (std::size_t i = 0; i + text.dimensions[0] <= text.count; i += text.dimensions[0])
    out.push_back(trimmed(bytes_.substr(text.at + i, text.dimensions[0])));
  return out;
}

std::vector<std::string> C3dReader::labels(std::size_t points) const {
  std::vector<std::string> all = texts("POINT:LABELS");
  for (int more = 2; all.size() < points; ++more) {
    const auto next = texts("POINT:LABELS" + std::to_string(more));
    if (next.empty()) break;
    all.insert(all.end(), next.begin(), next.end());
  }
  all.resize(points);
  return all;
}

/// POINT:FRAMES, unless it has the largest value of its type; then POINT:LONG_FRAMES or the fields
/// of TRIAL (c3d.org, "Reading the frame count").
double C3dReader::frame_count() const {
  const Numbers numbers(bytes_, processor_);
  const double of_header = numbers.word(8) - numbers.word(6) + 1.0;
  const double stated = number("POINT:FRAMES").value_or(of_header);
  if (stated != kMaxWordFrames) return stated;
  if (const auto longer = number("POINT:LONG_FRAMES")) return *longer;
  const auto field = [&](const std::string& name) {
    return number(name).value_or(0) + 65536.0 * number(name, 1).value_or(0);
  };
  const double of_trial = field("TRIAL:ACTUAL_END_FIELD") - field("TRIAL:ACTUAL_START_FIELD") + 1;
  return of_trial > stated ? of_trial : stated;
}

Result<double> C3dReader::metres_per_unit() const {
  constexpr std::array<std::pair<std::string_view, double>, 6> kUnits{
      {{"MM", 0.001}, {"CM", 0.01}, {"M", 1.0}, {"DM", 0.1}, {"IN", 0.0254}, {"", 0.001}}};
  const auto units = texts("POINT:UNITS");
  const std::string unit = units.empty() ? "" : upper(units.front());
  for (const auto& [name, metres] : kUnits) {
    if (name == unit) return metres;
  }
  return wrong("gives its points in \"" + unit.substr(0, 16) + "\", a unit we do not know");
}

Result<Layout> C3dReader::read_layout() const {
  const Numbers numbers(bytes_, processor_);
  Layout layout;
  const double points = number("POINT:USED").value_or(numbers.word(2));
  const double frames = frame_count();
  const double start = number("POINT:DATA_START").value_or(numbers.word(16));
  layout.scale = number("POINT:SCALE").value_or(numbers.real(12));
  if (!std::isfinite(layout.scale) || layout.scale == 0) return wrong("has no scale of points");
  if (!(points >= 1 && points <= static_cast<double>(kMaxPoints)))
    return wrong("announces no points, or more than 4096");
  if (!(frames >= 1)) return wrong("announces no frames");
  if (frames > static_cast<double>(kMaxFrames))
    return fail(ErrorCode::TooLarge, std::string(origin_), "has more than 200000 frames");
  if (!(start >= 2 && start <= 65535)) return wrong("says no place where its points begin");
  layout.points = static_cast<std::size_t>(points);
  layout.frames = static_cast<std::size_t>(frames);
  layout.start = (static_cast<std::size_t>(start) - 1) * kBlock;
  layout.analog = numbers.word(4);
  const auto unit = metres_per_unit();
  if (!unit) return pass(unit);
  layout.metres_per_unit = *unit;
  return layout;
}

Result<void> C3dReader::check_extent(const Layout& layout) const {
  const std::size_t there =
      layout.start < bytes_.size() ? (bytes_.size() - layout.start) / layout.frame_bytes() : 0;
  if (there >= layout.frames) return {};
  return wrong("announces " + std::to_string(layout.frames) + " frames and holds " +
               std::to_string(there) + "; is it cut off?");
}

C3dPoint C3dReader::read_point(const Layout& layout, std::size_t at) const {
  const Numbers numbers(bytes_, processor_);
  const bool floats = layout.scale < 0;
  std::array<double, 4> xyzw{};
  for (std::size_t i = 0; i < 4; ++i)
    xyzw[i] = floats ? static_cast<double>(numbers.real(at + 4 * i))
                     : static_cast<double>(numbers.integer(at + 2 * i));
  const double metres = (floats ? 1.0 : layout.scale) * layout.metres_per_unit;
  C3dPoint point;
  const Eigen::Vector3d position = metres * Eigen::Vector3d(xyzw.data());
  // The fourth number contains camera bits in the high byte and residual / scale in the low byte.
  if (!(xyzw[3] >= 0 && xyzw[3] < 32768) || !position.allFinite() ||
      position.cwiseAbs().maxCoeff() > kMaxCoordinate)
    return point;
  point.position = position.cast<float>();
  point.residual = static_cast<float>((static_cast<int>(xyzw[3]) & 0xff) * std::abs(layout.scale) *
                                      layout.metres_per_unit);
  return point;
}

void C3dReader::read_frames(const Layout& layout, C3d& out) const {
  out.frames.resize(layout.frames);
  for (std::size_t f = 0; f < layout.frames; ++f) {
    const std::size_t frame = layout.start + f * layout.frame_bytes();
    out.frames[f].reserve(layout.points);
    for (std::size_t p = 0; p < layout.points; ++p)
      out.frames[f].push_back(read_point(layout, frame + 4 * p * layout.word_bytes()));
  }
}

std::optional<Eigen::Vector3d> C3dReader::axis(const std::string& name) const {
  const auto found = texts(name);
  if (found.empty() || found.front().size() != 2) return std::nullopt;
  const std::size_t i = std::string_view("XYZ").find(upper(found.front())[1]);
  if (i == std::string_view::npos) return std::nullopt;
  const double sign = found.front()[0] == '-' ? -1.0 : 1.0;
  return sign * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i));
}

Eigen::Matrix3d C3dReader::world_from_file() const {
  const Eigen::Vector3d up = axis("POINT:Y_SCREEN").value_or(Eigen::Vector3d::UnitZ());
  Eigen::Vector3d right = axis("POINT:X_SCREEN").value_or(Eigen::Vector3d::UnitX());
  if (right.dot(up) != 0) right = up.unitOrthogonal();
  Eigen::Matrix3d rows;
  rows << right.transpose(), up.transpose(), right.cross(up).transpose();
  return rows;
}

}  // namespace

Result<C3d> parse_c3d(std::string_view bytes, std::string_view origin) {
  if (bytes.size() > kMaxC3dBytes)
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 128 MB");
  return C3dReader(bytes, origin).read();
}

}  // namespace chorus::motion
