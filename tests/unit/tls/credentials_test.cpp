#include "common/tls/credentials.h"

#include <fstream>

#include "tests/support/temporary_folder.h"
#include "tests/support/workshop_authority.h"

namespace chorus::tls {
namespace {

class CredentialsTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name, const std::string& text) const {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path) << text;
    return path;
  }

  testing::TemporaryFolder folder_;
  testing::WorkshopAuthority workshop_;
};

TEST_F(CredentialsTest, LoadsACertificateWithItsKey) {
  const Issued issued = workshop_.issue({"a"});
  const auto identity =
      Identity::load(file("a.crt", issued.certificate), file("a.key", issued.key));
  ASSERT_TRUE(identity) << to_string(identity.error());
  EXPECT_EQ(identity->certificate(), issued.certificate);
  EXPECT_EQ(*identity, Identity::of(issued.certificate, issued.key).value());
  EXPECT_FALSE(*identity == workshop_.identity({"a"}));
}

TEST_F(CredentialsTest, EachMistakeNamesItsFile) {
  const Issued issued = workshop_.issue({"a"});
  const std::string certificate = file("a.crt", issued.certificate);
  const std::string key = file("a.key", issued.key);
  const std::string other = file("b.key", workshop_.issue({"a"}).key);
  const std::string empty = file("empty", "");
  const auto error_of = [](const std::string& c, const std::string& k) {
    const auto refused = Identity::load(c, k);
    return refused ? Error{} : refused.error();
  };
  EXPECT_EQ(error_of("/nowhere.crt", key).code, ErrorCode::NotFound);
  EXPECT_EQ(error_of("/nowhere.crt", key).context, "/nowhere.crt");
  EXPECT_EQ(error_of(certificate, "/nowhere.key").context, "/nowhere.key");
  EXPECT_EQ(error_of(empty, key).context, empty);
  EXPECT_EQ(error_of(key, certificate).context, key);
  EXPECT_EQ(error_of(certificate, empty).context, empty);
  EXPECT_EQ(error_of(certificate, other).context, other);
  EXPECT_NE(error_of(certificate, other).message.find("another certificate"), std::string::npos);
}

TEST_F(CredentialsTest, TrustIsAFileOrTheSystem) {
  const auto trust = Trust::load(file("ca.crt", workshop_.files().certificate));
  ASSERT_TRUE(trust);
  EXPECT_NE(trust->context(), nullptr);
  const auto system = Trust::load("");
  ASSERT_TRUE(system);
  EXPECT_EQ(*system, Trust());
  EXPECT_NE(system->context(), nullptr);
  EXPECT_FALSE(*trust == *system);
  EXPECT_FALSE(Trust::load(file("empty.crt", "")));
  const auto missing = Trust::load("/nowhere/ca.crt");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().context, "/nowhere/ca.crt");
}

}  // namespace
}  // namespace chorus::tls
