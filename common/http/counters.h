// What a server counts while it serves.
#pragma once

#include <atomic>
#include <cstdint>

namespace chorus::http {

/// The ServerCounters in a form that other threads may read while the server's thread counts.
struct AtomicCounters {
  using Count = std::atomic<std::uint64_t>;
  Count requests = 0, refused = 0, not_modified = 0, connections_total = 0, connections_open = 0,
        long_polls_waiting = 0, event_streams_open = 0, websockets_open = 0, events_skipped = 0,
        bytes_sent = 0, downloads_open = 0, unauthorized = 0, held = 0, closed_for_room = 0,
        handshakes_failed = 0, connections_limit = 0;
};

/// Adds to a counter.  Only one thread writes, so a plain load and store suffice; they are cheaper
/// than a locked add.
inline void count(AtomicCounters::Count& counter, std::uint64_t by = 1) {
  counter.store(counter.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
}

/// Subtracts 1 from a counter of things that are open or under way.
inline void uncount(AtomicCounters::Count& counter) {
  count(counter, static_cast<std::uint64_t>(-1));
}

}  // namespace chorus::http
