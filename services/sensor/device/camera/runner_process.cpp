#include "services/sensor/device/camera/runner_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include <fmt/format.h>

namespace chorus::camera {
namespace {

constexpr std::size_t kMaxLine = 256 * 1024;
constexpr std::size_t kMaxWord = 300;
constexpr auto kMoment = std::chrono::milliseconds(100);
constexpr auto kFarewell = std::chrono::seconds(1);

void close_if_open(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

/// Both ends of the child's three streams; the destructor closes those that are still open.
struct Streams {
  // [0] stays in this process, [1] goes to the child.
  std::array<int, 2> input{-1, -1};
  std::array<int, 2> output{-1, -1};
  std::array<int, 2> errors{-1, -1};

  Streams() = default;
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  ~Streams() {
    for (auto* pair : {&input, &output, &errors})
      for (int& end : *pair) close_if_open(end);
  }
  /// Opens the streams.  The child's input is a socket, so that writing to a runner that has ended
  /// is an error, not a signal.
  [[nodiscard]] bool open() {
    return socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input.data()) == 0 &&
           pipe2(output.data(), O_CLOEXEC) == 0 && pipe2(errors.data(), O_CLOEXEC) == 0;
  }
};

/// Starts the child in its own process group, with no signal blocked or ignored, as a shell would.
int spawn(const std::vector<std::string>& command, const Streams& streams, pid_t& pid) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, streams.input[1], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, streams.output[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, streams.errors[1], STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  sigfillset(&signals);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::vector<char*> arguments;
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));  // exec takes no const pointers.
  arguments.push_back(nullptr);
  const int failed =
      posix_spawnp(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return failed;
}

/// Reads all bytes that are available now; false at the end of the stream.
template <class Take>
bool read_all(int descriptor, const Take& take) {
  std::array<char, 16 * 1024> bytes{};
  while (true) {
    const ssize_t got = read(descriptor, bytes.data(), bytes.size());
    if (got > 0) {
      take(std::string_view(bytes.data(), static_cast<std::size_t>(got)));
      continue;
    }
    if (got < 0 && errno == EINTR) continue;
    return got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
  }
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) return fmt::format("died of signal {}", WTERMSIG(status));
  return fmt::format("ended with exit code {}", WIFEXITED(status) ? WEXITSTATUS(status) : status);
}

}  // namespace

Result<std::unique_ptr<RunnerProcess>> RunnerProcess::start(
    const std::vector<std::string>& command) {
  if (command.empty()) return fail(ErrorCode::InvalidArgument, "runner", "no command is given");
  Streams streams;
  if (!streams.open()) return fail(ErrorCode::Io, command.front(), std::strerror(errno));
  std::unique_ptr<RunnerProcess> process(new RunnerProcess());
  process->name_ = command.front();
  if (const int failed = spawn(command, streams, process->pid_); failed != 0) {
    process->pid_ = -1;
    return fail(failed == ENOENT ? ErrorCode::NotFound : ErrorCode::Io, command.front(),
                std::string("the runner cannot be started (") + std::strerror(failed) +
                    "); install it, or set device.camera.runner");
  }
  process->input_ = std::exchange(streams.input[0], -1);
  process->output_ = std::exchange(streams.output[0], -1);
  process->errors_ = std::exchange(streams.errors[0], -1);
  for (const int end : {process->input_, process->output_, process->errors_})
    fcntl(end, F_SETFL, O_NONBLOCK);
  return process;
}

RunnerProcess::~RunnerProcess() {
  (void)finish(kFarewell);
  if (pid_ > 0 && !ended_) {
    kill(-pid_, SIGKILL);
    while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  for (int* end : {&input_, &output_, &errors_}) close_if_open(*end);
}

bool RunnerProcess::reap() {
  if (pid_ > 0 && !ended_) ended_ = waitpid(pid_, &status_, WNOHANG) == pid_;
  return ended_;
}

void RunnerProcess::take_words() {
  if (errors_ < 0) return;
  const bool more = read_all(errors_, [this](std::string_view bytes) {
    for (const char c : bytes) {
      if (c != '\n') {
        if (word_.size() < kMaxWord) word_ += c;
        continue;
      }
      if (!word_.empty()) last_words_ = word_;
      if (!word_.empty()) says_.hit(word_);
      word_.clear();
    }
  });
  if (!more) close_if_open(errors_);
}

bool RunnerProcess::take_output() {
  return output_ >= 0 && read_all(output_, [this](std::string_view bytes) { heard_ += bytes; });
}

/// The error that says how the process ended.  Waits briefly for its end, because its output ends
/// slightly earlier.
Error RunnerProcess::obituary() {
  constexpr int kLooks = 20;
  for (int look = 0; look < kLooks && !reap(); ++look)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  take_words();
  std::string text = ended_ ? "the runner " + how_it_ended(status_) : "the runner hears no more";
  if (!last_words_.empty()) text += ": " + last_words_;
  return {ErrorCode::Unavailable, name_, std::move(text)};
}

Result<void> RunnerProcess::wait_a_moment(Want want, SteadyTime until,
                                          const std::stop_token& stop) {
  if (stop.stop_requested()) return fail(ErrorCode::Timeout, name_, "asked to stop");
  if (std::chrono::steady_clock::now() >= until) {
    const char* const what =
        want == Want::Read ? "the runner does not answer" : "the runner does not read its images";
    return fail(ErrorCode::Timeout, name_,
                last_words_.empty() ? what : what + (": " + last_words_));
  }
  const auto write = static_cast<short>(want == Want::Write ? POLLOUT : 0);
  std::array<pollfd, 3> ends{
      {{input_, write, 0}, {want == Want::Read ? output_ : -1, POLLIN, 0}, {errors_, POLLIN, 0}}};
  poll(ends.data(), ends.size(), static_cast<int>(kMoment.count()));
  take_words();
  return {};
}

Result<void> RunnerProcess::send(std::string_view bytes, Duration within,
                                 const std::stop_token& stop) {
  const auto until = std::chrono::steady_clock::now() + within;
  while (!bytes.empty()) {
    const ssize_t sent = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
      continue;
    }
    if (sent < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)
      return tl::unexpected<Error>(obituary());
    if (auto ok = wait_a_moment(Want::Write, until, stop); !ok) return ok;
  }
  return {};
}

Result<std::string> RunnerProcess::read_line(Duration within, const std::stop_token& stop) {
  const auto until = std::chrono::steady_clock::now() + within;
  while (true) {
    const bool more = take_output();
    const std::size_t end = heard_.find('\n');
    if (std::min(end, heard_.size()) > kMaxLine)
      return fail(ErrorCode::TooLarge, name_, "a line of the runner has at most 256 kB");
    if (end != std::string::npos) {
      std::string line = heard_.substr(0, end);
      heard_.erase(0, end + 1);
      return line;
    }
    if (!more) return tl::unexpected<Error>(obituary());
    if (auto ok = wait_a_moment(Want::Read, until, stop); !ok) return pass(ok);
  }
}

Result<void> RunnerProcess::listen() {
  take_words();
  if (reap()) return tl::unexpected<Error>(obituary());
  return {};
}

Result<void> RunnerProcess::finish(Duration within) {
  const auto until = std::chrono::steady_clock::now() + within;
  close_if_open(input_);
  while (!reap() && pid_ > 0 && std::chrono::steady_clock::now() < until) {
    (void)take_output();
    take_words();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (pid_ > 0 && !ended_) return fail(ErrorCode::Timeout, name_, "the runner does not end");
  if (status_ != 0) return tl::unexpected<Error>(obituary());
  return {};
}

}  // namespace chorus::camera
