#include "common/motion/c3d.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/base/not_seen.h"
#include "common/base/unit_name.h"
#include "common/motion/c3d_parameters.h"
#include "common/motion/text_lines.h"
#include "common/sensor/limits.h"

namespace chorus::motion {
namespace {

constexpr std::size_t kMaxPoints = 4096;
constexpr double kMaxFrameRateHz = 1e5;
constexpr double kWordFrames = 65536;  // what a count of 16 bits loses when it wraps

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
  C3dReader(std::string_view bytes, std::string_view origin, C3dParameters parameters)
      : bytes_(bytes), origin_(origin), parameters_(std::move(parameters)) {}
  Result<C3d> read(std::optional<double> unit);

 private:
  [[nodiscard]] Result<Layout> read_layout() const;
  [[nodiscard]] Result<double> metres_per_unit() const;
  [[nodiscard]] Result<void> settle_extent(Layout& layout, std::vector<std::string>& notes) const;
  [[nodiscard]] Result<std::size_t> start_of_points() const;
  void read_frames(const Layout& layout, C3d& out) const;
  [[nodiscard]] std::optional<Eigen::Vector3d> axis(const std::string& name) const;
  [[nodiscard]] Eigen::Matrix3d world_from_file() const;
  [[nodiscard]] MarkerPoint read_point(const Layout& layout, std::size_t at) const;
  [[nodiscard]] bool is_zero(const Layout& layout, std::size_t at) const;

  [[nodiscard]] double frame_count() const;
  [[nodiscard]] std::size_t filled_frames(const Layout& layout, std::size_t there) const;
  [[nodiscard]] std::vector<std::string> labels(std::size_t points) const;
  [[nodiscard]] tl::unexpected<Error> wrong(std::string message) const {
    return fail(ErrorCode::Malformed, std::string(origin_), std::move(message));
  }

  std::string_view bytes_;
  std::string_view origin_;
  C3dParameters parameters_;
  std::optional<double> unit_;  ///< Metres; instead of what the file states.
};

Result<C3d> C3dReader::read(std::optional<double> unit) {
  unit_ = unit;
  auto layout = read_layout();
  if (!layout) return pass(layout);
  C3d out;
  if (const auto ok = settle_extent(*layout, out.notes); !ok) return pass(ok);
  out.processor = parameters_.processor_name();
  out.labels = labels(layout->points);
  out.rate_hz = parameters_.number("POINT:RATE").value_or(parameters_.numbers().real(20));
  if (!(out.rate_hz > 0) || out.rate_hz > kMaxFrameRateHz) return wrong("has no rate of frames");
  out.world_from_file = world_from_file();
  out.metres_per_unit = layout->metres_per_unit;
  read_frames(*layout, out);
  return out;
}

std::vector<std::string> C3dReader::labels(std::size_t points) const {
  std::vector<std::string> all = parameters_.texts("POINT:LABELS");
  for (int more = 2; all.size() < points; ++more) {
    const auto next = parameters_.texts("POINT:LABELS" + std::to_string(more));
    if (next.empty()) break;
    all.insert(all.end(), next.begin(), next.end());
  }
  all.resize(points);
  return all;
}

/// The largest of what the file says in its places for the number of frames: those of 16 bits
/// (header, POINT:FRAMES) saturate or wrap in long files, for which there are POINT:LONG_FRAMES and
/// the fields of TRIAL (c3d.org, "Reading the frame count").
double C3dReader::frame_count() const {
  const Numbers numbers = parameters_.numbers();
  const double of_header = numbers.word(8) - numbers.word(6) + 1.0;
  const double stated = parameters_.number("POINT:FRAMES").value_or(of_header);
  const auto field = [&](const std::string& name) {
    return parameters_.number(name).value_or(0) +
           kWordFrames * parameters_.number(name, 1).value_or(0);
  };
  const double of_trial = field("TRIAL:ACTUAL_END_FIELD") - field("TRIAL:ACTUAL_START_FIELD") + 1;
  double longer = parameters_.number("POINT:LONG_FRAMES").value_or(0);
  // Only where it says the same but for what 16 bits lose: programs that cut a file leave it as is.
  const double lost = std::fmod(of_trial - stated, kWordFrames);
  if (stated == kWordFrames - 1 || lost == 0) longer = std::max(longer, of_trial);
  return std::max(stated, longer);
}

Result<double> C3dReader::metres_per_unit() const {
  if (unit_) return *unit_;
  const auto units = parameters_.texts("POINT:UNITS");
  const std::string unit = units.empty() || units.front().empty() ? "mm" : units.front();
  if (const auto metres = metres_in(unit)) return *metres;
  return wrong("gives its points in \"" + unit.substr(0, 16) +
               "\", a unit we do not know: say which with --unit mm, cm, m or in");
}

/// POINT:DATA_START, or the header's if that is none or lies beyond the file; 2 is the first block
/// that it can be.
Result<std::size_t> C3dReader::start_of_points() const {
  const double of_header = parameters_.numbers().word(16);
  for (const double block : {parameters_.number("POINT:DATA_START").value_or(0), of_header}) {
    const auto start = (static_cast<std::size_t>(std::clamp(block, 1.0, 65535.0)) - 1) * kC3dBlock;
    if (block >= 2 && start < bytes_.size()) return start;
  }
  return wrong("says no place where its points begin; is it cut off, or without points?");
}

Result<Layout> C3dReader::read_layout() const {
  const Numbers numbers = parameters_.numbers();
  Layout layout;
  const double points = parameters_.number("POINT:USED").value_or(numbers.word(2));
  const double frames = frame_count();
  layout.scale = parameters_.number("POINT:SCALE").value_or(numbers.real(12));
  if (!std::isfinite(layout.scale) || layout.scale == 0) return wrong("has no scale of points");
  if (points == 0)
    return wrong(parameters_.has_group("ROTATION")
                     ? "holds rotations of segments and no points, which are "
                       "needed here: export joint centres or markers, too"
                     : "holds no points, only analog channels or nothing");
  if (!(points >= 1 && points <= static_cast<double>(kMaxPoints)))
    return wrong("announces more than 4096 points");
  layout.points = static_cast<std::size_t>(points);
  layout.frames = frames > 0 ? static_cast<std::size_t>(std::min(frames, 1e9)) : 0;
  const auto start = start_of_points();
  if (!start) return pass(start);
  layout.start = *start;
  layout.analog = numbers.word(4);
  const auto unit = metres_per_unit();
  if (!unit) return pass(unit);
  layout.metres_per_unit = *unit;
  return layout;
}

/// The count that 16 bits wrapped, for files that hold `there` frames.
std::size_t wrapped(std::size_t announced, std::size_t there) {
  const auto wrap = static_cast<std::size_t>(kWordFrames);
  return announced + (there - announced) / wrap * wrap;
}

/// Whether a count of 16 bits that wrapped explains what is there.
bool wraps(std::size_t announced, std::size_t surely, std::size_t there) {
  const std::size_t count = wrapped(announced, there);
  return count > announced && count >= surely;
}

/// `there` without the frames of zeros at the end, which fill the last block.
std::size_t C3dReader::filled_frames(const Layout& layout, std::size_t there) const {
  const std::size_t size = layout.frame_bytes();
  for (std::size_t spare = 0; there > 1 && (spare + 1) * size < kC3dBlock; ++spare) {
    const std::string_view last = bytes_.substr(layout.start + (there - 1) * size, size);
    if (last.find_first_not_of('\0') != std::string_view::npos) break;
    --there;
  }
  return there;
}

/// Counts the frames that are there.  After the last one, up to a block may be left over.
Result<void> C3dReader::settle_extent(Layout& layout, std::vector<std::string>& notes) const {
  const std::size_t announced = layout.frames;
  const std::size_t bytes = layout.start < bytes_.size() ? bytes_.size() - layout.start : 0;
  const std::size_t there = bytes / layout.frame_bytes();
  const std::size_t surely = (bytes - std::min(bytes, kC3dBlock - 1)) / layout.frame_bytes();
  if (there == 0) return wrong("holds no frame; is it cut off?");
  const auto wrap = static_cast<std::size_t>(kWordFrames);
  if (there < announced || announced == 0) {
    layout.frames = there;
    notes.push_back("announces " + std::to_string(announced) + " frames and holds " +
                    std::to_string(there) + ", which were read; is it cut off?");
  } else if (surely > announced && (announced == wrap - 1 || wraps(announced, surely, there))) {
    layout.frames =
        announced == wrap - 1 ? filled_frames(layout, there) : wrapped(announced, there);
    notes.push_back("holds " + std::to_string(layout.frames - announced) +
                    " frames more than its count of 16 bits can say, which were read");
  } else if (surely > announced) {
    notes.push_back("holds " + std::to_string(surely - announced) +
                    " frames more than it announces, which were not read");
  }
  if (layout.frames > kMaxFrames)
    return fail(ErrorCode::TooLarge, std::string(origin_), "has more than 200000 frames");
  return {};
}

MarkerPoint C3dReader::read_point(const Layout& layout, std::size_t at) const {
  const Numbers numbers = parameters_.numbers();
  const bool floats = layout.scale < 0;
  std::array<double, 4> xyzw{};
  for (std::size_t i = 0; i < 4; ++i)
    xyzw[i] = floats ? static_cast<double>(numbers.real(at + 4 * i))
                     : static_cast<double>(numbers.integer(at + 2 * i));
  const double metres = (floats ? 1.0 : layout.scale) * layout.metres_per_unit;
  MarkerPoint point;
  const Eigen::Vector3d position = metres * Eigen::Vector3d(xyzw.data());
  // The fourth number contains camera bits in the high byte and residual / scale in the low byte.
  if (!(xyzw[3] >= 0 && xyzw[3] < 32768) || !position.allFinite() ||
      position.cwiseAbs().maxCoeff() > kMaxCoordinate)
    return point;
  if (is_nowhere(position)) return point;
  point.position = position.cast<float>();
  point.residual = static_cast<float>((static_cast<int>(xyzw[3]) & 0xff) * std::abs(layout.scale) *
                                      layout.metres_per_unit);
  return point;
}

/// A point at the origin that claims to be there: how many programs write what was not seen.
bool C3dReader::is_zero(const Layout& layout, std::size_t at) const {
  const Numbers numbers = parameters_.numbers();
  for (std::size_t i = 0; i < 3; ++i) {
    const bool zero =
        layout.scale < 0 ? numbers.real(at + 4 * i) == 0.0f : numbers.integer(at + 2 * i) == 0;
    if (!zero) return false;
  }
  return layout.scale < 0 ? numbers.real(at + 12) >= 0.0f : numbers.integer(at + 6) >= 0;
}

void C3dReader::read_frames(const Layout& layout, C3d& out) const {
  out.frames.resize(layout.frames);
  std::size_t zeros = 0;
  for (std::size_t f = 0; f < layout.frames; ++f) {
    const std::size_t frame = layout.start + f * layout.frame_bytes();
    out.frames[f].reserve(layout.points);
    for (std::size_t p = 0; p < layout.points; ++p) {
      const std::size_t at = frame + 4 * p * layout.word_bytes();
      out.frames[f].push_back(read_point(layout, at));
      if (!out.frames[f].back().valid() && is_zero(layout, at)) ++zeros;
    }
  }
  if (zeros > 0)
    out.notes.push_back(std::to_string(zeros) +
                        " points at 0, 0, 0 with a residual of 0 or more are taken as not seen");
}

std::optional<Eigen::Vector3d> C3dReader::axis(const std::string& name) const {
  const auto found = parameters_.texts(name);
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

Result<C3d> parse_c3d(std::string_view bytes, std::string_view origin,
                      std::optional<double> metres_per_unit) {
  if (bytes.size() > kMaxC3dBytes)
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 128 MB");
  auto parameters = C3dParameters::read(bytes, origin);
  if (!parameters) return pass(parameters);
  return C3dReader(bytes, origin, std::move(*parameters)).read(metres_per_unit);
}

}  // namespace chorus::motion
