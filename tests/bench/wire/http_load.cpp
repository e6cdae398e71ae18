#include "tests/bench/wire/http_load.h"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/bench/live/process_time.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;

bool answers(std::uint16_t port) {
  const int probe = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = testing::loopback(port);
  const bool connected =
      ::connect(probe, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(probe);
  return connected;
}

bool wait_until_it_answers(std::uint16_t port) {
  constexpr int kTries = 200;
  constexpr std::chrono::milliseconds kPause{25};
  for (int i = 0; i < kTries; ++i) {
    if (answers(port)) return true;
    std::this_thread::sleep_for(kPause);
  }
  return false;
}

/// nginx's configuration: Debian's defaults, plus settings that make nginx fast for one small
/// file.
std::string nginx_config(const std::string& folder, std::uint16_t port) {
  std::ostringstream text;
  text << "daemon off; master_process off; worker_processes 1;\n"
       << "pid " << folder << "/pid; error_log " << folder << "/error.log crit;\n"
       << "events { worker_connections 1024; }\n"
       << "http { access_log off; sendfile on; tcp_nopush on; tcp_nodelay on;\n"
       << " keepalive_requests 1000000000; default_type text/turtle;\n"
       << " open_file_cache max=16 inactive=600s; open_file_cache_valid 600s;\n";
  for (const auto kind : {"client_body", "proxy", "fastcgi", "uwsgi", "scgi"})
    text << " " << kind << "_temp_path " << folder << "/" << kind << ";\n";
  text << " server { listen 127.0.0.1:" << port << "; root " << folder << "/www; } }\n";
  return text.str();
}

Result<ScratchFolder> nginx_folder(const std::string& body, std::uint16_t port) {
  auto folder = ScratchFolder::make();
  if (!folder) return folder;
  fs::create_directory(folder->path() / "www");
  std::ofstream(folder->path() / "www" / "frame", std::ios::binary) << body;
  std::ofstream(folder->path() / "nginx.conf") << nginx_config(folder->path().string(), port);
  return folder;
}

void send_all(int to, const void* bytes, std::size_t size) {
  if (::write(to, bytes, size) != static_cast<ssize_t>(size)) std::_Exit(1);
}

}  // namespace

void keep_to_side(Side side) {
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0 || CPU_COUNT(&allowed) < 2) return;
  int skip = side == Side::Server ? 0 : 1;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &allowed) || skip-- > 0) continue;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(cpu, &one);
    ::sched_setaffinity(0, sizeof one, &one);
    return;
  }
}

Result<ServingProcess> ServingProcess::fork(const Serve& serve) {
  std::array<int, 2> port_pipe{};
  std::array<int, 2> life_pipe{};
  if (::pipe(port_pipe.data()) != 0 || ::pipe(life_pipe.data()) != 0)
    return fail(ErrorCode::Io, "pipe", "cannot make a pipe");
  const pid_t pid = ::fork();
  if (pid < 0) return fail(ErrorCode::Io, "fork", "cannot start a process");
  if (pid == 0) {
    keep_to_side(Side::Server);
    ::close(port_pipe[0]);
    ::close(life_pipe[1]);
    serve([&](std::uint16_t port) { send_all(port_pipe[1], &port, sizeof port); },
          [&] {
            char nothing = 0;
            while (::read(life_pipe[0], &nothing, 1) > 0) {
            }
          });
    std::_Exit(0);
  }
  ::close(port_pipe[1]);
  ::close(life_pipe[0]);
  ServingProcess process;
  process.pid_ = pid;
  process.life_line_ = life_pipe[1];
  const bool told = ::read(port_pipe[0], &process.port_, sizeof process.port_) ==
                    static_cast<ssize_t>(sizeof process.port_);
  ::close(port_pipe[0]);
  if (!told) return fail(ErrorCode::Unavailable, "server", "the server process did not start");
  return process;
}

Result<ServingProcess> ServingProcess::nginx(const std::string& body) {
  const std::uint16_t port = testing::free_port();
  auto made = nginx_folder(body, port);
  if (!made) return pass(made);
  const std::string folder = made->path().string();
  const std::string config = folder + "/nginx.conf";
  const std::string errors = folder + "/error.log";
  ServingProcess process;
  process.folder_.emplace(std::move(*made));
  process.port_ = port;
  process.pid_ = ::fork();
  if (process.pid_ == 0) {
    keep_to_side(Side::Server);
    ::execlp("nginx", "nginx", "-e", errors.c_str(), "-p", folder.c_str(), "-c", config.c_str(),
             nullptr);
    ::execl("/usr/sbin/nginx", "nginx", "-e", errors.c_str(), "-p", folder.c_str(), "-c",
            config.c_str(), nullptr);
    std::_Exit(1);
  }
  if (process.pid_ < 0 || !wait_until_it_answers(port))
    return fail(ErrorCode::Unavailable, "nginx",
                "nginx does not start; it is the baseline (Debian package nginx)");
  return process;
}

ServingProcess::ServingProcess(ServingProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      life_line_(std::exchange(other.life_line_, -1)),
      port_(other.port_),
      folder_(std::move(other.folder_)) {}

ServingProcess::~ServingProcess() {
  if (life_line_ >= 0) ::close(life_line_);
  if (pid_ > 0) {
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
  }
}

double ServingProcess::cpu_seconds() const { return cpu_seconds_of(pid_); }

Result<WrkResult> run_wrk(std::uint16_t port, int connections, int run_seconds) {
  // The shell of popen() inherits our affinity: change ours, and restore it afterwards.
  cpu_set_t before;
  ::sched_getaffinity(0, sizeof before, &before);
  keep_to_side(Side::Load);
  const std::string command = "wrk -t1 -c" + std::to_string(connections) + " -d" +
                              std::to_string(run_seconds) +
                              "s http://127.0.0.1:" + std::to_string(port) + "/frame 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> output(::popen(command.c_str(), "r"), ::pclose);
  ::sched_setaffinity(0, sizeof before, &before);
  if (!output) return fail(ErrorCode::Io, "wrk", "cannot start wrk");
  WrkResult result;
  std::array<char, 256> line{};
  std::string all;
  while (std::fgets(line.data(), line.size(), output.get()) != nullptr) {
    all += line.data();
    (void)std::sscanf(line.data(), "Requests/sec: %lf", &result.requests_per_s);
    (void)std::sscanf(line.data(), " %lf requests in", &result.requests);
  }
  const bool errors =
      all.find("Non-2xx") != std::string::npos || all.find("Socket errors") != std::string::npos;
  if (result.requests <= 0.0 || errors)
    return fail(ErrorCode::Unavailable, "wrk",
                "wrk (Debian package wrk) did not measure cleanly: " + all);
  return result;
}

}  // namespace chorus::bench
