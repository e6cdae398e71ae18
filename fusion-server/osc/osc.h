// Open Sound Control 1.0: messages of int32, float32 and string arguments, and bundles of them.
//
// Big-endian; strings end with a NUL and are padded with NULs to a multiple of four.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::osc {

class Message {
 public:
  explicit Message(std::string_view address) : address_(address) {}

  Message& integer(std::int32_t value);
  Message& real(double value);  ///< As float32; a value that is not finite is sent as 0.
  Message& text(std::string_view value);
  Message& vector(const Eigen::Vector3d& value);         ///< x y z
  Message& quaternion(const Eigen::Quaterniond& value);  ///< x y z w

  [[nodiscard]] std::vector<char> bytes() const;

 private:
  std::string address_;
  std::string types_ = ",";
  std::vector<char> arguments_;
};

/// Collects messages into bundles ("#bundle", time tag "now") of at most `limit` bytes; a message
/// longer than that gets a bundle of its own.
class Bundles {
 public:
  /// Fits an Ethernet frame with IPv6 and UDP headers.
  static constexpr std::size_t kLimit = 1400;

  explicit Bundles(std::size_t limit = kLimit) : limit_(limit) {}
  void add(const Message& message);
  [[nodiscard]] const std::vector<std::vector<char>>& all() const { return bundles_; }

 private:
  std::size_t limit_;
  std::vector<std::vector<char>> bundles_;
};

}  // namespace chorus::osc
