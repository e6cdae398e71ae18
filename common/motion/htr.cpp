#include "common/motion/htr.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "common/base/units.h"
#include "common/motion/text_lines.h"

namespace chorus::motion {
namespace {

constexpr std::size_t kNumbers = 7;   // Translation, rotation, and length or scale of a segment.
constexpr double kMissing = 999'000;  // Such numbers mark what was not measured.
constexpr std::array<std::pair<std::string_view, double>, 9> kHtrUnits{{{"mm", 0.001},
                                                                        {"cm", 0.01},
                                                                        {"dm", 0.1},
                                                                        {"m", 1.0},
                                                                        {"meters", 1.0},
                                                                        {"in", 0.0254},
                                                                        {"inches", 0.0254},
                                                                        {"ft", 0.3048},
                                                                        {"feet", 0.3048}}};

std::string lower_word(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

struct HtrHeader {
  std::array<int, 3> order{2, 1, 0};  ///< Axes of the rotations from left to right.
  double metres = 0.001;              ///< Per unit.
  double radians = std::numbers::pi / 180.0;
  double rate_hz = 0.0;
  int up = 1;
  int bone = 1;
};

struct HtrSegment {
  std::string parent;
  Eigen::Isometry3d rest = Eigen::Isometry3d::Identity();  ///< In its parent.
  double length = 0.0;                                     ///< [m]
  /// Place and turn against the rest; not finite where unknown.
  std::vector<std::pair<Eigen::Vector3d, Eigen::Quaterniond>> motion = {};
};

/// 0, 1, 2 for X, Y, Z; -1 for anything else.
int axis_of(std::string_view word) {
  const std::size_t found = word.size() == 1 ? std::string_view("xyz").find(lower_word(word)) : 3;
  return found < 3 ? static_cast<int>(found) : -1;
}

class HtrReader {
 public:
  HtrReader(std::string_view text, std::string_view origin) : lines_(text, origin) {}
  Result<Bvh> read();

 private:
  Result<void> read_line();
  Result<void> read_header();
  Result<void> read_order(std::string_view word);
  Result<void> read_axis(std::string_view word, int& axis);
  Result<void> read_parent();
  Result<void> read_rest();
  void read_motion();
  Result<void> sort();
  void add_joints(Bvh& out);
  void add_frames(Bvh& out) const;
  void add_ends(Bvh& out) const;
  [[nodiscard]] Eigen::Quaterniond turn_of(const std::vector<double>& numbers) const;
  [[nodiscard]] Eigen::Matrix3d world_from_file() const;
  [[nodiscard]] std::string section_in() const;

  TextLines lines_;
  HtrHeader header_;
  std::string section_;
  std::map<std::string, HtrSegment> segments_;
  std::vector<std::string> sorted_;  ///< Names, parents first; so are the joints.
};

/// "[Header]" gives "header"; a segment's section its name as it is; other lines nothing.
std::string HtrReader::section_in() const {
  const std::string_view word = lines_.word(0);
  if (word.size() < 3 || word.front() != '[') return {};
  std::string line;
  for (const std::string_view each : lines_.words())
    line += (line.empty() ? "" : " ") + std::string(each);
  const std::size_t end = line.find(']');
  return end == std::string::npos ? std::string() : line.substr(1, end - 1);
}

Result<Bvh> HtrReader::read() {
  while (lines_.next()) {
    if (const std::string section = section_in(); !section.empty()) {
      section_ = segments_.contains(section) ? section : lower_word(section);
      if (section_ == "endoffile") break;
      continue;
    }
    if (const auto ok = read_line(); !ok) return pass(ok);
  }
  if (const auto ok = sort(); !ok) return pass(ok);
  Bvh out;
  if (!(header_.rate_hz >= 0.1 && header_.rate_hz <= 1e5))
    return lines_.wrong("expected DataFrameRate from 0.1 to 100000");
  out.frame_time = 1.0 / header_.rate_hz;
  add_joints(out);
  add_frames(out);
  add_ends(out);
  if (out.frames.empty()) return lines_.wrong("there is no frame");
  return out;
}

Result<void> HtrReader::read_line() {
  if (section_ == "header") return read_header();
  if (section_ == "segmentnames&hierarchy") return read_parent();
  if (section_ == "baseposition") return read_rest();
  if (segments_.contains(section_)) read_motion();
  return {};
}

Result<void> HtrReader::read_axis(std::string_view word, int& axis) {
  axis = axis_of(word);
  if (axis < 0) return lines_.wrong("expected X, Y or Z");
  return {};
}

Result<void> HtrReader::read_order(std::string_view word) {
  std::array<int, 3> order{};
  for (std::size_t i = 0; i < 3; ++i) order[i] = axis_of(word.substr(std::min(i, word.size()), 1));
  std::array<int, 3> all = order;
  std::sort(all.begin(), all.end());
  if (word.size() != 3 || all != std::array<int, 3>{0, 1, 2})
    return lines_.wrong("expected an order of X, Y and Z");
  header_.order = order;
  return {};
}

Result<void> HtrReader::read_header() {
  const std::string key = lower_word(lines_.word(0));
  const std::string_view value = lines_.word(1);
  if (key == "filetype" && lower_word(value) == "htr2")
    return lines_.wrong("is HTR2, whose motion is laid out otherwise; export HTR");
  if (key == "eulerrotationorder") return read_order(value);
  if (key == "globalaxisofgravity") return read_axis(value, header_.up);
  if (key == "bonelengthaxis") return read_axis(value, header_.bone);
  if (key == "rotationunits" && lower_word(value).starts_with("rad")) header_.radians = 1.0;
  if (key == "dataframerate" && !read_finite(value, header_.rate_hz))
    return lines_.wrong("expected a number of frames a second");
  if (key != "calibrationunits") return {};
  const auto* const unit = std::find_if(kHtrUnits.begin(), kHtrUnits.end(), [&](const auto& each) {
    return each.first == lower_word(value);
  });
  if (unit == kHtrUnits.end()) return lines_.wrong("unknown unit of lengths");
  header_.metres = unit->second;
  return {};
}

Result<void> HtrReader::read_parent() {
  if (segments_.size() >= kMaxSegments) return lines_.too_large("more than 512 segments");
  const std::string name(lines_.word(0));
  if (lines_.word(1).empty()) return lines_.wrong("expected a segment and its parent");
  if (!segments_.emplace(name, HtrSegment{std::string(lines_.word(1))}).second)
    return lines_.wrong("a second segment " + name.substr(0, 40));
  return {};
}

Eigen::Quaterniond HtrReader::turn_of(const std::vector<double>& numbers) const {
  Eigen::Quaterniond out = Eigen::Quaterniond::Identity();
  for (const int axis : header_.order)
    out = out * Eigen::AngleAxisd(header_.radians * numbers[3 + static_cast<std::size_t>(axis)],
                                  Eigen::Vector3d::Unit(axis));
  return out;
}

Result<void> HtrReader::read_rest() {
  const auto found = segments_.find(std::string(lines_.word(0)));
  if (found == segments_.end()) return lines_.wrong("a segment that the hierarchy does not have");
  const auto numbers = lines_.numbers(1, kNumbers);
  if (!numbers) return pass(numbers);
  found->second.rest =
      Eigen::Translation3d(header_.metres * Eigen::Vector3d(numbers->data())) * turn_of(*numbers);
  found->second.length = header_.metres * numbers->back();
  return {};
}

void HtrReader::read_motion() {
  HtrSegment& segment = segments_[section_];
  if (segment.motion.size() >= kMaxFrames) return;
  const auto numbers = lines_.numbers(1, kNumbers);
  const bool missing = !numbers || std::any_of(numbers->begin(), numbers->end(), [](double each) {
    return std::abs(each) > kMissing;
  });
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Constant(std::nan(""));
  segment.motion.emplace_back(
      missing ? nowhere : Eigen::Vector3d(header_.metres * Eigen::Vector3d(numbers->data())),
      missing ? Eigen::Quaterniond::Identity() : turn_of(*numbers));
}

/// Parents first; every segment must hang from the one root.
Result<void> HtrReader::sort() {
  const auto below = [&](const std::string& parent) {
    for (const auto& [name, segment] : segments_)
      if (segment.parent == parent) sorted_.push_back(name);
  };
  below("GLOBAL");
  if (sorted_.empty()) return lines_.wrong("there is no segment whose parent is GLOBAL");
  if (sorted_.size() > 1)
    return lines_.wrong("several segments hang from GLOBAL; export one person a file");
  for (std::size_t i = 0; i < sorted_.size(); ++i) below(std::string(sorted_[i]));
  if (sorted_.size() != segments_.size())
    return lines_.wrong("a segment's parent is not in the hierarchy");
  return {};
}

Eigen::Matrix3d HtrReader::world_from_file() const {
  Eigen::Matrix3d out = Eigen::Matrix3d::Identity();
  if (header_.up == 2) out << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (header_.up == 0) out << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return out;
}

/// z, y and x of R = Rz * Ry * Rx.
std::array<double, 3> zyx_of(const Eigen::Matrix3d& r) {
  return {std::atan2(r(1, 0), r(0, 0)), std::asin(std::clamp(-r(2, 0), -1.0, 1.0)),
          std::atan2(r(2, 1), r(2, 2))};
}

void HtrReader::add_joints(Bvh& out) {
  for (const std::string& name : sorted_) {
    const HtrSegment& segment = segments_.at(name);
    const auto parent = std::find(sorted_.begin(), sorted_.end(), segment.parent);
    const auto at = parent == sorted_.end() ? 0 : parent - sorted_.begin();
    out.joints.push_back({name,
                          static_cast<std::size_t>(at),
                          segment.rest.translation(),
                          {0, 1, 2, 5, 4, 3},
                          out.channel_count});
    out.channel_count += out.joints.back().channels.size();
  }
}

/// The frames that all segments have.
void HtrReader::add_frames(Bvh& out) const {
  const auto shorter = [](const auto& a, const auto& b) {
    return a.second.motion.size() < b.second.motion.size();
  };
  const auto [least, most] = std::minmax_element(segments_.begin(), segments_.end(), shorter);
  const std::size_t count = least->second.motion.size();
  if (count < most->second.motion.size())
    out.notes.emplace_back("not all segments have all frames; the rest was left out");
  for (std::size_t f = 0; f < count; ++f) {
    std::vector<double> frame;
    for (const std::string& name : sorted_) {
      const HtrSegment& segment = segments_.at(name);
      const auto& [moved, turned] = segment.motion[f];
      const bool root = name == sorted_.front();
      const Eigen::Matrix3d before = root ? world_from_file() : Eigen::Matrix3d::Identity();
      const Eigen::Vector3d place = before * (segment.rest.translation() + moved);
      const auto turn = zyx_of(before * segment.rest.linear() * turned.toRotationMatrix());
      frame.insert(frame.end(), place.begin(), place.end());
      frame.insert(frame.end(), turn.begin(), turn.end());
    }
    const bool whole =
        std::all_of(frame.begin(), frame.end(), [](double v) { return std::isfinite(v); });
    out.frames.push_back(whole ? std::move(frame) : std::vector<double>());
  }
}

/// Where segments without children end.
void HtrReader::add_ends(Bvh& out) const {
  for (std::size_t i = 0; i < sorted_.size(); ++i) {
    const bool leaf = std::none_of(segments_.begin(), segments_.end(), [&](const auto& each) {
      return each.second.parent == sorted_[i];
    });
    const double length = segments_.at(sorted_[i]).length;
    if (leaf && length > 0.0)
      out.joints.push_back({sorted_[i] + " End",
                            i,
                            length * Eigen::Vector3d::Unit(header_.bone),
                            {},
                            out.channel_count});
  }
}

}  // namespace

bool looks_like_htr(std::string_view text) {
  const std::string begin = lower_word(text.substr(0, std::min<std::size_t>(4096, text.size())));
  return begin.find("[header]") != std::string::npos &&
         begin.find("eulerrotationorder") != std::string::npos;
}

Result<Bvh> parse_htr(std::string_view text, std::string_view origin) {
  if (text.size() > kMaxTextBytes)
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 64 MB");
  if (!looks_like_htr(text))
    return fail(ErrorCode::Malformed, std::string(origin),
                "is no HTR file: [Header] with EulerRotationOrder is missing");
  return HtrReader(text, origin).read();
}

}  // namespace chorus::motion
