#include "fusion-server/server/cell_frame_desk.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace chorus::server {
namespace {

/// What the desk says once it has asked.
Result<http::DocumentPtr> answer_of(CellFrameDesk& desk, const std::string& cell,
                                    const std::string& at) {
  for (int i = 0; i < 2000; ++i) {
    auto answer = desk.frame(cell, at);
    if (answer || answer.error().code != ErrorCode::Unavailable) return answer;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return fail(ErrorCode::Unavailable, "test", "nothing came");
}

TEST(ACellFrameDesk, AsksOnlyWhatSomebodyAsks) {
  std::atomic<int> asked = 0;
  CellFrameDesk desk("run", [&](const std::string& cell, const std::string& at) {
    ++asked;
    return Result<std::string>("{\"cell\": \"" + cell + "\", \"at\": \"" + at + "\"}");
  });
  EXPECT_EQ(asked, 0);
  const auto first = desk.frame("b", "17");
  ASSERT_FALSE(first);
  EXPECT_EQ(first.error().code, ErrorCode::Unavailable);
  const auto then = answer_of(desk, "b", "17");
  ASSERT_TRUE(then) << to_string(then.error());
  ASSERT_TRUE(*then);
  // The frame of an instant does not change.
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(desk.frame("b", "17"));
  EXPECT_EQ(asked, 1);
}

TEST(ACellFrameDesk, SaysWhyThereIsNone) {
  CellFrameDesk desk("run", [](const std::string&, const std::string&) -> Result<std::string> {
    return fail(ErrorCode::NotFound, "cell c", "has no frame of that time");
  });
  EXPECT_EQ(desk.frame("c", "yesterday").error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(answer_of(desk, "c", "").error().message, "has no frame of that time");
}

TEST(ACellFrameDesk, AsksNobodyForACellThatIsNotThere) {
  std::atomic<int> asked = 0;
  CellFrameDesk desk(
      "run",
      [&](const std::string&, const std::string&) {
        ++asked;
        return Result<std::string>("{}");
      },
      [](const std::string& cell) { return cell == "b"; });
  const auto none = desk.frame("c", "");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::NotFound);
  EXPECT_TRUE(answer_of(desk, "b", ""));
  EXPECT_EQ(asked, 1);
}

TEST(ACellFrameDesk, IsNotFilledByAskingForEverything) {
  CellFrameDesk desk("run", [](const std::string&, const std::string&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return Result<std::string>("{}");
  });
  std::size_t refused = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto answer = desk.frame("b", std::to_string(i));
    ASSERT_FALSE(answer);
    refused += answer.error().message.find("too many") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(refused, 800U);
}

}  // namespace
}  // namespace chorus::server
