#include "common/http/static_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.h"

namespace chorus::http {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, std::string_view text) { std::ofstream(file) << text; }

class StaticFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = base_ / "public";
    fs::create_directories(folder_ / "sub");
    write(folder_ / "index.html", "<p>hello");
    write(folder_ / "sub" / "app.js", "let a;");
    write(base_ / "secret.txt", "secret");
  }

  std::string body(std::string_view path) {
    const auto document = files_().document(path);
    return document ? std::string((*(*document)->choose(""))->body()) : to_string(document.error());
  }
  ErrorCode refusal(std::string_view path) {
    const auto document = files_().document(path);
    EXPECT_FALSE(document) << path;
    return document ? ErrorCode::Internal : document.error().code;
  }
  StaticFiles files_() { return StaticFiles(folder_.string(), {{}, {}, 64}); }

  const chorus::testing::TemporaryFolder base_;
  fs::path folder_;
};

TEST_F(StaticFilesTest, ServesFilesAndTheIndex) {
  EXPECT_EQ(body("index.html"), "<p>hello");
  EXPECT_EQ(body(""), "<p>hello");
  EXPECT_EQ(body("sub/app.js"), "let a;");
  EXPECT_EQ(refusal("sub/"), ErrorCode::NotFound);
  EXPECT_EQ(refusal("sub"), ErrorCode::NotFound);
}

TEST_F(StaticFilesTest, NeverLeavesTheFolder) {
  fs::create_symlink(base_ / "secret.txt", folder_ / "link.txt");
  fs::create_directory_symlink(base_.path(), folder_ / "up");
  fs::create_symlink(folder_ / "index.html", folder_ / "inside.html");
  for (const auto path : {"../secret.txt", "link.txt", "up/secret.txt", "/etc/passwd", "..", "."})
    EXPECT_EQ(refusal(path), ErrorCode::NotFound) << path;
  EXPECT_EQ(refusal((base_ / "secret.txt").string()), ErrorCode::NotFound);
  EXPECT_EQ(body("inside.html"), "<p>hello");
}

TEST_F(StaticFilesTest, OnlyRegularFilesBelowTheLimit) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(refusal("pipe"), ErrorCode::NotFound);
  write(folder_ / "big.bin", std::string(65, 'x'));
  EXPECT_EQ(refusal("big.bin"), ErrorCode::Forbidden);
  write(folder_ / "fits.bin", std::string(64, 'x'));
  EXPECT_EQ(body("fits.bin").size(), 64u);
}

TEST_F(StaticFilesTest, AChangedFileIsANewVersion) {
  auto files = files_();
  const auto before = *files.document("index.html");
  EXPECT_EQ(*files.document("index.html"), before);
  write(folder_ / "index.html", "<p>changed");
  const auto after = *files.document("index.html");
  EXPECT_NE((*before->choose(""))->etag, (*after->choose(""))->etag);
  EXPECT_EQ((*after->choose(""))->body(), "<p>changed");
}

TEST_F(StaticFilesTest, AMissingFolderIsNotFound) {
  EXPECT_EQ(StaticFiles("/nonexistent/folder").document("a").error().code, ErrorCode::NotFound);
}

TEST(MediaTypeOfFile, ByExtension) {
  EXPECT_EQ(media_type_of_file("a.min.js"), "text/javascript");
  EXPECT_EQ(media_type_of_file("three.module.mjs"), "text/javascript");
  EXPECT_EQ(media_type_of_file("README"), "application/octet-stream");
  EXPECT_EQ(media_type_of_file(""), "application/octet-stream");
}

}  // namespace
}  // namespace chorus::http
