// chorus init site writes a server's configuration and what cells need, and joins a cell to it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/config_reader.h"
#include "fusion-server/server/fusion_settings.h"
#include "services/ctl/setup/site_findings.h"
#include "services/ctl/setup/written_site.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SiteWishes hall() {
  SiteWishes wishes;
  wishes.name = "hall";
  wishes.cells = {"a", "b"};
  wishes.address = "10.0.0.5";
  return wishes;
}

TEST(InitSite, LetsEachCellPublishUnderItsOwnNameOnly) {
  const std::string text = server_config(hall(), {"secret-a", "secret-b", "secret-r"});
  EXPECT_THAT(text, HasSubstr("\"chorus.hall.a.>\""));
  EXPECT_THAT(text, HasSubstr("\"$KV.chorus_cells.b\""));
  EXPECT_THAT(text, HasSubstr("user: \"reader\""));
  EXPECT_THAT(text, HasSubstr("\"$2b$"));
  EXPECT_THAT(text, Not(HasSubstr("secret-")));
  EXPECT_THAT(text, Not(HasSubstr("tls {")));
  SiteWishes secure = hall();
  secure.tls = "/etc/chorus/tls";
  EXPECT_THAT(server_config(secure, {"1", "2", "3"}), HasSubstr("/etc/chorus/tls/host.key"));
  EXPECT_THAT(cell_config(secure, "b", "p"), HasSubstr("\"tls://10.0.0.5:4222\""));
}

TEST(InitSite, KeepsUsersFromWhatIsNotTheirs) {
  const std::string text = server_config(hall(), {"1", "2", "3"});
  EXPECT_THAT(text, HasSubstr("\"$JS.API.STREAM.MSG.DELETE.>\""));
  EXPECT_THAT(text, HasSubstr("\"$JS.API.CONSUMER.DELETE.>\""));
  for (const char* inbox : {"\"_INBOX.a.>\"", "\"_INBOX.b.>\"", "\"_INBOX.reader.>\""})
    EXPECT_THAT(text, HasSubstr(inbox));
  EXPECT_THAT(text, Not(HasSubstr("\"_INBOX.>\"")));
}

TEST(InitSite, JoinsOnlyWithTheAuthoritysCertificate) {
  const testing::TemporaryFolder folder;
  SiteWishes secure = hall();
  secure.tls = (folder / "tls").string();
  const auto cell = folder.write("a.json", cell_config(secure, "a", "p"));
  const auto fusion = folder.write("fusion.json", "{}\n");
  const std::vector<std::string> join{"init",        "site",  "--join",
                                      cell.string(), "--out", fusion.string()};
  const Outcome refused = run_chorus(join);
  EXPECT_EQ(refused.code, kExitFailed);
  EXPECT_THAT(refused.error, HasSubstr("ca.crt"));
  EXPECT_EQ(testing::bytes_of(fusion), "{}\n");
  std::filesystem::create_directory(folder / "tls");
  folder.write("tls/ca.crt", "certificate");
  EXPECT_EQ(run_chorus(join).code, kExitOk);
}

TEST(InitSite, RefusesNamesThatAreNone) {
  for (const std::vector<std::string>& cells :
       {std::vector<std::string>{}, {"a", "a"}, {"a b"}, {"a.b"}, {"reader"}, {"*"}}) {
    SiteWishes wishes = hall();
    wishes.cells = cells;
    EXPECT_FALSE(check_site(wishes));
  }
  SiteWishes wishes = hall();
  wishes.name = "hall.3";
  EXPECT_FALSE(check_site(wishes));
}

TEST(InitSite, WritesWhatTheFusionServerReadsAfterJoining) {
  const testing::TemporaryFolder folder;
  const std::string site = (folder / "site").string();
  const Outcome made = run_chorus({"init", "site", "--name", "hall", "--cell", "a", "--cell", "b",
                                   "--address", "10.0.0.5", "--no-tls", "--out", site});
  ASSERT_EQ(made.code, kExitOk) << made.error;
  const auto fusion = folder.write("fusion.json", "{\n  \"title\": \"A\" // ours }\n}\n// end }\n");
  const Outcome joined =
      run_chorus({"init", "site", "--join", site + "/a.json", "--out", fusion.string()});
  ASSERT_EQ(joined.code, kExitOk) << joined.error;
  const std::string text = testing::bytes_of(fusion);
  EXPECT_THAT(text, HasSubstr("// ours }"));
  auto root = ConfigReader::parse(text, "joined");
  ASSERT_TRUE(root) << to_string(root.error()) << text;
  const auto settings = server::read_fusion_settings(*root);
  ASSERT_TRUE(settings) << to_string(settings.error());
  const nats::LinkConfig& link = settings->at_start.site.link;
  EXPECT_EQ(link.site, "hall");
  EXPECT_EQ(link.cell.str(), "a");
  EXPECT_EQ(link.broker.servers, std::vector<std::string>{"nats://10.0.0.5:4222"});
  EXPECT_EQ(link.broker.user, "a");
  EXPECT_EQ(link.broker.password.size(), 32U);
  const Outcome again =
      run_chorus({"init", "site", "--join", site + "/a.json", "--out", fusion.string()});
  EXPECT_EQ(again.code, kExitFailed);
  EXPECT_THAT(again.error, HasSubstr("already"));
  EXPECT_EQ(run_chorus({"init", "site", "--name", "hall", "--cell", "a", "--out", site}).code,
            kExitUsage)
      << "nothing is overwritten";
}

TEST(InitSite, JoinsAnEmptyConfigurationToo) {
  const auto joined = joined_config("{}", R"({"site": {"name": "hall"}})");
  ASSERT_TRUE(joined) << to_string(joined.error());
  EXPECT_EQ(ConfigReader::parse(*joined, "joined")->text("site"), R"({"name":"hall"})");
  EXPECT_FALSE(joined_config("{}", "{}"));
  EXPECT_FALSE(joined_config("[", R"({"site": {}})"));
}

TEST(DoctorOfASite, SaysWhichCellIsNotWell) {
  const auto all = site_findings_of(nlohmann::json::parse(R"({"siteName": "hall",
      "connected": true, "server": "nats://10.0.0.5:4222", "siteCells": {
      "a": {"state": "own", "placed": true}, "b": {"state": "silent", "placed": true},
      "c": {"state": "heard", "placed": false}, "d": {"state": "mistrusted", "placed": true},
      "e": {"state": "heard", "placed": true}}})"));
  ASSERT_EQ(all.size(), 6U);
  const std::vector<bool> good{true, true, false, false, false, true};
  for (std::size_t i = 0; i < good.size(); ++i) EXPECT_EQ(all[i].good, good[i]) << all[i].words;
  const auto alone = site_findings_of(nlohmann::json::parse(
      R"({"siteName": "hall", "connected": false, "trouble": "the password is wrong"})"));
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_FALSE(alone[0].good);
  EXPECT_THAT(alone[0].words, HasSubstr("the password is wrong"));
  EXPECT_FALSE(site_findings_of(nlohmann::json::parse("[]"))[0].good);
}

}  // namespace
}  // namespace chorus::ctl
