// Dialogues over a local (Unix domain) socket, one message per line.  Whoever may open the socket's
// file may speak: its mode is 0660.  It has a thread of its own.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/http/dialogue.h"

namespace chorus::bridge {

struct LineServerOptions {
  std::string path;
  http::Opener open;
  std::size_t max_line_bytes = 256 * 1024;  ///< A client that sends a longer line is disconnected.
};

class LineServer {
 public:
  /// Replaces a socket that an ended program left behind; Io when the path is anything else, or
  /// another program listens there.
  [[nodiscard]] static Result<std::unique_ptr<LineServer>> start(LineServerOptions options);
  ~LineServer();  ///< Joins the thread and removes the socket.
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;

 private:
  LineServer();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::bridge
