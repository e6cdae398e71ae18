#include "common/base/asked_program.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

namespace chorus {
namespace {

constexpr int kNoSuchProgram = 127;  // As a shell has it.
constexpr int kSignalled = 128;

/// Starts the program in a process group of its own, with both its outputs into `into`.
int start(const std::vector<std::string>& command, int into, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, into, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, into, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const int failed = ::posix_spawnp(&pid, words[0], &actions, &attributes, words.data(), ::environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

/// Reads to the end or to a limit; false: a limit was reached.
bool listen(int from, const AskLimits& limits, std::string& said) {
  const auto end = std::chrono::steady_clock::now() + limits.patience;
  std::array<char, 4096> piece{};
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    pollfd one{from, POLLIN, 0};
    const int ready = ::poll(&one, 1, static_cast<int>(std::max<std::int64_t>(0, left.count())));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return false;
    const ssize_t got = ::read(from, piece.data(), piece.size());
    if (got <= 0) return true;
    const std::size_t room = limits.most_bytes - std::min(limits.most_bytes, said.size());
    said.append(piece.data(), std::min(room, static_cast<std::size_t>(got)));
    if (room < static_cast<std::size_t>(got)) return false;
  }
}

int code_of(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFSIGNALED(status) ? kSignalled + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace

std::filesystem::path sibling_program(const std::string& name) {
  std::error_code failed;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (!failed && std::filesystem::exists(self.parent_path() / name, failed))
    return self.parent_path() / name;
  return name;
}

Result<Asked> ask_program(const std::vector<std::string>& command, const AskLimits& limits) {
  std::array<int, 2> pipe{};
  if (command.empty() || ::pipe2(pipe.data(), O_CLOEXEC) != 0)
    return fail(ErrorCode::Io, command.empty() ? "" : command[0], std::strerror(errno));
  pid_t pid = 0;
  const int failed = start(command, pipe[1], pid);
  ::close(pipe[1]);
  Asked asked;
  if (failed == 0) {
    asked.cut_short = !listen(pipe[0], limits, asked.said);
    if (asked.cut_short) ::kill(-pid, SIGKILL);
    asked.code = code_of(pid);
  }
  ::close(pipe[0]);
  if (failed == ENOENT) asked.code = kNoSuchProgram;
  if (failed != 0 && failed != ENOENT)
    return fail(ErrorCode::Io, command[0],
                std::string("cannot be started: ") + std::strerror(failed));
  return asked;
}

}  // namespace chorus
