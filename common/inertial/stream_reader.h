// A live source's bytes, put together into what its sensors say: one protocol a file.
//
// No sockets and no clocks: bytes and times go in, instants come out.  These sources have a pose of
// the maker's own skeleton, so a "sensor" is a segment of that, and its orientation turns the
// segment's axes at rest into the source's world.  They stamp nothing that is on our clock: a
// reading's time is that of its arrival.
#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "common/base/result.h"
#include "common/inertial/inertial_frame.h"

namespace chorus::inertial {

class StreamReader {
 public:
  virtual ~StreamReader() = default;

  /// Takes a datagram, or some bytes of a connection.  An error says what was wrong with it and
  /// costs that datagram alone.
  [[nodiscard]] virtual Result<void> take(std::string_view bytes, Timestamp now) = 0;
  /// What has been said since the last call; none if nothing.  Who asks seldom asks until there is
  /// none: where segments spoke several times, each time is an instant.
  [[nodiscard]] virtual std::optional<InertialFrame> instant(Timestamp now) = 0;
  /// A new connection: forgets what was cut off.
  virtual void restart() {}

 protected:
  StreamReader() = default;
  StreamReader(const StreamReader&) = default;
  StreamReader& operator=(const StreamReader&) = default;
};

/// Longest datagram that any reader takes [bytes]: that of UDP.
inline constexpr std::size_t kMaxStreamDatagram = 65'507;

}  // namespace chorus::inertial
