// Dialogues over a local (Unix domain) socket, one message per line.  The socket's file has mode
// 0660: every program that may open it may use it.  The server has its own thread.
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
  /// Who sends more than this without an end of line is disconnected.  The length of whole messages
  /// is for the dialogue to judge.
  std::size_t max_line_bytes = 256 * 1024;
};

class LineServer {
 public:
  /// Replaces a socket that an ended program left behind.  Io when the path is something else, or
  /// when another program listens there.
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
