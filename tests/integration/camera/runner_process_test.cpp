// A child process as a runner: what it says, how it ends, and that it cannot block us.
#include "services/sensor/device/camera/runner_process.h"

#include <signal.h>

#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::camera {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::stop_token kNever;

std::unique_ptr<RunnerProcess> shell(const std::string& script) {
  auto process = RunnerProcess::start({"sh", "-c", script});
  EXPECT_TRUE(process);
  return std::move(*process);
}

TEST(RunnerProcess, HearsAndAnswers) {
  const auto process = shell("while read line; do echo \"heard $line\"; done");
  EXPECT_TRUE(process->send("one\ntwo\n", 5s, kNever));
  EXPECT_EQ(process->read_line(5s, kNever), "heard one");
  EXPECT_EQ(process->read_line(5s, kNever), "heard two");
  EXPECT_TRUE(process->listen());
  EXPECT_TRUE(process->finish(5s)) << "it ends with its input";
}

TEST(RunnerProcess, TakesMoreThanAPipeHolds) {
  const auto process = shell("head -c 3000000 | wc -c");
  EXPECT_TRUE(process->send(std::string(3'000'000, 'x'), 10s, kNever));
  EXPECT_EQ(process->read_line(10s, kNever), "3000000");
}

TEST(RunnerProcess, ItsLastWordsSayWhyItEnded) {
  const auto process = shell("echo first >&2; echo 'the model is not installed' >&2; exit 3");
  const auto line = process->read_line(5s, kNever);
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().code, ErrorCode::Unavailable);
  EXPECT_EQ(line.error().message, "the runner ended with exit code 3: the model is not installed");
  std::this_thread::sleep_for(50ms);
  EXPECT_FALSE(process->listen());
}

TEST(RunnerProcess, WritingToOneThatDiedIsAnErrorAndNoSignal) {
  const auto process = shell("kill -9 $$");
  std::this_thread::sleep_for(200ms);
  const auto sent = process->send(std::string(1'000'000, 'x'), 5s, kNever);
  ASSERT_FALSE(sent);
  EXPECT_THAT(sent.error().message, HasSubstr("died of signal 9"));
}

TEST(RunnerProcess, OneThatDoesNotReadOrAnswerIsNotWaitedForLonger) {
  const auto process = shell("sleep 60");
  const auto sent = process->send(std::string(3'000'000, 'x'), 300ms, kNever);
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().message, "the runner does not read its images");
  const auto line = process->read_line(300ms, kNever);
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().code, ErrorCode::Timeout);
}

TEST(RunnerProcess, OneThatWillNotEndIsKilled) {
  const auto began = std::chrono::steady_clock::now();
  shell("trap '' TERM; while true; do sleep 1; done");
  EXPECT_LT(std::chrono::steady_clock::now() - began, 5s);
}

TEST(RunnerProcess, StoppingEndsEveryWait) {
  const auto process = shell("sleep 60");
  std::stop_source stop;
  std::jthread stopper([&stop] {
    std::this_thread::sleep_for(200ms);
    stop.request_stop();
  });
  const auto began = std::chrono::steady_clock::now();
  EXPECT_FALSE(process->read_line(60s, stop.get_token()));
  EXPECT_LT(std::chrono::steady_clock::now() - began, 5s);
}

TEST(RunnerProcess, AFloodWithoutALineIsRefused) {
  const auto process = shell("yes | tr -d '\\n'");
  const auto line = process->read_line(10s, kNever);
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().code, ErrorCode::TooLarge);
}

TEST(RunnerProcess, ALineThatIsTooLongIsRefusedAlsoIfItsEndCameWithIt) {
  const auto process = shell("head -c 300000 /dev/zero | tr '\\0' x; echo; sleep 10");
  std::this_thread::sleep_for(500ms);
  const auto line = process->read_line(10s, kNever);
  ASSERT_FALSE(line);
  EXPECT_EQ(line.error().code, ErrorCode::TooLarge);
}

TEST(RunnerProcess, AProgramThatIsNotThereIsNamed) {
  const auto process = RunnerProcess::start({"no-such-runner"});
  ASSERT_FALSE(process);
  EXPECT_EQ(process.error().code, ErrorCode::NotFound);
  EXPECT_THAT(to_string(process.error()), StartsWith("no-such-runner: "));
  EXPECT_FALSE(RunnerProcess::start({}));
}

}  // namespace
}  // namespace chorus::camera
