// Internal to common/resource: steps over text that is expected byte for byte.
//
// The template readers share these steps.  Each step returns false at anything unexpected; then a
// parser has to read the document from the start.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/resource/decimal_reader.h"
#include "common/resource/frame_resource.h"
#include "common/resource/frame_shares.h"
#include "common/time/timestamp.h"

namespace chorus::resource {

class TemplateText {
 public:
  explicit TemplateText(std::string_view text) : at_(text.data()), end_(at_ + text.size()) {}

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  [[nodiscard]] const char* here() const { return at_; }
  [[nodiscard]] std::string_view rest() const {
    return {at_, static_cast<std::size_t>(end_ - at_)};
  }
  void skip(std::size_t bytes) { at_ += bytes; }

  bool text(std::string_view expected) {
    if (static_cast<std::size_t>(end_ - at_) < expected.size()) return false;
    if (std::memcmp(at_, expected.data(), expected.size()) != 0) return false;
    at_ += expected.size();
    return true;
  }

  /// The same for a literal, whose size is known when compiling.
  template <std::size_t kSize>
  bool text(const char (&expected)[kSize]) {
    constexpr std::size_t kBytes = kSize - 1;
    if (static_cast<std::size_t>(end_ - at_) < kBytes) return false;
    if (std::memcmp(at_, expected, kBytes) != 0) return false;
    at_ += kBytes;
    return true;
  }

  /// An integer that is not negative and has no leading zeros.
  template <class Integer>
  bool integer(Integer& out) {
    const char* const begin = at_;
    const auto [next, code] = std::from_chars(at_, end_, out);
    if (code != std::errc{} || out < 0 || (*begin == '0' && next - begin > 1)) return false;
    at_ = next;
    return true;
  }

  /// Decimals separated by `comma`, up to `close`: a joint's shares.
  bool shares(std::string_view comma, std::string_view close, const ShareList& list,
              JointResource& joint);

  /// A decimal such as "-1.2345", at most kMaxCoordinate in size; `out` gets the nearest double.
  bool decimal(double& out);

  /// The same, fastest for a value below ten with `kDecimals` decimals: nearly all are.
  template <int kDecimals>
  bool decimal(double& out) {
    const char* const next = read_short_fixed<kDecimals>(at_, end_, out);
    if (next == nullptr) return decimal(out);
    at_ = next;
    return true;
  }

  /// A name of [A-Za-z0-9_-] in quotes, such as an id.
  bool name(std::string_view& out);

  /// The same without quotes, at most 32 characters.
  bool word(std::string_view& out);

  /// What stands before `close` in the IRI of a document's frame: "", "../", "sensors/s1/".
  bool folder(std::string_view close, std::string_view& out);

  /// An instant as ISO 8601, then `between`, then the same instant in nanoseconds.
  bool times(std::string_view between, Timestamp& out);

  /// Distinct names in quotes, separated by `comma`, at most kMaxSensors.
  bool names(std::string_view comma, std::vector<std::string>& out);

  /// Sets a bit for each of `names` that follows in quotes, separated by `comma`.
  bool subset(const std::vector<std::string>& names, std::string_view comma, std::uint64_t& bits);

 private:
  const char* at_;
  const char* const end_;
  std::string_view iso_;  ///< The last time read; most times repeat it.
  Timestamp iso_time_;
};

}  // namespace chorus::resource
