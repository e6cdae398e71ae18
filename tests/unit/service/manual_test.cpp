#include "common/service/manual.h"

#include <array>

#include <gmock/gmock.h>
#include <CLI/CLI.hpp>

#include "common/service/command_line.h"

namespace chorus::service {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Manual, IsRoffWithEveryOptionAndNothingThatRoffWouldObey) {
  CLI::App app{"tool: does .things\nand more", "tool"};
  app.footer(".begin\n'quote\nback\\slash");
  std::string file;
  app.add_option("--out-file", file, "Where to");
  bool flag = false;
  app.add_flag("--hidden-one", flag, "Not for people")->group("");
  const std::string page = manual_page(app, {8, "/etc/tool.json what it reads\n"});
  EXPECT_THAT(page, AllOf(HasSubstr(".TH TOOL 8 "), HasSubstr("tool \\- does .things\n"),
                          HasSubstr("\\fB\\-\\-out\\-file\\fR \\fITEXT\\fR\nWhere to\n"),
                          HasSubstr("\n\\&.begin\n\\&'quote\nback\\eslash\n"),
                          HasSubstr(".I /etc/tool.json\nwhat it reads\n")));
  EXPECT_THAT(page, Not(HasSubstr("hidden")));
}

TEST(Completion, OffersTheOptionsOfTheCommand) {
  CLI::App app{"tool", "my-tool"};
  bool flag = false;
  app.add_subcommand("walk", "Walks")->add_flag("--fast", flag, "Faster");
  const std::string text = bash_completion(app);
  EXPECT_THAT(text, AllOf(HasSubstr("_my_tool() {"), HasSubstr("walk) words=' --help --fast' ;;"),
                          HasSubstr("*) words=' --help walk' ;;"),
                          HasSubstr("complete -o default -F _my_tool my-tool\n")));
}

TEST(Manual, IsPrintedByEveryServiceWithItsShortcuts) {
  const std::array<const char*, 3> words{"chorus-x", "--print", "manual"};
  About about{"chorus-x",
              "chorus-x: shows.",
              "  chorus-x\n",
              {{"--id", "id", "Its id (id)"}},
              "/etc/x y\n"};
  ::testing::internal::CaptureStdout();
  EXPECT_EQ(read_command_line(about, 3, words.data()).exit, kExitStopped);
  EXPECT_THAT(::testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr(".TH CHORUS\\-X 8"), HasSubstr("\\-\\-id"), HasSubstr("\\-\\-config"),
                    HasSubstr(".I /etc/x\ny\n")));
}

}  // namespace
}  // namespace chorus::service
