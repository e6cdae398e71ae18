#include "services/ctl/line/child_processes.h"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <system_error>

#include <fmt/format.h>

namespace chorus::ctl {
namespace {

constexpr int kExecFailed = 127;  // the exit code of a shell in this case

/// The signals that end the wait; they stay blocked during run_children.
class HeldSignals {
 public:
  HeldSignals() {
    sigemptyset(&held_);
    for (const int signal : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&held_, signal);
    sigprocmask(SIG_BLOCK, &held_, &before_);
  }
  ~HeldSignals() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  [[nodiscard]] int wait() const {
    int signal = 0;
    sigwait(&held_, &signal);
    return signal;
  }
  const sigset_t& before() const { return before_; }

 private:
  sigset_t held_{};
  sigset_t before_{};
};

/// Runs in the child; only async-signal-safe calls.
[[noreturn]] void become(char* const* arguments, const sigset_t& mask, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(kExecFailed);  // the parent died before we asked for the signal
  sigprocmask(SIG_SETMASK, &mask, nullptr);
  execvp(arguments[0], arguments);
  _exit(kExecFailed);
}

Result<pid_t> start(const Child& child, const sigset_t& mask) {
  std::vector<char*> arguments;
  for (const std::string& argument : child.command)
    arguments.push_back(const_cast<char*>(argument.c_str()));  // execvp takes no const
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) return fail(ErrorCode::Io, child.label, std::strerror(errno));
  if (pid == 0) become(arguments.data(), mask, parent);
  return pid;
}

using Running = std::map<pid_t, std::string>;

void stop_all(Running& running) {
  for (const auto& [pid, label] : running) kill(pid, SIGTERM);
  for (const auto& [pid, label] : running) {
    while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  running.clear();
}

Result<void> verdict_on(const std::string& label, int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFEXITED(status) && WEXITSTATUS(status) == kExecFailed)
    return fail(ErrorCode::NotFound, label, "chorus-sensor could not be started; is it installed?");
  const std::string how = WIFSIGNALED(status)
                              ? fmt::format("died of signal {}", WTERMSIG(status))
                              : fmt::format("ended with exit code {}", WEXITSTATUS(status));
  return fail(ErrorCode::Unavailable, label, how + "; its own message is above.");
}

/// Waits until a child ends or a signal tells us to stop.
Result<void> wait_for_end(Running& running, const HeldSignals& signals) {
  while (!running.empty()) {
    if (signals.wait() != SIGCHLD) return {};
    int status = 0;
    for (pid_t pid = waitpid(-1, &status, WNOHANG); pid > 0; pid = waitpid(-1, &status, WNOHANG)) {
      const auto ended = running.find(pid);
      if (ended == running.end()) continue;
      const std::string label = ended->second;
      running.erase(ended);
      return verdict_on(label, status);
    }
  }
  return {};
}

}  // namespace

Result<void> run_children(const std::vector<Child>& children) {
  const HeldSignals signals;
  Running running;
  Result<void> outcome;
  for (const Child& child : children) {
    const auto pid = start(child, signals.before());
    if (!pid) {
      outcome = pass(pid);
      break;
    }
    running.emplace(*pid, child.label);
  }
  if (outcome) outcome = wait_for_end(running, signals);
  stop_all(running);
  return outcome;
}

}  // namespace chorus::ctl
