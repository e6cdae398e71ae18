// Internal to common/resource: code that the frame writers share.
#pragma once

#include <array>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/resource/fixed_point.h"
#include "common/resource/frame_resource.h"

namespace chorus::resource {

/// Decimals on the wire (proto/README.md).  Of positions [m]: 0.1 mm; of variances [m^2]: (0.1
/// mm)^2.
inline constexpr int kPositionDecimals = 4;
inline constexpr int kQuaternionDecimals = 5;
inline constexpr int kVarianceDecimals = 8;
inline constexpr int kConfidenceDecimals = 4;
inline constexpr int kRayDecimals = 6;
inline constexpr int kTimeDecimals = 3;
/// Largest `carriedFor` that is written or accepted [s].
inline constexpr double kLongestCarry = 3600.0;

/// The terms of a covariance on the wire, in the order of Covariance::term().
inline constexpr std::array<std::string_view, Covariance::kTerms> kCovarianceNames{
    "cxx", "cxy", "cxz", "cyy", "cyz", "czz"};

/// A joint ready for writing: finite and plausible, or else not tracked.
struct WritableJoint {
  JointState state = JointState::NotTracked;
  bool has_orientation = false;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  std::optional<double> variance;
  bool ray = false;  ///< True if `position` is a direction.
  Covariance covariance;
};
[[nodiscard]] WritableJoint writable(const JointResource& joint);

/// Clamps to [0, 1]; NaN counts as no confidence.
[[nodiscard]] double writable_confidence(double value);

/// Clamps to [0, kLongestCarry]; NaN becomes 0.
[[nodiscard]] double writable_time(double value);

/// `text` in quotes, with the escapes that Turtle and JSON share; broken UTF-8 is replaced.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// The names of all sensors, in quotes.
[[nodiscard]] std::vector<std::string> quoted_names(const FrameResource& frame);

/// Appends to a text without checks: callers reserve the room with need() first.
///
/// The memory is the thread's and serves for the next text, too: getting some 100 kB from the
/// system for each took longer than filling them.  What take() returns is as large as it has to be.
class Pen {
 public:
  explicit Pen(std::size_t expected) : text_(std::exchange(spare(), {})), at_(text_.data()) {
    need(expected);
  }
  ~Pen() { spare() = std::move(text_); }
  Pen(const Pen&) = delete;
  Pen& operator=(const Pen&) = delete;

  void need(std::size_t bytes) {
    const auto used = static_cast<std::size_t>(at_ - text_.data());
    if (text_.size() - used >= bytes) return;
    text_.resize(text_.size() * 2 + bytes);
    at_ = text_.data() + used;
  }
  void put(std::string_view text) {
    if (text.empty()) return;  // memcpy must not get a null pointer, not even for 0 bytes.
    std::memcpy(at_, text.data(), text.size());
    at_ += text.size();
  }
  template <std::size_t kSize>
  void put(const char (&text)[kSize]) {
    std::memcpy(at_, text, kSize - 1);
    at_ += kSize - 1;
  }
  template <int kDecimals>
  void put_decimal(double value) {
    at_ = write_fixed<kDecimals>(at_, value);
  }
  template <class Integer>
  void put_integer(Integer value) {
    constexpr int kLongest = 20;  // The digits and the sign of 64 bits.
    at_ = std::to_chars(at_, at_ + kLongest, value).ptr;
  }
  [[nodiscard]] std::string take() {
    const std::string text(text_.data(), at_);
    at_ = text_.data();
    return text;
  }

 private:
  static std::vector<char>& spare() {
    thread_local std::vector<char> bytes;
    return bytes;
  }

  std::vector<char> text_;
  char* at_;
};

/// Formats instants as dateTime; keeps the last result, because most bodies have the frame's time.
class TimeText {
 public:
  [[nodiscard]] std::string_view of(Timestamp t) {
    if (text_.empty() || t != last_) {
      last_ = t;
      text_ = to_iso8601(t);
    }
    return text_;
  }

 private:
  Timestamp last_;
  std::string text_;
};

[[nodiscard]] std::string_view name_of(JointState state);
[[nodiscard]] std::string_view name_of(SpaceKind space);

/// Upper bounds of the bytes of one body, and of one joint without its names.
inline constexpr std::size_t kBodyBytes = 16384;
inline constexpr std::size_t kJointBytes = 1024;

[[nodiscard]] std::string write_turtle(const FrameResource& frame, const Place& place);
[[nodiscard]] std::string write_json(const FrameResource& frame, bool linked, const Place& place);
[[nodiscard]] std::string write_turtle_skeleton(const FrameResource& frame,
                                                const BodyResource& body, const Place& place);
[[nodiscard]] std::string write_json_skeleton(const FrameResource& frame, const BodyResource& body,
                                              bool linked, const Place& place);
[[nodiscard]] std::string to_ntriples(const std::string& turtle, const Place& place);

}  // namespace chorus::resource
