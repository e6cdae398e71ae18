#include "common/tls/authority.h"

#include "common/tls/certificate.h"
#include "tests/support/workshop_authority.h"

namespace chorus::tls {
namespace {

TEST(Authority, NamesAndTimesOfAHostAreAsAsked) {
  const testing::WorkshopAuthority workshop;
  const Issued issued = workshop.issue({"sensor-1.local", "10.0.0.11", "fe80::1"}, 30);
  const auto facts = facts_of(issued.certificate);
  ASSERT_TRUE(facts);
  EXPECT_EQ(facts->subject, "sensor-1.local");
  EXPECT_EQ(facts->issuer, "Test workshop");
  EXPECT_EQ(facts->names, (std::vector<std::string>{"sensor-1.local", "10.0.0.11", "fe80::1"}));
  EXPECT_EQ(facts->not_after - facts->not_before, std::chrono::hours(30 * 24 + 1));
}

TEST(Authority, EveryKeyIsItsOwn) {
  const testing::WorkshopAuthority workshop;
  EXPECT_NE(workshop.issue({"a"}).key, workshop.issue({"a"}).key);
}

TEST(Authority, RefusesWhatIsNoHost) {
  const testing::WorkshopAuthority workshop;
  for (const char* host :
       {"", "a b", "a,IP:1.2.3.4", "http://a/", "*", "-a", "a\n", "10.0.0.300"}) {
    const auto refused = new_certificate(workshop.files(), {host}, for_days(1));
    ASSERT_FALSE(refused) << host;
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(refused.error().context, host);
  }
  EXPECT_FALSE(new_certificate(workshop.files(), {}, for_days(1)));
}

TEST(Authority, NeedsTheKeyOfItsCertificate) {
  const testing::WorkshopAuthority one;
  const testing::WorkshopAuthority other;
  const auto refused =
      new_certificate({one.files().certificate, other.files().key}, {"a"}, for_days(1));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("chorus init ca"), std::string::npos);
  EXPECT_FALSE(new_certificate({"nothing", "nothing"}, {"a"}, for_days(1)));
}

TEST(Authority, ALongNameIsCutBetweenCharacters) {
  std::string name(63, 'a');
  name += "\u00e9\u00e9";  // two bytes each
  const auto issued = new_authority(name, for_days(1));
  ASSERT_TRUE(issued);
  // The name was cut between characters, so one whole two-byte character is left; facts show each
  // byte beyond ASCII as "?".
  EXPECT_EQ(facts_of(issued->certificate)->subject, std::string(63, 'a') + "??");
}

TEST(Authority, ANameThatIsNotUtf8IsRefused) {
  for (const char* name : {"\xff", "Werkstatt \xe4", "cut \xc3"}) {
    const auto refused = new_authority(name, for_days(1));
    ASSERT_FALSE(refused) << name;
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
  }
}

TEST(Certificate, DatesAreShownByDay) {
  EXPECT_EQ(date_text(std::chrono::sys_seconds(std::chrono::seconds(0))), "1970-01-01");
  EXPECT_FALSE(facts_of("no certificate"));
}

}  // namespace
}  // namespace chorus::tls
