// No HTML leaves a service without saying what it may load and that nobody may frame it.
#include "common/http/page_lines.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/http/document.h"
#include "common/http/static_files.h"
#include "tests/support/temporary_folder.h"

namespace chorus::http {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string page_head_of(const Document& document, std::string_view accept) {
  const auto chosen = document.choose(accept);
  return chosen ? std::string((*chosen)->head()) : std::string();
}

std::string page_head_of(std::string type) {
  std::vector<Variant> variants;
  variants.push_back({std::move(type), [] { return std::string("<p>"); }});
  return page_head_of(Document(std::move(variants), {"1"}), "");
}

TEST(PageLines, EveryPageHasThemWhoeverMadeIt) {
  for (const char* type : {"text/html", "text/html; charset=utf-8", "TEXT/HTML", "image/svg+xml",
                           "application/xhtml+xml"}) {
    EXPECT_THAT(page_head_of(type), HasSubstr("frame-ancestors 'none'\r\n")) << type;
    EXPECT_THAT(page_head_of(type), HasSubstr("Content-Security-Policy: default-src 'none'; "))
        << type;
    EXPECT_THAT(page_head_of(type), HasSubstr("X-Frame-Options: DENY\r\n")) << type;
  }
  EXPECT_THAT(page_head_of("application/json"), Not(HasSubstr("Content-Security-Policy")));
  EXPECT_THAT(page_head_of("text/plain"), Not(HasSubstr("Content-Security-Policy")));
}

TEST(PageLines, FilesHaveThoseOfTheirPage) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "index.html") << "<p>";
  std::ofstream(folder / "worker.js") << "1";
  const auto policy = [&](const FilesAre& about, const char* file) {
    StaticFiles files((folder / "").string(), about);
    return page_head_of(**files.document(file), "");
  };
  EXPECT_THAT(policy({{}, Page::Capture}, "index.html"), HasSubstr("'wasm-unsafe-eval'"));
  EXPECT_THAT(policy({{}, Page::Capture}, "worker.js"), HasSubstr("'wasm-unsafe-eval'"))
      << "a worker has the policy of its script";
  EXPECT_THAT(policy({{}, Page::Viewer}, "index.html"), HasSubstr("connect-src 'self'"));
  EXPECT_THAT(policy({}, "index.html"), HasSubstr("frame-ancestors 'none'"));
}

TEST(PageLines, AreInEveryRow) {
  for (const Page page : {Page::Plain, Page::Viewer, Page::Capture}) {
    EXPECT_THAT(page_lines(page), HasSubstr("frame-ancestors 'none'"));
    EXPECT_THAT(page_lines(page), ::testing::EndsWith("\r\n"));
    EXPECT_THAT(page_lines(page), Not(HasSubstr("\n\r\n")));
  }
}

TEST(PageLines, ThePagesOwnImportMapMayRunAndNoOtherScriptInIt) {
  // printf '{}' | openssl dgst -sha256 -binary | base64
  constexpr const char* kHash = "'sha256-RBNvo1WzZ4oRRq0W9+hknpT7T8If536DEMBg9hyq/4o='";
  const testing::TemporaryFolder folder;
  std::ofstream(folder / "index.html")
      << "<html><script type=\"importmap\">{}</script><script>evil()</script>";
  StaticFiles viewer((folder / "").string(), {{}, Page::Viewer});
  EXPECT_THAT(page_head_of(**viewer.document("index.html"), ""),
              HasSubstr("script-src 'self' " + std::string(kHash) + "; connect-src 'self'"));
  EXPECT_THAT(page_lines(Page::Viewer), Not(HasSubstr("sha256")));
  EXPECT_THAT(page_lines(Page::Plain, "{}"), Not(HasSubstr("sha256"))) << "it runs no script";
  EXPECT_EQ(import_map_of("<script type=\"importmap\">{\"a\": 1}</script>"), "{\"a\": 1}");
  EXPECT_EQ(import_map_of("<script type=\"importmap\">{"), "");
}

}  // namespace
}  // namespace chorus::http
