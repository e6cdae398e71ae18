#include "services/sensor/device/camera/shipped_runner.h"

#include <filesystem>
#include <system_error>

#include "services/sensor/device/camera/runner_process.h"

namespace chorus::camera {
namespace {

namespace fs = std::filesystem;

/// Finds the runner's folder: among the installed files, next to the sources, or in the working
/// directory.
Result<std::string> shipped_runner() {
  std::error_code failed;
  const fs::path here = fs::read_symlink("/proc/self/exe", failed).parent_path();
  for (const fs::path& place :
       {here / "../share/chorus/pose-runner", here / "../../../services/pose-runner",
        fs::path("services/pose-runner")}) {
    const fs::path program = (place / "runner.mjs").lexically_normal();
    if (fs::exists(program, failed)) return program.string();
  }
  return fail(ErrorCode::NotFound, "device.camera.runner",
              "the runner that comes with Chorus is not installed; name the command of one, or "
              "start from the folder of the sources");
}

}  // namespace

Result<std::vector<std::string>> runner_command(const CameraSettings& settings) {
  std::vector<std::string> command = settings.runner;
  if (command.empty()) {
    const auto program = shipped_runner();
    if (!program) return pass(program);
    command = {"node", *program};
  }
  if (!settings.model.empty()) {
    command.emplace_back("--model");
    command.push_back(settings.model);
  }
  return command;
}

Result<void> check_runner(const CameraSettings& settings) {
  constexpr Duration kPatience = std::chrono::seconds(20);
  if (!settings.runner.empty()) return {};
  auto command = runner_command(settings);
  if (!command) return pass(command);
  command->emplace_back("--check");
  auto process = RunnerProcess::start(*command);
  if (!process) return pass(process);
  return (*process)->finish(kPatience);
}

}  // namespace chorus::camera
