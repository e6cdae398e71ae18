#include <regex>
#include <vector>

#include <gmock/gmock.h>

#include "common/base/version.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;

TEST(CommandLine, TeachesWithExamplesInEveryHelp) {
  EXPECT_EQ(run_chorus({"--help"}).code, kExitOk);
  for (const Command& command : all_commands()) {
    const Outcome help = run_chorus({std::string(command.name), "--help"});
    EXPECT_EQ(help.code, kExitOk) << command.name;
    EXPECT_THAT(help.out, HasSubstr("Examples:\n  chorus " + std::string(command.name)));
  }
}

TEST(CommandLine, HelpMayAlsoBeTheFirstWord) {
  const Outcome all = run_chorus({"help"});
  EXPECT_EQ(all.code, kExitOk);
  EXPECT_EQ(all.out, run_chorus({"--help"}).out);
  const Outcome one = run_chorus({"help", "characterise"});
  EXPECT_EQ(one.code, kExitOk);
  EXPECT_EQ(one.out, run_chorus({"characterise", "--help"}).out);
  const Outcome below = run_chorus({"help", "calibrate", "camera"});
  EXPECT_EQ(below.out, run_chorus({"calibrate", "camera", "--help"}).out);
  const Outcome wrong = run_chorus({"help", "improt"});
  EXPECT_EQ(wrong.code, kExitUsage);
  EXPECT_THAT(wrong.error, HasSubstr("did you mean \"import\"?"));
}

TEST(CommandLine, WhoeverAsksAServerMayNameItsAuthority) {
  for (const char* command : {"status", "register", "origin", "record", "export", "doctor",
                              "report", "compare", "evaluate", "score", "site"})
    EXPECT_THAT(run_chorus({command, "--help"}).out, HasSubstr("--ca")) << command;
}

TEST(CommandLine, WhoeverAsksAServerIsToldWhereItsTokenComesFrom) {
  for (const char* command : {"status", "register", "origin", "record", "export"})
    EXPECT_THAT(run_chorus({command, "--help"}).out, HasSubstr("CHORUS_TOKEN")) << command;
}

TEST(CommandLine, KnowsWhatTheSmallProgramLeavesOut) {
  std::vector<std::string_view> names;
  for (const Command& command : recording_commands()) names.push_back(command.name);
  EXPECT_THAT(names, ::testing::ElementsAreArray(kRecordingCommandNames));
}

TEST(CommandLine, PrintsItsManualAndItsCompletion) {
  const Outcome manual = run_chorus({"--print", "manual"});
  EXPECT_EQ(manual.code, kExitOk);
  EXPECT_THAT(manual.out, HasSubstr(".TH CHORUS 1"));
  const Outcome completion = run_chorus({"--print", "completion"});
  EXPECT_EQ(completion.code, kExitOk);
  for (const Command& command : all_commands()) {
    const std::string name(command.name);
    const std::string in_manual = std::regex_replace(name, std::regex("-"), "\\-");
    EXPECT_THAT(manual.out, HasSubstr(".SS \"chorus " + in_manual + "\"\n"));
    EXPECT_THAT(completion.out, HasSubstr("\n    " + name + ") words=' --"));
  }
  EXPECT_THAT(manual.out, HasSubstr("\\fB\\-\\-cancel\\fR"));
  EXPECT_THAT(manual.out, HasSubstr(".SS \"chorus calibrate camera\"\n"));
  EXPECT_THAT(manual.out, HasSubstr("\\fB\\-\\-print\\-board\\fR"));
  EXPECT_THAT(completion.out, HasSubstr(" camera --help --board"));
}

TEST(CommandLine, NamesTheCommandThatWasMeant) {
  const Outcome wrong = run_chorus({"improt"});
  EXPECT_EQ(wrong.code, kExitUsage);
  EXPECT_THAT(wrong.error, HasSubstr("did you mean \"import\"?"));
  const Outcome strange = run_chorus({"xyzzyplugh"});
  EXPECT_EQ(strange.code, kExitUsage);
  EXPECT_THAT(strange.error, HasSubstr("The commands are: import, init, discover, doctor"));
}

TEST(CommandLine, TheAuthorityOnTheCommandLineIsTheOneThatIsUsed) {
  ::unsetenv("CHORUS_CA");
  const Outcome told =
      run_chorus({"status", "--url", "https://127.0.0.1:1/", "--ca", "/nowhere/ca.crt"});
  ::unsetenv("CHORUS_CA");
  EXPECT_EQ(told.code, kExitFailed);
  EXPECT_THAT(told.error, HasSubstr("/nowhere/ca.crt"));
}

TEST(CommandLine, ErrorsBeginWithTheCommandAndHaveOneLine) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"status", "--url", "ftp://x/\x1b[31m"},
        {"fuse", "/nowhere", "--out", "y"},
        {"record", "ftp://x/", "--out", "/tmp/x.mcap"},
        {"mark", "lifted", "ftp://x/"},
        {"register", "ftp://x/"},
        {"origin", "ftp://x/"}}) {
    const Outcome told = run_chorus(words);
    EXPECT_EQ(told.code, kExitFailed) << words[0];
    EXPECT_EQ(told.out, "");
    EXPECT_TRUE(told.error.starts_with("chorus " + words[0] + ": ")) << told.error;
    EXPECT_EQ(lines_of(told.error).size(), 1u) << told.error;
    EXPECT_EQ(told.error.find('\x1b'), std::string::npos);
  }
}

TEST(CommandLine, SaysItsVersion) {
  const Outcome told = run_chorus({"--version"});
  EXPECT_EQ(told.code, kExitOk);
  EXPECT_EQ(told.out, "chorus " + std::string(version()) + "\n");
}

TEST(CommandLine, WrongUsageIsToldWithTheCommandThatExplains) {
  const Outcome extra = run_chorus({"status", "http://x/", "extra"});
  EXPECT_EQ(extra.code, kExitUsage);
  EXPECT_EQ(extra.error,
            "chorus status: The following argument was not expected: extra\n"
            "chorus status --help shows what it takes.\n");
  const Outcome below = run_chorus({"calibrate", "camera", "--bord", "x"});
  EXPECT_THAT(below.error, HasSubstr("chorus calibrate camera --help shows what it takes."));
  const Outcome none = run_chorus({});
  EXPECT_EQ(none.code, kExitUsage);
  EXPECT_THAT(none.error, HasSubstr("chorus: which command? They are: import, init,"));
}

TEST(CommandLine, TellsWrongUsageFromFailure) {
  EXPECT_EQ(run_chorus({}).code, kExitUsage);
  EXPECT_EQ(run_chorus({"import"}).code, kExitUsage);
  EXPECT_EQ(run_chorus({"import", "foo", "x", "--out", "y"}).code, kExitUsage);
  EXPECT_EQ(run_chorus({"import", "ntu", "x", "--out", "y", "--start", "yesterday"}).code,
            kExitUsage);
  EXPECT_EQ(run_chorus({"import", "ntu", "x", "--out", "y", "--floor", "1,2,3"}).code, kExitUsage);
  EXPECT_EQ(run_chorus({"fuse", "x", "--out", "y", "--method", "magic"}).code, kExitUsage);
  for (const char* seconds : {"0", "7.9", "300.1"}) {
    EXPECT_EQ(run_chorus({"register", "--seconds", seconds}).code, kExitUsage) << seconds;
  }
  EXPECT_EQ(run_chorus({"replay", "x", "--port", "70000"}).code, kExitUsage);
  EXPECT_EQ(run_chorus({"fuse", "/nowhere", "--out", "y"}).code, kExitFailed);
  EXPECT_EQ(run_chorus({"import", "ntu", "/nowhere", "--out", "y"}).code, kExitFailed);
  EXPECT_EQ(run_chorus({"status", "--url", "ftp://x/"}).code, kExitFailed);
}

}  // namespace
}  // namespace chorus::ctl
