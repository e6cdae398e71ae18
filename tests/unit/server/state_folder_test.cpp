// State has a default folder, one per server, and an unusable folder is reported at once.
#include "fusion-server/server/state_folder.h"

#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace chorus::server {
namespace {

Environment with(std::map<std::string, std::string> variables) {
  return [variables = std::move(variables)](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  };
}

TEST(StateFolder, IsWhatTheConfigurationSays) {
  const auto environment = with({{"HOME", "/home/me"}, {"STATE_DIRECTORY", "/var/lib/chorus"}});
  EXPECT_EQ(state_folder("var/state", 8080, environment), "var/state");
  EXPECT_EQ(state_folder("", 8080, environment), "") << "nowhere, on purpose";
}

TEST(StateFolder, ByDefaultIsTheServicesOwnThenTheUsers) {
  const std::map<std::string, std::string> home{{"HOME", "/home/me"}};
  EXPECT_EQ(state_folder("auto", 8080, with(home)), "/home/me/.local/state/chorus/fusion-8080");
  auto all = home;
  all["XDG_STATE_HOME"] = "/home/me/state";
  EXPECT_EQ(state_folder("auto", 8090, with(all)), "/home/me/state/chorus/fusion-8090");
  all["STATE_DIRECTORY"] = "/var/lib/chorus:/var/lib/other";
  EXPECT_EQ(state_folder("auto", 8080, with(all)), "/var/lib/chorus");
  EXPECT_EQ(state_folder("auto", 0, with(all)), "/var/lib/chorus");
}

TEST(StateFolder, IsNowhereWithoutAHomeOrAPortOfItsOwn) {
  EXPECT_EQ(state_folder("auto", 8080, with({})), "");
  EXPECT_EQ(state_folder("auto", 8080, with({{"HOME", ""}, {"XDG_STATE_HOME", "relative"}})), "");
  EXPECT_EQ(state_folder("auto", 0, with({{"HOME", "/home/me"}})), "");
}

TEST(Probing, MakesTheFolderAndLeavesNothingInIt) {
  const testing::TemporaryFolder folder;
  const auto deep = folder / "deep/er";
  EXPECT_TRUE(probe_folder(deep.string()));
  EXPECT_TRUE(std::filesystem::is_empty(deep));
}

TEST(Probing, NamesTheFolderThatCannotBeUsed) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("file", "in the way");
  for (const auto& path : {file.string(), (file / "below").string(), std::string("/proc/chorus")}) {
    const auto probe = probe_folder(path);
    ASSERT_FALSE(probe) << path;
    EXPECT_EQ(probe.error().context, path);
    EXPECT_NE(probe.error().message.find("chown"), std::string::npos) << path;
  }
}

TEST(ViewerFolder, ByDefaultIsTheOneThatComesWithTheProgram) {
  EXPECT_TRUE(viewer_folder("auto").ends_with("services/viewer")) << viewer_folder("auto");
  EXPECT_EQ(viewer_folder("elsewhere"), "elsewhere");
  EXPECT_EQ(viewer_folder(""), "") << "none, on purpose";
}

TEST(Probing, AViewerThatIsNotThereIsSaidToBeLookedForWhere) {
  const auto probe = probe_viewer("");
  ASSERT_FALSE(probe);
  EXPECT_NE(probe.error().message.find("services/viewer"), std::string::npos);
}

TEST(Probing, TheViewerNeedsItsFilesAndThree) {
  const testing::TemporaryFolder folder;
  EXPECT_NE(probe_viewer(folder.path().string()).error().message.find("index.html"),
            std::string::npos);
  folder.write("index.html", "");
  EXPECT_NE(probe_viewer(folder.path().string()).error().message.find("npm ci"), std::string::npos);
  std::filesystem::create_directories(folder / "node_modules/three");
  EXPECT_TRUE(probe_viewer(folder.path().string()));
}

TEST(StateClaim, IsForOneServerUntilItEnds) {
  const chorus::testing::TemporaryFolder folder;
  const std::string path = folder.path().string();
  {
    auto first = StateClaim::take(path);
    ASSERT_TRUE(first);
    const StateClaim moved = std::move(*first);
    const auto second = StateClaim::take(path);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::Conflict);
    EXPECT_EQ(second.error().context, path);
  }
  EXPECT_TRUE(StateClaim::take(path));
  EXPECT_TRUE(StateClaim::take(""));
  EXPECT_TRUE(StateClaim::take((folder / "missing").string()));
}

}  // namespace
}  // namespace chorus::server
