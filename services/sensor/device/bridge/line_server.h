// Dialogues over a local (Unix domain) socket, one message per line.  Every program that may open
// the socket's file may use it; its mode is 0660.  The server has its own thread.
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
  /// Replaces a socket that an ended program left; Io when the path is something else, or another
  /// program listens there.
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
