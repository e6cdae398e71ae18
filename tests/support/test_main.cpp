// The main function of unit tests.  `--in=FILE,FILE` runs only the tests that are written in these
// source files, and fails if a file has none: so ctest runs a program of many files file by file.
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>

namespace {

constexpr std::string_view kIn = "--in=";

std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto end = text.find(',');
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

/// A filter for the tests in `file`; empty if it has none.
std::string filter_of(std::string_view file) {
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  std::string filter;
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const testing::TestInfo& test = *suite.GetTestInfo(t);
      if (file == test.file()) filter += std::string(suite.name()) + "." + test.name() + ":";
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (!argument.starts_with(kIn)) continue;
    std::string filter;
    for (const std::string_view file : split(argument.substr(kIn.size()))) {
      const std::string tests = filter_of(file);
      if (tests.empty()) {
        std::fprintf(stderr, "%s: no test in %.*s\n", argv[0], static_cast<int>(file.size()),
                     file.data());
        return 1;
      }
      filter += tests;
    }
    // A death test runs this program again with the same --in and a filter of its own.
    if (GTEST_FLAG_GET(filter) == "*") GTEST_FLAG_SET(filter, filter);
  }
  return RUN_ALL_TESTS();
}
