#include "common/base/line_writer.h"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <condition_variable>
#include <csignal>
#include <ctime>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

namespace chorus {
namespace {

constexpr int kLookMs = 1000;  // Interval at which a blocked writer checks `ended` [ms].

/// While this exists, new threads start with all signals blocked, so that only the program's other
/// threads handle signals.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

}  // namespace

struct LineWriter::State {
  explicit State(LineWriterOptions o) : options(std::move(o)) {}

  void run();
  bool write_out(std::string_view bytes);
  void write_line(const std::string& text);
  void tell(std::uint64_t missing);

  struct Line {
    std::string text;
    std::uint64_t missing_before = 0;  ///< Lines dropped just before this one.
  };

  const LineWriterOptions options;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Line> waiting;           ///< Guarded by mutex.
  std::uint64_t missing_last = 0;      ///< Lines dropped after `waiting`; guarded by mutex.
  std::uint64_t untold = 0;            ///< Dropped lines not yet reported; writer's thread only.
  std::atomic<std::size_t> bytes = 0;  ///< Bytes waiting or being written.
  std::atomic<std::uint64_t> dropped = 0;
  /// Grows whenever the reader takes some bytes, and whenever a line is finished or lost.
  std::atomic<std::uint64_t> progress = 0;
  std::atomic<bool> ended = false;
};

/// Writes everything; false if the reader is gone, or the writer is no longer needed.
bool LineWriter::State::write_out(std::string_view rest) {
  while (!rest.empty() && !ended) {
    pollfd ready{options.descriptor, POLLOUT, 0};
    if (::poll(&ready, 1, kLookMs) <= 0 || ended) continue;
    // Writes at most as much as a pipe takes at once, so that no write blocks halfway.
    const ssize_t taken =
        ::write(options.descriptor, rest.data(), std::min<std::size_t>(rest.size(), PIPE_BUF));
    if (taken < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (taken < 0) return false;
    rest.remove_prefix(static_cast<std::size_t>(taken));
    ++progress;
  }
  return rest.empty();
}

void LineWriter::State::write_line(const std::string& text) {
  if (!write_out(text)) {
    ++dropped;
    ++untold;
  }
  bytes -= text.size();
  ++progress;
}

void LineWriter::State::tell(std::uint64_t missing) {
  untold += missing;
  if (untold > 0 && options.gap && write_out(options.gap(untold))) untold = 0;
}

void LineWriter::State::run() {
  std::vector<Line> batch;
  std::unique_lock lock(mutex);
  while (true) {
    changed.wait(lock, [&] { return !waiting.empty() || missing_last > 0 || ended; });
    if (ended && waiting.empty()) return;
    batch.clear();
    batch.swap(waiting);
    const std::uint64_t missing_behind = std::exchange(missing_last, 0);
    lock.unlock();
    for (const Line& line : batch) {
      tell(line.missing_before);
      write_line(line.text);
    }
    tell(missing_behind);
    lock.lock();
    changed.notify_all();
  }
}

LineWriter::LineWriter(LineWriterOptions options)
    : state_(std::make_shared<State>(std::move(options))) {
  const SignalsBlocked blocked;
  std::thread([state = state_] { state->run(); }).detach();
}

LineWriter::~LineWriter() {
  const std::scoped_lock lock(state_->mutex);
  state_->ended = true;
  state_->changed.notify_all();
}

void LineWriter::write(std::string line) {
  const std::scoped_lock lock(state_->mutex);
  if (state_->bytes + line.size() > state_->options.most_bytes) {
    ++state_->dropped;
    ++state_->missing_last;
    return;
  }
  state_->bytes += line.size();
  state_->waiting.push_back({std::move(line), std::exchange(state_->missing_last, 0)});
  state_->changed.notify_all();
}

bool LineWriter::flush(std::chrono::milliseconds patience) {
  std::unique_lock lock(state_->mutex);
  while (state_->bytes > 0) {
    const std::uint64_t before = state_->progress;
    const bool done = state_->changed.wait_for(lock, patience, [&] { return state_->bytes == 0; });
    if (!done && state_->progress == before) return false;
  }
  return true;
}

void LineWriter::flush_in_signal_handler(std::chrono::milliseconds patience) const noexcept {
  constexpr long kLookNs = 2'000'000;
  const timespec look{0, kLookNs};
  const auto looks = std::chrono::nanoseconds(patience).count() / kLookNs;
  for (long i = 0; i < looks && state_->bytes > 0; ++i) ::nanosleep(&look, nullptr);
}

std::uint64_t LineWriter::dropped() const noexcept { return state_->dropped; }

}  // namespace chorus
