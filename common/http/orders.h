// What a conversation orders its Asio shell (http_connection.h) to do.
#pragma once

namespace chorus::http {

/// The shell carries out the orders in the sequence of these fields.
struct Orders {
  bool small_queue = false;   ///< Keep the kernel's send queue small from now on.
  bool stop_waiting = false;  ///< Stop waiting for the entry's next version.
  bool upgrade = false;       ///< Hand the socket and handshake() to the reaction's WebSocket.
  bool close = false;
  bool half_close = false;  ///< Shut down sending; close() if that fails.
  bool read = false;        ///< Read some bytes into room(), then call received() or input_ended().
  bool write = false;       ///< Write all of output(), then call sent() or send_failed().
  bool at_once = false;     ///< With `write`: if all of it can be sent now, do so and call sent().
  bool settle = false;      ///< Call settled() as soon as the kernel's send queue is small.
  bool wait = false;        ///< Register for the entry's next version, then call look().
};

}  // namespace chorus::http
