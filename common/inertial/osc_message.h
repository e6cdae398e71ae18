// Open Sound Control 1.0, read: messages, alone or in bundles.
//
// Big-endian; strings end with a NUL and are padded with NULs to a multiple of four.
#pragma once

#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::inertial {

struct OscMessage {
  std::string_view address;             ///< Points into the packet, as the texts do.
  std::vector<double> numbers;          ///< i, f, h and d, in order.
  std::vector<std::string_view> texts;  ///< s, in order.
};

/// All messages of a packet.  Malformed: cut off, not padded, a type that is not known, bundles in
/// bundles more than four deep; TooLarge: longer than UDP's datagrams, or more than 1000 messages.
[[nodiscard]] Result<std::vector<OscMessage>> parse_osc(std::string_view packet);

}  // namespace chorus::inertial
