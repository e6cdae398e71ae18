#include "tests/bench/live/chorus_run.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>

namespace chorus::bench {

Result<RunCost> run_chorus(const std::vector<std::string>& arguments, int largest_code) {
  namespace fs = std::filesystem;
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "chorus";
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const auto begun = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    execv(argv.front(), argv.data());
    _exit(127);
  }
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child || !WIFEXITED(status) ||
      WEXITSTATUS(status) > largest_code)
    return fail(ErrorCode::Internal, "chorus " + arguments.front(), "did not succeed");
  const auto elapsed = std::chrono::steady_clock::now() - begun;
  constexpr double kKilobytes = 1024.0 / 1e6;
  return RunCost{std::chrono::duration<double>(elapsed).count(),
                 static_cast<double>(used.ru_maxrss) * kKilobytes, WEXITSTATUS(status)};
}

}  // namespace chorus::bench
