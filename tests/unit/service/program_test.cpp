#include "common/service/program.h"

#include <csignal>
#include <fstream>
#include <functional>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/log_queue.h"
#include "tests/support/notify_socket.h"
#include "tests/support/temporary_folder.h"

namespace chorus::service {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Records what the shell calls, and sends itself the signals that the shell must handle.
class NotingProgram final : public Program {
 public:
  std::vector<std::string> asked;
  std::vector<int> signals{SIGTERM};  ///< One is sent after each start or reload.
  std::vector<int> meaningless;       ///< Sent before each of them.
  bool starts = true;
  bool throws = false;
  std::function<void()> on_reload = [] {};

  Result<LogConfig> prepare(ConfigReader config) override { return read("prepare", config); }
  bool moves = true;
  std::vector<std::string> worries;
  std::vector<std::string> concerns() override { return worries; }
  bool alive() override { return moves; }
  Result<void> start() override {
    asked.emplace_back("start");
    if (throws) throw std::runtime_error("out of luck");
    if (!starts) return fail(ErrorCode::Io, "127.0.0.1:1", "address in use");
    next_signal();
    return {};
  }
  Result<LogConfig> reload(ConfigReader config) override {
    next_signal();
    on_reload();
    return read("reload", config);
  }
  void stop() override { asked.emplace_back("stop"); }

 private:
  Result<LogConfig> read(const std::string& what, ConfigReader& config) {
    std::string word = "none";
    config.read("word", word);
    LogConfig log;
    read_log(config.child("log"), log);
    asked.push_back(what + " " + word);
    if (auto ok = config.finish(); !ok) return pass(ok);
    return log;
  }
  void next_signal() {
    for (const int idle : meaningless) kill(getpid(), idle);
    kill(getpid(), signals.front());
    signals.erase(signals.begin());
  }
};

int run(NotingProgram& program, std::vector<const char*> words) {
  words.insert(words.begin(), "chorus-noting");
  return run_program({"chorus-noting", "Notes.", ""}, program, static_cast<int>(words.size()),
                     words.data());
}

/// What a run writes to standard error.
std::string complaint_of(NotingProgram& program, const std::vector<const char*>& words) {
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run(program, words), kExitMistaken);
  return ::testing::internal::GetCapturedStderr();
}

TEST(ProgramShell, SignalsThatMeanNothingEndNothing) {
  NotingProgram program;
  program.meaningless = {SIGUSR1, SIGUSR2, SIGPIPE};
  EXPECT_EQ(run(program, {}), kExitStopped);
  EXPECT_THAT(program.asked, ElementsAre("prepare none", "start", "stop"));
}

TEST(ProgramShell, RunsUntilASignalAsksToStop) {
  for (const int signal : {SIGTERM, SIGINT}) {
    NotingProgram program;
    program.signals = {signal};
    EXPECT_EQ(run(program, {"--set", "word=a"}), kExitStopped);
    EXPECT_THAT(program.asked, ElementsAre("prepare a", "start", "stop"));
  }
}

TEST(ProgramShell, ReadsTheFileAgainOnHangUpAndGoesOnWhenItIsWrong) {
  const chorus::testing::TemporaryFolder folder;
  const std::string path = (folder / "a.json").string();
  const auto write = [&](const char* text) { std::ofstream(path) << text; };
  write(R"({"word": "a"})");
  NotingProgram program;
  program.signals = {SIGHUP, SIGHUP, SIGTERM};
  program.on_reload = [&] { write(R"({"wrod": "b"})"); };
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run(program, {"--config", path.c_str(), "--log-format", "json"}), kExitStopped);
  ASSERT_TRUE(log::flush(std::chrono::seconds(5)));
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(log, HasSubstr(R"("configuration reloaded")"));
  EXPECT_THAT(log, HasSubstr("configuration not reloaded, the old one stays"));
  EXPECT_THAT(log, HasSubstr("did you mean 'word'"));
  EXPECT_THAT(program.asked, ElementsAre("prepare a", "start", "reload a", "reload none", "stop"));
}

TEST(ProgramShell, CheckStartsNothing) {
  NotingProgram program;
  EXPECT_EQ(run(program, {"--check"}), kExitStopped);
  EXPECT_THAT(program.asked, ElementsAre("prepare none"));
  EXPECT_THAT(complaint_of(program, {"--check", "--set", "log.level=loud"}),
              HasSubstr("log.level"));
}

TEST(ProgramShell, SaysWhetherTheFileOrAnOptionIsMeant) {
  const chorus::testing::TemporaryFolder folder;
  const std::string good = folder.write("good.json", "{}").string();
  const std::string broken = folder.write("broken.json", "{").string();
  NotingProgram program;
  EXPECT_THAT(complaint_of(program, {"--check", "--port", "99999"}),
              HasSubstr("chorus-noting: options: http"));
  EXPECT_THAT(complaint_of(program, {"--config", good.c_str(), "--log-level", "loud"}),
              HasSubstr("good.json with the options: log.level"));
  EXPECT_THAT(complaint_of(program, {"--config", broken.c_str(), "--log-level", "info"}),
              HasSubstr("broken.json: line 1, column 2: the JSON ends too early"));
}

TEST(ProgramShell, CheckSaysWhatWouldNotWorkNow) {
  NotingProgram program;
  program.worries = {"the moon is full: wait"};
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(run(program, {"--check"}), kExitStopped) << "the configuration is good";
  EXPECT_THAT(::testing::internal::GetCapturedStdout(),
              HasSubstr("What does not work on this host now is on standard error"));
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("chorus-noting: but now, the moon is full: wait\n"));
  program.worries.clear();
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(run(program, {"--check"}), kExitStopped);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "The configuration is good.\n");
}

TEST(ProgramShell, NamesItselfAndTheMistake) {
  NotingProgram program;
  EXPECT_THAT(
      complaint_of(program, {"--config", "/no/such.json"}),
      AllOf(HasSubstr("chorus-noting: /no/such.json: the configuration file cannot be read"),
            HasSubstr("chorus init")));
  EXPECT_THAT(complaint_of(program, {"--config", "/"}), HasSubstr("this user may read"));
  program.starts = false;
  EXPECT_THAT(complaint_of(program, {}), HasSubstr("chorus-noting: 127.0.0.1:1: address in use"));
}

/// Sets an environment variable of this process for the lifetime of the object.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { ::unsetenv(name_); }

 private:
  const char* name_;
};

TEST(ProgramShell, TellsSystemdThatItIsReadyAliveAndStopping) {
  const chorus::testing::TemporaryFolder folder;
  const chorus::testing::NotifySocket socket((folder / "notify").string());
  const Variable path("NOTIFY_SOCKET", (folder / "notify").string());
  const Variable watchdog("WATCHDOG_USEC", "20000");
  NotingProgram program;
  program.signals = {SIGHUP, SIGTERM};
  program.on_reload = [&] {
    EXPECT_THAT(socket.received(), ::testing::Contains("WATCHDOG=1"));
    program.moves = false;
  };
  EXPECT_EQ(run(program, {}), kExitStopped);
  EXPECT_THAT(socket.received(), ElementsAre("STOPPING=1")) << "no pulse of a still program";
}

TEST(ProgramShell, WhatIsThrownEndsItWithAReason) {
  NotingProgram program;
  program.throws = true;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(run(program, {}), kExitFailed);
  ASSERT_TRUE(log::flush(std::chrono::seconds(5)));
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("out of luck"));
}

}  // namespace
}  // namespace chorus::service
