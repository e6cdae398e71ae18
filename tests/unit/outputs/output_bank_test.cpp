// Outputs are opened, closed and changed while frames go on.
#include "fusion-server/outputs/output_bank.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/net/asio.h"
#include "tests/support/matchers.h"

namespace chorus::outputs {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::IsOk;

/// The outputs of a section "outputs".
OutputsConfig outputs_in(std::string_view text) {
  auto root = ConfigReader::parse(text, "test.json");
  OutputsConfig config;
  read_outputs(*root, config);
  return config;
}

OutputsConfig osc(int vmc_port) {
  return outputs_in(R"({"mxtp": {"enabled": true, "targets": ["127.0.0.1:9"]}, )"
                    R"("vmc": {"enabled": true, "targets": ["127.0.0.1:)" +
                    std::to_string(vmc_port) + "\"]}}");
}

std::vector<std::string> names_of(const OutputBank& bank) {
  std::vector<std::string> names;
  for (const OutputStatus& one : bank.states()) names.push_back(one.name);
  return names;
}

TEST(OutputBank, OpensClosesAndLeavesTheOthersAlone) {
  OutputBank bank({std::make_shared<SystemClock>()});
  ASSERT_THAT(bank.apply(osc(10)), IsOk());
  EXPECT_THAT(names_of(bank), ::testing::ElementsAre("mxtp", "vmc"));
  const auto sent = [&](std::size_t index) { return bank.states()[index].counters.frames; };
  const auto send = [&] {
    const auto before = sent(0);
    for (int i = 0; i < 2000 && sent(0) == before; ++i) {
      bank.publish(std::make_shared<const Snapshot>());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  send();
  const auto before = sent(0);
  EXPECT_GT(before, 0u);
  ASSERT_THAT(bank.apply(osc(11)), IsOk());
  EXPECT_GE(sent(0), before) << "mxtp goes on as it was";
  EXPECT_EQ(sent(1), 0u) << "vmc is another one now";
  ASSERT_THAT(bank.apply({}), IsOk());
  EXPECT_THAT(bank.states(), IsEmpty());
  bank.publish(std::make_shared<const Snapshot>());
}

TEST(OutputBank, OneThatCannotBeOpenedIsToldAndTriedAgain) {
  asio::io_context io;
  asio::ip::tcp::acceptor taken(io, {asio::ip::address_v4::loopback(), 0});
  const auto config = outputs_in(R"({"vrpn": {"enabled": true, "address": "127.0.0.1", "port": )" +
                                 std::to_string(taken.local_endpoint().port()) +
                                 R"(}, "mxtp": {"enabled": true, "targets": ["127.0.0.1:9"]}})");
  OutputBank bank({std::make_shared<SystemClock>()});
  ASSERT_FALSE(bank.apply(config));
  ASSERT_EQ(bank.states().size(), 2u);
  EXPECT_EQ(bank.states()[0].error, "") << "mxtp is open all the same";
  EXPECT_THAT(bank.states()[1].error, HasSubstr("outputs.vrpn"));
  taken.close();
  ASSERT_THAT(bank.apply(config), IsOk()) << "although nothing has changed in the file";
  EXPECT_EQ(bank.states()[1].error, "");
}

TEST(OutputBank, KnowsWhichOutputHasChanged) {
  const auto names = output_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    EXPECT_EQ(same_output(osc(10), osc(11), i), names[i] != "vmc") << names[i];
}

}  // namespace
}  // namespace chorus::outputs
