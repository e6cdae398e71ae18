#include "common/net/event_loop.h"

#include <exception>

#include "common/base/log.h"

namespace chorus::net {

void run_events(asio::io_context& io, std::string_view failure,
                const std::function<void()>& prepare) {
  while (true) {
    try {
      if (prepare) prepare();
      io.run();
      return;
    } catch (const std::exception& thrown) {
      log::error(failure, {{"what", thrown.what()}});
      io.restart();  // io_context has stopped if the handler that threw was its last work.
    }
  }
}

}  // namespace chorus::net
