// The parameters of a C3D file: named values in groups.  Private to this folder's .cpp files.
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::motion {

inline constexpr std::size_t kC3dBlock = 512;

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

/// In capitals, without blanks at the end.
[[nodiscard]] std::string upper(std::string_view text);

class C3dParameters {
 public:
  /// Refuses files that are no C3D, and parameters that reach beyond their part of the file.
  [[nodiscard]] static Result<C3dParameters> read(std::string_view bytes, std::string_view origin);

  /// Element i of the number with this name, such as "POINT:RATE"; none if there is none.
  [[nodiscard]] std::optional<double> number(const std::string& name, std::size_t i = 0) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& name) const;
  [[nodiscard]] bool has_group(std::string_view name) const;
  [[nodiscard]] Numbers numbers() const { return {bytes_, processor_}; }
  [[nodiscard]] std::string processor_name() const;

 private:
  C3dParameters(std::string_view bytes, std::string_view origin) : bytes_(bytes), origin_(origin) {}

  struct Parameter {
    int type = 0;  ///< Bytes per element: 1, 2, 4 (float) or -1 (text).
    std::vector<std::size_t> dimensions;
    std::size_t at = 0;     ///< File offset of its first element.
    std::size_t count = 0;  ///< Number of elements.
  };

  struct Entry {
    int group = 0;
    std::string name;
    Parameter parameter;
  };

  Result<void> read_processor();
  Result<void> read_parameters();
  Result<std::size_t> read_entry(std::size_t at, std::size_t end);
  [[nodiscard]] Result<Parameter> read_parameter(std::size_t at, std::size_t end) const;
  [[nodiscard]] tl::unexpected<Error> wrong(std::string message) const {
    return fail(ErrorCode::Malformed, origin_, std::move(message));
  }

  std::string_view bytes_;
  std::string origin_;
  std::size_t parameters_at_ = 0;
  Processor processor_ = kIntel;
  std::map<int, std::string> groups_;
  std::vector<Entry> entries_;
  std::map<std::string, Parameter> parameters_;  ///< By group and name.
};

}  // namespace chorus::motion
