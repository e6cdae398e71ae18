#include "common/http/event_loop.h"

#include <exception>

#include "common/base/log.h"

namespace chorus::http {

void run_events(net::io_context& io, std::string_view failure,
                const std::function<void()>& prepare) {
  while (true) {
    try {
      if (prepare) prepare();
      io.run();
      return;
    } catch (const std::exception& thrown) {
      log::error(failure, {{"what", thrown.what()}});
      io.restart();  // It takes itself for done when that handler was all that was under way.
    }
  }
}

}  // namespace chorus::http
