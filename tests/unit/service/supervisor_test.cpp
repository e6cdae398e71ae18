#include "common/service/supervisor.h"

#include <map>

#include <gmock/gmock.h>
#include <unistd.h>

#include "tests/support/notify_socket.h"
#include "tests/support/temporary_folder.h"

namespace chorus::service {
namespace {

using std::chrono::microseconds;
using ::testing::ElementsAre;

Environment environment(std::map<std::string, std::string> variables) {
  return [variables = std::move(variables)](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  };
}

TEST(Supervisor, TellsTheSocketThatIsNamed) {
  const chorus::testing::TemporaryFolder folder;
  const chorus::testing::NotifySocket socket((folder / "notify").string());
  const Supervisor supervisor(environment({{"NOTIFY_SOCKET", (folder / "notify").string()}}));
  EXPECT_TRUE(supervisor.tell("READY=1"));
  EXPECT_TRUE(supervisor.tell("STATUS=two sensors"));
  EXPECT_THAT(socket.received(), ElementsAre("READY=1", "STATUS=two sensors"));
}

TEST(Supervisor, KnowsTheAbstractNamespace) {
  const std::string name = "@chorus-supervisor-test-" + std::to_string(::getpid());
  const chorus::testing::NotifySocket socket(name);
  EXPECT_TRUE(Supervisor(environment({{"NOTIFY_SOCKET", name}})).tell("READY=1"));
  EXPECT_THAT(socket.received(), ElementsAre("READY=1"));
}

TEST(Supervisor, TellsNobodyWhereNobodyListens) {
  EXPECT_FALSE(Supervisor(environment({})).tell("READY=1"));
  for (const std::string& wrong :
       {std::string("relative"), std::string("/no/such"), std::string(200, '/')})
    EXPECT_FALSE(Supervisor(environment({{"NOTIFY_SOCKET", wrong}})).tell("READY=1")) << wrong;
}

TEST(Supervisor, PulsesTwiceAsOftenAsTheWatchdogWants) {
  const std::string own = std::to_string(::getpid());
  EXPECT_EQ(Supervisor(environment({{"WATCHDOG_USEC", "20000000"}})).pulse(),
            microseconds(10'000'000));
  EXPECT_TRUE(Supervisor(environment({{"WATCHDOG_USEC", "2000"}, {"WATCHDOG_PID", own}})).pulse());
  EXPECT_FALSE(Supervisor(environment({})).pulse());
  EXPECT_FALSE(Supervisor(environment({{"WATCHDOG_USEC", "2000"}, {"WATCHDOG_PID", "1"}})).pulse());
  for (const char* wrong : {"0", "-5", "soon", ""})
    EXPECT_FALSE(Supervisor(environment({{"WATCHDOG_USEC", wrong}})).pulse()) << wrong;
}

}  // namespace
}  // namespace chorus::service
