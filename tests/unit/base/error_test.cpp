#include "common/base/error.h"

#include <array>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace chorus {
namespace {

constexpr std::array kAll{ErrorCode::InvalidArgument,
                          ErrorCode::Malformed,
                          ErrorCode::TooLarge,
                          ErrorCode::NotFound,
                          ErrorCode::Gone,
                          ErrorCode::NotAcceptable,
                          ErrorCode::Unsupported,
                          ErrorCode::Unauthorized,
                          ErrorCode::Forbidden,
                          ErrorCode::Conflict,
                          ErrorCode::Unavailable,
                          ErrorCode::Timeout,
                          ErrorCode::Io,
                          ErrorCode::Internal};

TEST(ErrorCodes, EachHasItsOwnName) {
  std::set<std::string_view> names;
  for (const ErrorCode code : kAll) names.insert(name_of(code));
  EXPECT_EQ(names.size(), kAll.size());
}

TEST(ErrorCodes, EachHasAnErrorStatusAndOnlyOurFaultsAre500) {
  for (const ErrorCode code : kAll) {
    EXPECT_GE(http_status(code), 400) << name_of(code);
    EXPECT_LT(http_status(code), 600) << name_of(code);
    const bool ours = code == ErrorCode::Io || code == ErrorCode::Internal;
    EXPECT_EQ(http_status(code) == 500, ours) << name_of(code);
  }
  EXPECT_EQ(http_status(ErrorCode::NotFound), 404);
  EXPECT_EQ(http_status(ErrorCode::TooLarge), 413);
}

TEST(ErrorCodes, AnUnknownCodeIsOurOwnFault) {
  EXPECT_EQ(name_of(static_cast<ErrorCode>(99)), "internal");
  EXPECT_EQ(http_status(static_cast<ErrorCode>(99)), 500);
}

TEST(ErrorText, LeavesOutAnEmptyContext) {
  EXPECT_EQ(to_string({ErrorCode::NotFound, "/frames/7", "no such frame"}),
            "/frames/7: no such frame");
  EXPECT_EQ(to_string({ErrorCode::NotFound, "", "no such frame"}), "no such frame");
}

}  // namespace
}  // namespace chorus
