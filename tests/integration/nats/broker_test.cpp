#include "fusion-server/nats/broker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>

#include "fusion-server/nats/ledger.h"
#include "fusion-server/nats/subjects.h"
#include "tests/support/nats_server.h"
#include "tests/support/workshop_authority.h"

namespace chorus::nats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::NatsServer;

constexpr auto kPatience = std::chrono::seconds(20);

/// What was heard, in order.
class Heard {
 public:
  void add(std::string text) {
    {
      const std::scoped_lock lock(mutex_);
      all_.push_back(std::move(text));
    }
    came_.notify_all();
  }
  std::vector<std::string> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    came_.wait_for(lock, kPatience, [&] { return all_.size() >= count; });
    return all_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<std::string> all_;
};

template <class Condition>
bool becomes_true(const Condition& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!condition() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return condition();
}

BrokerConfig config_of(const NatsServer& server) {
  BrokerConfig config;
  config.servers = {server.url()};
  config.name = "test";
  config.least_wait = std::chrono::milliseconds(10);
  config.most_wait = std::chrono::milliseconds(50);
  config.patience = std::chrono::seconds(5);
  return config;
}

/// The first answer to a request, by a client that speaks NATS by hand; empty: there is none.
std::string answer_to(const NatsServer& server, const std::string& subject,
                      const std::string& bytes) {
  const int door = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = testing::loopback(server.port());
  const timeval patience{5, 0};
  ::setsockopt(door, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::string heard;
  if (::connect(door, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    const std::string words = "CONNECT {\"verbose\":false}\r\nSUB answers 1\r\nPUB " + subject +
                              " answers " + std::to_string(bytes.size()) + "\r\n" + bytes + "\r\n";
    (void)!::write(door, words.data(), words.size());
    char piece[512];
    for (ssize_t size = 1; size > 0 && heard.find("MSG ") == std::string::npos;) {
      size = ::read(door, piece, sizeof piece);
      if (size > 0) heard.append(piece, static_cast<std::size_t>(size));
    }
  }
  ::close(door);
  const std::size_t message = heard.find("MSG ");
  if (message == std::string::npos) return {};
  const std::size_t begin = heard.find("\r\n", message) + 2;
  return heard.substr(begin, heard.find("\r\n", begin) - begin);
}

bool connects(const Broker& broker) {
  return becomes_true([&] { return broker.status().connected; });
}

TEST(ABroker, PassesOnWhatIsPublishedAndAnswers) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  Heard heard;
  std::unique_ptr<Broker> broker;
  const auto answer = [&](const Message& m) {
    broker->publish(std::string(m.reply), "you asked " + std::string(m.bytes));
  };
  const auto note = [&](const Message& m) {
    heard.add(std::string(m.subject) + " " + std::string(m.bytes));
  };
  broker = std::make_unique<Broker>(
      config_of(server), Listening{{{"chorus.hall.*.people", note}, {"chorus.ask", answer}}, {}});
  ASSERT_TRUE(connects(*broker)) << broker->status().trouble;
  EXPECT_TRUE(broker->publish("chorus.hall.a.people", "one"));
  EXPECT_TRUE(broker->publish("chorus.hall.a.frame", "not for us"));
  EXPECT_TRUE(broker->publish("chorus.hall.b.people", "two"));
  EXPECT_THAT(heard.wait_for(2),
              ElementsAre("chorus.hall.a.people one", "chorus.hall.b.people two"));
  EXPECT_EQ(answer_to(server, "chorus.ask", "this"), "you asked this");
}

TEST(ABroker, WritesOnlyOverTheRevisionThatIsKnown) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  Heard changes;
  Broker broker(config_of(server),
                {{}, {{"people", [&](const Entry& e) { changes.add(e.key + "=" + e.value); }}}});
  ASSERT_TRUE(connects(broker)) << broker.status().trouble;
  EXPECT_EQ(broker.get("people", "person.7").error().code, ErrorCode::NotFound);
  const auto first = broker.update("people", {"person.7", "a", 0});
  ASSERT_TRUE(first) << to_string(first.error());
  // Who follows a bucket late hears of the newest value of a key only.
  EXPECT_THAT(changes.wait_for(1), ElementsAre("person.7=a"));
  const auto twice = broker.update("people", {"person.7", "b", 0});
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().code, ErrorCode::Conflict) << to_string(twice.error());
  const auto second = broker.update("people", {"person.7", "c", *first});
  ASSERT_TRUE(second) << to_string(second.error());
  EXPECT_GT(*second, *first);
  const auto stale = broker.update("people", {"person.7", "d", *first});
  ASSERT_FALSE(stale);
  EXPECT_EQ(stale.error().code, ErrorCode::Conflict);
  const auto now = broker.get("people", "person.7");
  ASSERT_TRUE(now);
  EXPECT_EQ(now->value, "c");
  EXPECT_EQ(now->revision, *second);
  // The two that were refused are not heard.
  ASSERT_TRUE(broker.put("people", {"person.8", "e", 0}));
  EXPECT_THAT(changes.wait_for(3), ElementsAre("person.7=a", "person.7=c", "person.8=e"));
}

TEST(ABroker, HearsOfOneBucketWhileAnotherChangesWithoutEnd) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  Heard calm;
  std::atomic<int> busy = 0;
  auto broker = std::make_unique<Broker>(
      config_of(server), Listening{{},
                                   {{"busy", [&](const Entry&) { ++busy; }},
                                    {"calm", [&](const Entry& e) { calm.add(e.value); }}}});
  ASSERT_TRUE(connects(*broker));
  Broker writer(config_of(server), {});
  ASSERT_TRUE(connects(writer));
  const std::jthread talker([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) (void)writer.put("busy", {"key", "value", 0});
  });
  ASSERT_TRUE(becomes_true([&] { return busy > 300; }));
  ASSERT_TRUE(broker->put("calm", {"a", "1", 0}));
  EXPECT_THAT(calm.wait_for(1), ElementsAre("1"));
  broker.reset();  // The writer still writes.
}

TEST(ABroker, HasItsAnswersWhereNobodyElseListens) {
  NatsServer server(
      "authorization { users: [ { user: a, password: p, permissions: { publish: [\">\"], "
      "subscribe: [\"_INBOX.a.>\"] } } ] }\n");
  ASSERT_TRUE(server.start()) << server.log();
  BrokerConfig config = config_of(server);
  config.user = "a";
  config.password = "p";
  Heard changes;
  Broker broker(config, {{}, {{"people", [&](const Entry& e) { changes.add(e.value); }}}});
  ASSERT_TRUE(connects(broker)) << broker.status().trouble;
  const auto written = broker.put("people", {"person.7", "one", 0});
  ASSERT_TRUE(written) << to_string(written.error());
  EXPECT_THAT(changes.wait_for(1), ElementsAre("one"));
  EXPECT_EQ(broker.status().trouble, "");
}

TEST(ALedger, SaysThatTheStoreHasForgottenARecord) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  Watch people{kPeopleBucket, [](const Entry&) {}, std::chrono::milliseconds(300)};
  Broker broker(config_of(server), {{}, {people}});
  ASSERT_TRUE(connects(broker));
  std::mutex mutex;
  std::vector<site::ClaimResult> results;
  Ledger ledger(broker, [&](site::ClaimResult result) {
    const std::scoped_lock lock(mutex);
    results.push_back(std::move(result));
  });
  const auto ask = [&](std::uint64_t expected) {
    const std::size_t before = results.size();
    ledger.ask({{site::SiteId::parse("k1").value(), site::CellId::parse("a").value()}, expected});
    becomes_true([&] {
      const std::scoped_lock lock(mutex);
      return results.size() > before;
    });
    const std::scoped_lock lock(mutex);
    return results.size() > before ? results.back() : site::ClaimResult{};
  };
  const site::ClaimResult first = ask(0);
  ASSERT_TRUE(first.accepted);
  ASSERT_GT(first.now.revision, 0U);
  ASSERT_TRUE(becomes_true([&] {
    const auto entry = broker.get(kPeopleBucket, "person.k1");
    return !entry && entry.error().code == ErrorCode::NotFound;
  }));
  const site::ClaimResult late = ask(first.now.revision);
  EXPECT_FALSE(late.accepted);
  EXPECT_EQ(late.now.id.str(), "k1");
  EXPECT_EQ(late.now.revision, 0U);
  EXPECT_TRUE(ask(0).accepted);
}

TEST(ABroker, HearsWhatABucketHoldsWhenItConnects) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  Broker writer(config_of(server), {});
  ASSERT_TRUE(connects(writer));
  ASSERT_TRUE(writer.put("cells", {"a", "1", 0}));
  ASSERT_TRUE(writer.put("cells", {"a", "2", 0}));
  Heard changes;
  const Broker reader(config_of(server),
                      {{}, {{"cells", [&](const Entry& e) { changes.add(e.value); }}}});
  EXPECT_THAT(changes.wait_for(1), ElementsAre("2"));
}

TEST(ABroker, ComesBackAfterTheServerWasKilled) {
  NatsServer server;
  ASSERT_TRUE(server.start()) << server.log();
  Heard heard;
  Broker broker(config_of(server),
                {{{"news", [&](const Message& m) { heard.add(std::string(m.bytes)); }}}, {}});
  ASSERT_TRUE(connects(broker));
  EXPECT_TRUE(broker.publish("news", "before"));
  EXPECT_EQ(heard.wait_for(1).size(), 1U);
  server.stop(SIGKILL);
  ASSERT_TRUE(becomes_true([&] { return !broker.status().connected; }));
  EXPECT_FALSE(broker.publish("news", "lost"));
  EXPECT_EQ(broker.get("people", "x").error().code, ErrorCode::Unavailable);
  EXPECT_EQ(broker.status().dropped, 1U);
  ASSERT_TRUE(server.start()) << server.log();
  ASSERT_TRUE(connects(broker)) << broker.status().trouble;
  EXPECT_TRUE(broker.publish("news", "after"));
  EXPECT_THAT(heard.wait_for(2), ElementsAre("before", "after"));
  EXPECT_EQ(broker.status().connects, 2U);
}

TEST(ABroker, IsBuiltWithoutAServerAndSaysSo) {
  NatsServer nowhere;  // never started
  Broker broker(config_of(nowhere), {});
  EXPECT_FALSE(broker.publish("news", "lost"));
  EXPECT_TRUE(becomes_true([&] { return !broker.status().trouble.empty(); }));
  EXPECT_FALSE(broker.status().connected);
}

TEST(ABroker, SaysThatThePasswordIsWrongAndTriesAgain) {
  NatsServer server("authorization { users: [ { user: a, password: right } ] }\n");
  ASSERT_TRUE(server.start()) << server.log();
  BrokerConfig config = config_of(server);
  config.user = "a";
  config.password = "wrong";
  const Broker stranger(config, {});
  EXPECT_TRUE(becomes_true([&] { return !stranger.status().trouble.empty(); }));
  EXPECT_THAT(stranger.status().trouble, HasSubstr("refuses the user or the password"));
  config.password = "right";
  const Broker known(config, {});
  EXPECT_TRUE(connects(known)) << known.status().trouble;
  EXPECT_FALSE(stranger.status().connected);
}

TEST(ABroker, SaysWhatItMayNotPublish) {
  NatsServer server(
      "authorization { users: [ { user: a, password: p, permissions: { publish: [\"mine.>\"] } } ] "
      "}\n");
  ASSERT_TRUE(server.start()) << server.log();
  BrokerConfig config = config_of(server);
  config.user = "a";
  config.password = "p";
  Broker broker(config, {});
  ASSERT_TRUE(connects(broker));
  broker.publish("theirs.x", "no");
  EXPECT_TRUE(becomes_true([&] { return !broker.status().trouble.empty(); }));
  EXPECT_THAT(broker.status().trouble, HasSubstr("theirs.x"));
}

TEST(ABroker, TrustsOnlyServersOfItsAuthority) {
  const testing::WorkshopAuthority authority;
  const testing::WorkshopAuthority other;
  const testing::TemporaryFolder folder;
  const tls::Issued issued = authority.issue({"127.0.0.1", "localhost"});
  const auto certificate = folder.write("host.crt", issued.certificate);
  const auto key = folder.write("host.key", issued.key);
  NatsServer server("tls { cert_file: \"" + certificate.string() + "\", key_file: \"" +
                    key.string() + "\" }\n");
  ASSERT_TRUE(server.start()) << server.log();
  BrokerConfig config = config_of(server);
  config.ca_file = folder.write("ca.crt", authority.files().certificate).string();
  const Broker trusting(config, {});
  EXPECT_TRUE(connects(trusting)) << trusting.status().trouble;
  config.ca_file = folder.write("other.crt", other.files().certificate).string();
  const Broker distrusting(config, {});
  EXPECT_TRUE(becomes_true([&] { return !distrusting.status().trouble.empty(); }));
  EXPECT_FALSE(distrusting.status().connected);
  config.ca_file.clear();
  const Broker plain(config, {});
  EXPECT_TRUE(becomes_true([&] { return !plain.status().trouble.empty(); }));
  EXPECT_FALSE(plain.status().connected);
}

}  // namespace
}  // namespace chorus::nats
