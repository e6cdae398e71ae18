// The outer form of Xsens MVN's network stream: datagrams, alone (UDP) or one after another (TCP).
//
// All numbers are big-endian.  A datagram is a header of 24 bytes (magic "MXTP" and two digits for
// the type, sample counter, part, items, time code, character, counts, payload size) and items.
// Nothing here allocates by what the bytes announce.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::suit {

enum class MxtpType : std::uint8_t { Euler = 1, Quaternion = 2, Meta = 12, Scale = 13 };

struct MxtpDatagram {
  int type = 0;              ///< One of MxtpType, or another that is not read.
  std::uint32_t sample = 0;  ///< Counts samples; the parts of one sample share it.
  int part = 0;              ///< Number of this datagram within its sample, from 0.
  bool last = true;          ///< True for the sample's last part.
  int items = 0;             ///< Number of items in this datagram.
  std::uint32_t time_ms = 0;
  int character = 0;
  std::span<const char> payload;  ///< Points into the bytes that were read.
};

inline constexpr std::size_t kMxtpHeaderBytes = 24;
/// Largest datagram that is accepted: that of UDP.
inline constexpr std::size_t kMaxMxtpBytes = 65'507;

/// Reads one datagram.  Malformed: no MXTP, cut off, or fewer bytes than its items need.
[[nodiscard]] Result<MxtpDatagram> read_mxtp(std::span<const char> bytes);

/// Cuts a TCP stream into datagrams.  Not thread-safe.
class MxtpStream {
 public:
  /// Adds what was received.  At most 4 * kMaxMxtpBytes wait; TooLarge when nobody takes them.
  [[nodiscard]] Result<void> add(std::span<const char> bytes);
  /// The bytes of the next whole datagram; none when more bytes are needed.  Malformed where none
  /// can begin: a stream cannot recover from that.
  [[nodiscard]] Result<std::optional<std::vector<char>>> next();

 private:
  std::vector<char> waiting_;
};

}  // namespace chorus::suit
