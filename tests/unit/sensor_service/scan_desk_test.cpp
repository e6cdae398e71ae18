// Photos of hands over a WebSocket, with a scan that says what the test says.
#include "services/sensor/device/scan/scan_desk.h"

#include <atomic>
#include <latch>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "services/sensor/device/scan/scan_dialogue.h"

namespace chorus::scan {
namespace {

using Json = nlohmann::json;

/// The first message of the dialogue's answer, waited for.
Json answer_of(http::Dialogue& dialogue) {
  while (true) {
    const http::Reply reply = dialogue.look();
    if (!reply.messages.empty()) return Json::parse(reply.messages.front());
    std::this_thread::yield();
  }
}

std::string scan_message(const std::string& photo, const std::string& scale = "a4") {
  return Json{{"type", "scan"}, {"scale", scale}, {"view", "back"}, {"photo", photo}}.dump();
}

Json refusal(http::Dialogue& dialogue, std::string_view message) {
  const http::Reply reply = dialogue.hear(message);
  return reply.messages.empty() ? Json() : Json::parse(reply.messages.front());
}

TEST(ScanDialogue, AnswersWithTheHandThatTheScanFinds) {
  const auto desk = std::make_shared<ScanDesk>([](const Photo& photo) -> Result<PhotoAnswer> {
    EXPECT_EQ(photo.bytes, "Chorus!!");
    EXPECT_EQ(photo.scale, "a4");
    EXPECT_TRUE(photo.back);
    return PhotoAnswer{"HIERARCHY", "[Header]", R"({"side": "left"})", std::string("\0\xff", 2)};
  });
  const auto dialogue = scan_dialogue(desk);
  EXPECT_TRUE(dialogue->hear(scan_message("Q2hvcnVzISE=")).messages.empty());
  const Json hand = answer_of(*dialogue);
  EXPECT_EQ(hand["type"], "hand");
  EXPECT_EQ(hand["bvh"], "HIERARCHY");
  EXPECT_EQ(hand["htr"], "[Header]");
  EXPECT_EQ(hand["picture"], "AP8=");
  EXPECT_EQ(hand["report"]["side"], "left");
  EXPECT_TRUE(dialogue->look().messages.empty()) << "once";
}

TEST(ScanDialogue, SaysWhyAPhotoIsRefused) {
  const auto desk = std::make_shared<ScanDesk>([](const Photo& photo) -> Result<PhotoAnswer> {
    if (photo.bytes == "abc") throw std::runtime_error("broken");
    return fail(ErrorCode::NotFound, "hand", "two hands are in the picture");
  });
  const auto dialogue = scan_dialogue(desk);
  EXPECT_TRUE(dialogue->hear(scan_message("YWJj", "none")).messages.empty());
  EXPECT_EQ(answer_of(*dialogue)["detail"], "broken");
  EXPECT_TRUE(dialogue->hear(scan_message("YWJjZGVm")).messages.empty());
  const Json answer = answer_of(*dialogue);
  EXPECT_EQ(answer["type"], "refused");
  EXPECT_EQ(answer["detail"], "two hands are in the picture");
}

TEST(ScanDialogue, RefusesMessagesThatItDoesNotUnderstand) {
  const auto desk =
      std::make_shared<ScanDesk>([](const Photo&) -> Result<PhotoAnswer> { return PhotoAnswer{}; });
  const auto dialogue = scan_dialogue(desk);
  EXPECT_EQ(refusal(*dialogue, "not JSON")["context"], "type");
  EXPECT_EQ(refusal(*dialogue, "[1, 2]")["context"], "type");
  EXPECT_EQ(refusal(*dialogue, R"({"type": "scan"})")["context"], "photo");
  EXPECT_EQ(refusal(*dialogue, scan_message("%%%%"))["context"], "photo");
  EXPECT_EQ(refusal(*dialogue, scan_message("YWJj", "letter"))["context"], "scale");
  EXPECT_TRUE(dialogue->end({ErrorCode::TooLarge, "", "too long"}).over);
}

TEST(ScanDesk, LetsFewWaitAndForgetsThoseThatLeave) {
  std::latch begun(1);
  std::latch go_on(1);
  std::atomic<int> scanned{0};
  ScanDesk desk([&](const Photo&) -> Result<PhotoAnswer> {
    if (scanned++ == 0) {
      begun.count_down();
      go_on.wait();
    }
    return PhotoAnswer{};
  });
  const auto first = desk.take({"1"});
  begun.wait();
  std::vector<std::shared_ptr<Ticket>> waiting;
  for (std::size_t i = 0; i < ScanDesk::kMostWaiting; ++i) {
    auto ticket = desk.take({"more"});
    ASSERT_TRUE(ticket);
    waiting.push_back(*ticket);
  }
  EXPECT_FALSE(desk.take({"too many"}));
  waiting.erase(waiting.begin() + 1, waiting.end());
  const auto last = desk.take({"last"});
  ASSERT_TRUE(last);
  go_on.count_down();
  while (!(*last)->answer()) std::this_thread::yield();
  EXPECT_EQ(scanned, 3) << "the first, one that waited, and the last";
}

}  // namespace
}  // namespace chorus::scan
