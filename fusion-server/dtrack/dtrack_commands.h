// DTrack's command channel (TCP 50105) without the network: takes bytes, gives answers.
//
// A command, and an answer, is one ASCII string of at most 200 bytes that ends with NUL.  Commands:
//   dtrack2 get system access          -> dtrack2 set system access full | none
//   dtrack2 tracking start | stop      -> dtrack2 ok
//   dtrack2 get status active          -> dtrack2 set status active mea | none
//   dtrack2 get config active_config   -> dtrack2 set config active_config standard
//   dtrack2 getmsg                     -> dtrack2 ok              (there are never messages)
//   dtrack2 set ...                    -> dtrack2 ok              (and nothing changes)
//   anything else                      -> dtrack2 err 1 "..."
// Only the connection in control may start, stop and set; others get err 2.  No command can
// redirect the data: the targets are configured.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace chorus::dtrack {

inline constexpr std::size_t kMaxCommandBytes = 200;  ///< Without the NUL.

/// Splits a stream into commands.
class CommandReader {
 public:
  /// Takes bytes; false if a command is too long: then the stream cannot be read any further.
  [[nodiscard]] bool feed(std::string_view bytes);
  /// Puts the next whole command into `command`, without its NUL; false if there is none yet.
  [[nodiscard]] bool next(std::string& command);

 private:
  std::string bytes_;
};

/// State shared by all connections.
struct Device {
  bool measuring = false;  ///< Started and not stopped.
};

struct Conversation {
  bool in_control = false;   ///< True for the oldest connection.
  std::size_t answered = 0;  ///< Commands that were known and permitted.
  std::size_t refused = 0;   ///< All other commands.
};

/// The answer, including its NUL.
[[nodiscard]] std::string answer(std::string_view command, Conversation& conversation,
                                 Device& device);

}  // namespace chorus::dtrack
