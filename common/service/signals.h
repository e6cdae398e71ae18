// Signals that end a program, for main threads that wait for them.
#pragma once

#include <csignal>
#include <initializer_list>

namespace chorus::service {

/// Blocks these signals for this thread and all that it starts later, so that sigwait() gets them;
/// call it before any thread starts.  Returns the set for sigwait().
[[nodiscard]] inline sigset_t block_signals(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  return set;
}

}  // namespace chorus::service
