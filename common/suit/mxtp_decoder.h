// From the datagrams of an Xsens MVN stream to the poses of people in suits.
//
// Types 02 (quaternions; metres, z up, x ahead) and 01 (Euler angles; centimetres, y up) carry
// segments, 12 a person's name, 13 the points of the person's null pose, from which head and hands
// get their size; other types are ignored.  Of type 01 only the positions are used, because our
// joints get their orientations from them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "common/base/result.h"
#include "common/motion/mvnx.h"
#include "common/suit/mxtp_datagram.h"

namespace chorus::suit {

/// One person at one instant.
struct MxtpPose {
  int character = 0;
  std::string name;  ///< From type 12; empty if none was sent.
  std::uint32_t sample = 0;
  std::uint32_t time_ms = 0;  ///< By the suit's clock, since its measurement began.
  /// Our joints where the suit says they are: metres, y up, the person faces +z at heading 0.
  Skeleton<WorldSpace> body;
};

/// Joins the parts of samples and decodes them.  Bounded whatever comes: at most kMostCharacters
/// people, one unfinished sample of each.  Not thread-safe.
class MxtpDecoder {
 public:
  static constexpr std::size_t kMostCharacters = 8;

  /// A pose when this datagram completes one, else none.  Malformed: not MXTP, or numbers that no
  /// suit sends (not finite, farther than 10 km, a quaternion whose norm is not 1); TooLarge: a
  /// ninth person.  The decoder stays usable after an error.
  [[nodiscard]] Result<std::optional<MxtpPose>> take(std::span<const char> bytes);

  /// Samples of which a part was missing when the next one came.
  [[nodiscard]] std::uint64_t incomplete() const { return incomplete_; }

 private:
  struct Character {
    std::string name;
    motion::Mvnx mvnx;  ///< Segments with their points, and one frame.
    std::uint32_t sample = 0;
    std::uint32_t parts = 0;     ///< Bit set: part has come.
    std::optional<int> last{};   ///< Number of the last part.
    std::uint32_t segments = 0;  ///< Bit set: the segment has come in this sample.
    bool finished = true;
    std::optional<std::uint32_t> done{};  ///< The sample that was finished last.
  };

  [[nodiscard]] Result<Character*> character(int id);
  [[nodiscard]] Result<std::optional<MxtpPose>> segments(const MxtpDatagram& datagram,
                                                         Character& person);
  void begin(const MxtpDatagram& datagram, Character& person);

  std::map<int, Character> people_;
  std::uint64_t incomplete_ = 0;
};

}  // namespace chorus::suit
