#include "services/sensor/device/camera/shipped_runner.h"

#include "common/base/shipped_folder.h"
#include "services/sensor/device/camera/runner_process.h"

namespace chorus::camera {
namespace {

Result<std::string> shipped_runner() {
  const auto folder = shipped_folder("pose-runner", "runner.mjs");
  if (folder) return *folder + "/runner.mjs";
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
