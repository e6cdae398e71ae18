#include "common/resource/orientations_scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "common/resource/inertial_members.h"

namespace chorus::resource {
namespace {

using inertial::InertialFrame;
using inertial::InertialReading;

constexpr std::size_t kMostScanned = 2'000'000;  // bytes, as the parser's limit
constexpr std::int64_t kLatestScannedNs = 9'000'000'000'000'000'000;

/// Reads JSON from front to back; false where there is not what was asked for.
class JsonCursor {
 public:
  explicit JsonCursor(std::string_view text) : at_(text.data()), end_(at_ + text.size()) {}

  bool take(char c) {
    space();
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }
  /// Printable ASCII without escapes.
  bool string(std::string_view& out) {
    if (!take('"')) return false;
    const char* const begin = at_;
    while (at_ != end_ && *at_ >= 0x20 && *at_ < 0x7f && *at_ != '"' && *at_ != '\\') ++at_;
    if (at_ == end_ || *at_ != '"') return false;
    out = {begin, static_cast<std::size_t>(at_ - begin)};
    ++at_;
    return true;
  }
  bool number(double& out) {
    space();
    const char* const digits = at_ != end_ && *at_ == '-' ? at_ + 1 : at_;
    if (!is_whole_part(digits)) return false;
    const auto [next, failed] = std::from_chars(at_, end_, out);
    const char* const point = std::find(at_, next, '.');
    if (failed != std::errc{} || (point != next && !is_digit(point + 1))) return false;
    at_ = next;
    return std::abs(out) <= kLargestMember;
  }
  bool count(std::uint64_t& out) {
    space();
    if (!is_whole_part(at_)) return false;
    const auto [next, failed] = std::from_chars(at_, end_, out);
    const bool whole =
        failed == std::errc{} && (next == end_ || (*next != '.' && *next != 'e' && *next != 'E'));
    at_ = next;
    return whole;
  }
  /// Nanoseconds as a string of digits.
  bool time(Timestamp& out) {
    std::string_view digits;
    std::int64_t ns = -1;
    if (!string(digits)) return false;
    const auto [next, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), ns);
    if (failed != std::errc{} || next != digits.data() + digits.size()) return false;
    out = from_unix_ns(ns);
    return ns >= 0 && ns <= kLatestScannedNs;
  }
  /// An object's members; `member` reads the value of a key.
  template <class Member>
  bool object(const Member& member) {
    if (!take('{')) return false;
    if (take('}')) return true;
    do {
      std::string_view key;
      if (!string(key) || !take(':') || !member(key)) return false;
    } while (take(','));
    return take('}');
  }
  [[nodiscard]] bool at_end() {
    space();
    return at_ == end_;
  }

 private:
  void space() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')) ++at_;
  }
  /// A digit, and no zero before another one.
  [[nodiscard]] bool is_whole_part(const char* at) const {
    return is_digit(at) && !(*at == '0' && is_digit(at + 1));
  }
  [[nodiscard]] bool is_digit(const char* at) const {
    return at != end_ && *at >= '0' && *at <= '9';
  }

  const char* at_;
  const char* end_;
};

/// A key that may come once.
class Once {
 public:
  bool operator()(std::size_t key) {
    const std::uint64_t bit = std::uint64_t{1} << key;
    return (std::exchange(seen_, seen_ | bit) & bit) == 0;
  }
  [[nodiscard]] bool all_of(std::size_t first, std::size_t count) const {
    const std::uint64_t bits = ((std::uint64_t{1} << count) - 1) << first;
    return (seen_ & bits) == bits;
  }
  [[nodiscard]] bool none_of(std::size_t first, std::size_t count) const {
    return (seen_ & (((std::uint64_t{1} << count) - 1) << first)) == 0;
  }

 private:
  std::uint64_t seen_ = 0;
};

// The numbers of a reading: quaternion, covariance, four vectors, battery.
constexpr std::size_t kCovarianceAt = 4;
constexpr std::size_t kVectorsAt = kCovarianceAt + 6;
constexpr std::size_t kBatteryAt = kVectorsAt + 3 * kVectors.size();
constexpr std::size_t kNumbers = kBatteryAt + 1;
enum TextKey : std::size_t { kTypeKey = kNumbers, kTextTime, kTimeKey, kLimbKey, kMagneticKey };

constexpr std::array<std::string_view, kNumbers> number_keys() {
  std::array<std::string_view, kNumbers> out;
  std::size_t at = 0;
  for (const char* key : kQuaternion) out[at++] = key;
  for (const char* key : kCovariance) out[at++] = key;
  for (const VectorField& field : kVectors)
    for (const char* key : field.keys) out[at++] = key;
  out[at] = "battery";
  return out;
}
constexpr auto kNumberKeys = number_keys();

class OrientationsScan {
 public:
  explicit OrientationsScan(std::string_view json) : in_(json) {}

  std::optional<OrientationsResource> run() {
    Once once;
    const bool whole = in_.object([&](std::string_view key) { return head(key, once); });
    if (!whole || !in_.at_end() || !once.all_of(0, 5)) return std::nullopt;
    const auto source = SensorId::parse(out_.source);
    if (!source || out_.instants.back().captured != out_.captured) return std::nullopt;
    for (InertialFrame& frame : out_.instants) {
      frame.source = *source;
      auto checked = inertial::checked(std::move(frame));
      if (!checked) return std::nullopt;
      frame = std::move(*checked);
    }
    return std::move(out_);
  }

 private:
  bool head(std::string_view key, Once& once) {
    std::string_view text;
    if (key == "@type") return once(0) && in_.string(text) && text == "Orientations";
    if (key == "sequence") return once(1) && in_.count(out_.sequence);
    if (key == "capturedNanoseconds") return once(2) && in_.time(out_.captured);
    if (key == "source") {
      const bool read = once(3) && in_.string(text);
      out_.source = text;
      return read;
    }
    if (key == "instants") return once(4) && instants();
    if (key == "captured") return once(5) && in_.string(text);
    return key == "@id" && once(6) && in_.string(text);
  }

  bool instants() {
    if (!in_.take('[')) return false;
    do {
      if (out_.instants.size() == kMaxInstants || !instant(out_.instants.emplace_back()))
        return false;
      const std::size_t count = out_.instants.size();
      if (count > 1 && out_.instants[count - 1].captured <= out_.instants[count - 2].captured)
        return false;
    } while (in_.take(','));
    return in_.take(']');
  }

  bool instant(InertialFrame& frame) {
    Once once;
    std::string_view text;
    const bool whole = in_.object([&](std::string_view key) {
      if (key == "sequence") return once(0) && in_.count(frame.sequence);
      if (key == "capturedNanoseconds") return once(1) && in_.time(frame.captured);
      if (key == "readings") return once(2) && readings(frame.readings);
      if (key == "captured") return once(3) && in_.string(text);
      return key == "@type" && once(4) && in_.string(text);
    });
    return whole && once.all_of(0, 3);
  }

  /// In the order of their names, as the parser has them.
  bool readings(std::vector<InertialReading>& out) {
    out.reserve(expected_);
    const bool whole = in_.object([&](std::string_view sensor) {
      InertialReading& one = out.emplace_back();
      one.sensor = sensor;
      return reading(one);
    });
    expected_ = out.size();
    if (!std::ranges::is_sorted(out, {}, &InertialReading::sensor))
      std::ranges::sort(out, {}, &InertialReading::sensor);
    return whole;
  }

  bool reading(InertialReading& out) {
    Once once;
    std::array<double, kNumbers> numbers{};
    next_ = 0;
    const bool whole = in_.object([&](std::string_view key) {
      if (const auto at = number_at(key)) return once(*at) && in_.number(numbers[*at]);
      return text_member(key, once, out);
    });
    return whole && once.all_of(kTimeKey, 1) && put(numbers, once, out);
  }

  /// Which number this key is; keys come in the order of the table.
  std::optional<std::size_t> number_at(std::string_view key) {
    for (std::size_t i = 0; i < kNumbers; ++i) {
      const std::size_t at = (next_ + i) % kNumbers;
      if (kNumberKeys[at] != key) continue;
      next_ = at + 1;
      return at;
    }
    return std::nullopt;
  }

  bool text_member(std::string_view key, Once& once, InertialReading& out) {
    std::string_view text;
    if (key == "capturedNanoseconds") return once(kTimeKey) && in_.time(out.captured);
    if (!in_.string(text)) return false;
    if (key == "@type") return once(kTypeKey);
    if (key == "captured") return once(kTextTime);
    if (key == "limb") {
      out.limb = inertial::limb_named(text);
      return once(kLimbKey) && out.limb;
    }
    if (key != "magneticState") return false;
    const auto known = inertial::magnetic_state_named(text);
    out.magnetic = known.value_or(out.magnetic);
    return once(kMagneticKey) && known;
  }

  /// All components of a value or none.
  static bool put(const std::array<double, kNumbers>& n, const Once& once, InertialReading& out) {
    if (once.all_of(0, 4))
      out.inertial_from_sensor = Eigen::Quaterniond(n[3], n[0], n[1], n[2]);
    else if (!once.none_of(0, 4))
      return false;
    if (once.all_of(kCovarianceAt, 6)) {
      Eigen::Matrix3d& c = out.covariance.emplace();
      for (std::size_t i = 0; i < kTriangle.size(); ++i) {
        const auto [row, column] = kTriangle[i];
        c(row, column) = c(column, row) = n[kCovarianceAt + i];
      }
      if (!(c.diagonal().minCoeff() >= 0.0)) return false;
    } else if (!once.none_of(kCovarianceAt, 6)) {
      return false;
    }
    for (std::size_t v = 0; v < kVectors.size(); ++v) {
      const std::size_t at = kVectorsAt + 3 * v;
      if (once.all_of(at, 3))
        out.*kVectors[v].value = Eigen::Vector3d(n[at], n[at + 1], n[at + 2]);
      else if (!once.none_of(at, 3))
        return false;
    }
    if (once.all_of(kBatteryAt, 1)) out.battery = n[kBatteryAt];
    return true;
  }

  JsonCursor in_;
  OrientationsResource out_;
  std::size_t expected_ = 0;  ///< Readings of the instant before.
  std::size_t next_ = 0;      ///< Of kNumberKeys.
};

}  // namespace

std::optional<OrientationsResource> scan_orientations(std::string_view json) {
  if (json.size() > kMostScanned) return std::nullopt;
  return OrientationsScan(json).run();
}

}  // namespace chorus::resource
