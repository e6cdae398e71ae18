#include "tests/bench/live/child_process.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include "tests/bench/live/process_time.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kCannotStart = 127;
constexpr double kEndPatience = 5.0;  // [s]

void limit(int resource, std::size_t soft) {
  rlimit limits{};
  if (soft == 0 || ::getrlimit(static_cast<__rlimit_resource>(resource), &limits) != 0) return;
  limits.rlim_cur = std::min<rlim_t>(soft, limits.rlim_max);
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

/// Mounts the disk in a mount namespace of this process: only this process sees it, and it is gone
/// when the process ends.
bool mount_small_disk(const std::string& folder) {
  return ::unshare(CLONE_NEWNS) == 0 &&
         ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("none", folder.c_str(), "tmpfs", 0, "size=1m") == 0;
}

/// Runs in the child before the program starts.
void settle_in(const ChildSurroundings& surroundings) {
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  const int null = ::open("/dev/null", O_RDWR);
  ::dup2(null, STDOUT_FILENO);
  ::dup2(surroundings.error_output >= 0 ? surroundings.error_output : null, STDERR_FILENO);
  limit(RLIMIT_NOFILE, surroundings.descriptors);
  limit(RLIMIT_AS, surroundings.address_space);
  for (const std::string& each : surroundings.environment) ::putenv(const_cast<char*>(each.data()));
  if (!surroundings.small_disk.empty() && !mount_small_disk(surroundings.small_disk))
    ::_exit(kCannotStart);
}

Result<std::string> path_of(const std::string& program) {
  if (program.find('/') != std::string::npos) return program;
  std::error_code error;
  const auto own = fs::read_symlink("/proc/self/exe", error);
  std::string path = (own.parent_path() / program).string();
  if (error || !fs::exists(path, error))
    return fail(ErrorCode::NotFound, path, "build " + program + " first");
  return path;
}

}  // namespace

Result<ChildProcess> ChildProcess::start(const std::string& program,
                                         const std::vector<std::string>& arguments,
                                         const ChildSurroundings& surroundings) {
  const auto path = path_of(program);
  if (!path) return pass(path);
  std::vector<std::string> words{*path};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid < 0) return fail(ErrorCode::Io, "fork", "cannot start a process");
  if (pid == 0) {
    settle_in(surroundings);
    ::execv(argv[0], argv.data());
    ::_exit(kCannotStart);
  }
  return ChildProcess(pid);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}

ChildProcess::~ChildProcess() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGTERM);
  ::kill(pid_, SIGCONT);
  if (wait(kEndPatience) < 0) kill();
}

bool ChildProcess::alive() const {
  if (pid_ <= 0) return false;
  siginfo_t what{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &what, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         what.si_pid == 0;
}

void ChildProcess::send(int signal) const {
  if (pid_ > 0) ::kill(pid_, signal);
}

void ChildProcess::kill() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

int ChildProcess::wait(double patience_s) {
  constexpr int kSignalled = 128;
  const auto begun = std::chrono::steady_clock::now();
  int status = 0;
  while (pid_ > 0 && ::waitpid(pid_, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() - begun > std::chrono::duration<double>(patience_s))
      return -1;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : kSignalled + WTERMSIG(status);
}

double ChildProcess::cpu_seconds() const { return cpu_seconds_of(pid_); }

double ChildProcess::resident_mb() const {
  constexpr double kMegabyte = 1 << 20;
  std::ifstream statm("/proc/" + std::to_string(pid_) + "/statm");
  double size = 0.0;
  double resident = 0.0;  // in pages
  statm >> size >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / kMegabyte;
}

std::size_t ChildProcess::descriptors() const {
  std::error_code ignored;
  std::size_t count = 0;
  const fs::path folder = "/proc/" + std::to_string(pid_) + "/fd";
  for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end;
       it.increment(ignored))
    ++count;
  return count;
}

}  // namespace chorus::bench
