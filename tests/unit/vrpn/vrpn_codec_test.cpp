// VRPN's bytes compared with published traces, and by a reader that shares no code with ours.
#include "fusion-server/vrpn/vrpn_codec.h"

#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::vrpn {
namespace {

using testing::FailsWith;
using testing::IsOk;
using testing::u32_at;

TEST(VrpnCookie, IsTheTracedOne) {
  const std::string traced(
      "\x76\x72\x70\x6e\x3a\x20\x76\x65\x72\x2e\x20\x30\x37\x2e\x33\x38\x20\x20\x30\0\0\0\0\0", 24);
  EXPECT_EQ(cookie(), traced);
}

TEST(VrpnCookie, OfAnotherMinorVersionIsGoodAndOfAnotherMajorIsNot) {
  EXPECT_THAT(check_cookie("vrpn: ver. 07.33  0"), IsOk());
  EXPECT_THAT(check_cookie("vrpn: ver. 08.00  0"), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(check_cookie("GET / HTTP/1.1\r\nHost: x"), FailsWith(ErrorCode::Malformed));
}

TEST(VrpnMessage, LengthLeavesThePaddingOut) {
  std::string out;
  append_message(out, {from_unix_ns(1'700'000'000'123'456'789), 5, -2, 0x01020304}, "0123456789");
  ASSERT_EQ(out.size(), 40u);  // 24 + 10, padded to a multiple of 8
  EXPECT_EQ(u32_at(out, 0), 34u);
  EXPECT_EQ(u32_at(out, 4), 1'700'000'000u);
  EXPECT_EQ(u32_at(out, 8), 123'456u);
  EXPECT_EQ(u32_at(out, 12), 5u);
  EXPECT_EQ(u32_at(out, 16), 0xFFFFFFFEu);
  EXPECT_EQ(u32_at(out, 20), 0x01020304u);
  EXPECT_EQ(out.substr(24, 10), "0123456789");
  EXPECT_EQ(out.substr(34), std::string(6, '\0'));
}

TEST(VrpnMessage, IsRenumberedInPlace) {
  std::string out;
  append_message(out, {}, "");
  const std::string before = out;
  set_sequence(out.data(), 0xA1B2C3D4);
  EXPECT_EQ(u32_at(out, 20), 0xA1B2C3D4u);
  set_sequence(out.data(), 0);
  EXPECT_EQ(out, before);
}

TEST(VrpnDescription, HoldsNamesOfUpTo95Characters) {
  for (const std::size_t length : {1U, 94U, 95U, 96U, 200U}) {
    std::string out;
    append_description(out, SystemType::Sender, 3, std::string(length, 'n'));
    testing::VrpnDecoder decoder;
    decoder.take_stream(cookie() + out);
    EXPECT_EQ(decoder.error, "");
    EXPECT_EQ(decoder.senders.at(3), std::string(std::min<std::size_t>(length, 95), 'n'));
  }
}

TEST(VrpnDescription, WhoseCountDoesNotFitIsRefused) {
  EXPECT_THAT(read_description(""), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(read_description(std::string(4, '\0')), FailsWith(ErrorCode::Malformed));
  const std::string good = testing::vrpn_description(-1, 0, "Body0").substr(24, 10);
  const auto name = read_description(good);
  ASSERT_THAT(name, IsOk());
  EXPECT_EQ(*name, "Body0");
  for (const char count : {'\x07', '\x7F', '\xFF'}) {
    std::string bad = good;
    bad[3] = count;
    EXPECT_THAT(read_description(bad), FailsWith(ErrorCode::Malformed));
  }
  std::string huge = good;
  huge[0] = '\xFF';
  EXPECT_THAT(read_description(huge), FailsWith(ErrorCode::Malformed));
}

TEST(VrpnMessageReader, CutsAStreamThatComesByteByByte) {
  const std::string stream = testing::vrpn_message(1, 2, "abc") + testing::vrpn_message(3, 4, "") +
                             testing::vrpn_message(5, 6, "12345678");
  MessageReader reader;
  std::vector<std::string> seen;
  for (const char byte : stream) {
    reader.add({&byte, 1});
    const auto message = reader.next();
    ASSERT_THAT(message, IsOk());
    if (!*message) continue;
    seen.push_back(std::to_string((*message)->sender) + "/" + std::to_string((*message)->type) +
                   "/" + std::string((*message)->payload));
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"1/2/abc", "3/4/", "5/6/12345678"}));
}

TEST(VrpnMessageReader, RefusesLengthsThatCannotBe) {
  for (const std::uint32_t length : {0U, 23U, 64001U, 0x80000000U, 0xFFFFFFFFU}) {
    std::string head = testing::vrpn_message(0, 0, "");
    for (int i = 0; i < 4; ++i) head[i] = static_cast<char>(length >> (24 - 8 * i));
    MessageReader reader;
    reader.add(head);
    EXPECT_THAT(reader.next(), FailsWith(ErrorCode::Malformed)) << length;
  }
}

TEST(VrpnRequest, IsAHostAndAPort) {
  const auto traced = read_request({"127.0.0.1 33471\0", 16});
  ASSERT_THAT(traced, IsOk());
  EXPECT_EQ(*traced, 33471);
  EXPECT_THAT(read_request("some.host 1024"), IsOk());
  using namespace std::string_view_literals;
  for (const std::string_view bad :
       {""sv, " "sv, "\0"sv, "127.0.0.1"sv, "127.0.0.1 "sv, " 5000"sv, "127.0.0.1 80"sv,
        "127.0.0.1 65536"sv, "127.0.0.1 -1"sv, "127.0.0.1 5000 "sv, "127.0.0.1 5000\0x"sv,
        "::1 5000"sv, "a/b 5000"sv, "127.0.0.1 99999999999999999999"sv}) {
    EXPECT_THAT(read_request(bad), FailsWith(ErrorCode::Malformed)) << bad;
  }
  EXPECT_THAT(read_request(std::string(296, 'a') + " 5000"), FailsWith(ErrorCode::Malformed));
}

}  // namespace
}  // namespace chorus::vrpn
