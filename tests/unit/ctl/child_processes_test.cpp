#include "services/ctl/line/child_processes.h"

#include "common/base/asked_program.h"

#include <csignal>

#include <gmock/gmock.h>

#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;

const Child kLasting{"lasting", {"sleep", "60"}};

TEST(ChildProcesses, EndWithTheFirstThatEnds) {
  EXPECT_THAT(run_children({{"short", {"true"}}, kLasting}), testing::IsOk());
  const auto failed = run_children({kLasting, {"bad", {"sh", "-c", "exit 3"}}});
  ASSERT_FALSE(failed.has_value());
  EXPECT_THAT(to_string(failed.error()), HasSubstr("bad: ended with exit code 3"));
}

TEST(ChildProcesses, SayWhenAProgramCannotBeStarted) {
  const auto missing = run_children({kLasting, {"gone", {"/nowhere/chorus-sensor"}}});
  ASSERT_FALSE(missing.has_value());
  EXPECT_THAT(to_string(missing.error()), HasSubstr("could not be started"));
}

TEST(ChildProcesses, SayOfWhichSignalOneDied) {
  const auto killed = run_children({{"hit", {"sh", "-c", "kill -9 $$"}}, kLasting});
  ASSERT_FALSE(killed.has_value());
  EXPECT_THAT(to_string(killed.error()), HasSubstr("hit: died of signal 9"));
  EXPECT_THAT(to_string(killed.error()), HasSubstr("its own message is above"));
}

TEST(ChildProcesses, NoneAreAtTheirEndAtOnce) { EXPECT_THAT(run_children({}), testing::IsOk()); }

TEST(ChildProcesses, StopTheOthersBeforeTheyReturn) {
  const testing::TemporaryFolder folder;
  const std::string mark = (folder / "stopped").string();
  const Child other{"other",
                    {"sh", "-c",
                     "trap 'touch " + mark + "; exit' TERM; echo > " + mark +
                         ".up; while :; do sleep 0.01; done"}};
  const Child ending{"ending", {"sh", "-c", "until [ -e " + mark + ".up ]; do sleep 0.01; done"}};
  EXPECT_THAT(run_children({other, ending}), testing::IsOk());
  EXPECT_TRUE(std::filesystem::exists(mark)) << "it was asked to end, and awaited";
}

TEST(ChildProcesses, StopAllWhenWeAreToldToStop) {
  // The child sends SIGINT to its parent, which is this process, as Ctrl-C would.
  const Child teller{"teller", {"sh", "-c", "kill -INT $PPID; exec sleep 60"}};
  EXPECT_THAT(run_children({kLasting, teller}), testing::IsOk());
}

TEST(SiblingProgram, IsNextToOursOrLeftToThePath) {
  const auto ours = std::filesystem::read_symlink("/proc/self/exe");
  EXPECT_EQ(sibling_program(ours.filename().string()), ours);
  EXPECT_EQ(sibling_program("no-such-program"), "no-such-program");
}

}  // namespace
}  // namespace chorus::ctl
