// Bodies that are files: sent piece by piece, never longer or shorter than announced.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>
#include <vector>

#include "common/http/client.h"
#include "common/http/server.h"
#include "tests/integration/http/raw_client.h"
#include "tests/support/temporary_folder.h"

namespace chorus::http {
namespace {

using ::testing::HasSubstr;

/// A service with one route, /file, which serves the file that is at `path` when it is asked for.
class Download : public ::testing::Test {
 protected:
  void SetUp() override {
    auto router = std::make_shared<Router>();
    router->get("/file", [this](const Request&, const PathParams&) -> Result<DocumentPtr> {
      auto body = FileBody::open(path_);
      if (!body) return pass(body);
      DocumentOptions options;
      options.version = std::to_string((*body)->size());
      options.file = std::move(*body);
      return make_document("application/octet-stream", {}, std::move(options));
    });
    server_ = std::make_unique<Server>(ServerConfig{}, router);
    ASSERT_TRUE(server_->start());
  }

  void write(std::size_t size) {
    content_.resize(size);
    for (std::size_t i = 0; i < size; ++i) content_[i] = static_cast<char>(i * 7 + i / 251);
    std::ofstream(path_, std::ios::binary) << content_;
  }

  [[nodiscard]] Result<ClientResponse> ask(const std::string& method = "GET",
                                           std::vector<Header> headers = {}) const {
    return fetch({"127.0.0.1", server_->port(), "/file"},
                 {method, "/file", std::move(headers), {}});
  }

  chorus::testing::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.mcap";
  std::string content_;
  std::unique_ptr<Server> server_;
};

TEST_F(Download, OnlySoManyAtOnce) {
  write(64u << 20);
  const std::size_t most = ServerLimits{}.max_downloads;
  std::vector<std::unique_ptr<test::RawClient>> readers;
  for (std::size_t i = 0; i < most; ++i) {
    readers.push_back(std::make_unique<test::RawClient>(server_->port(), 4096));
    readers.back()->say("GET /file HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(test::status_in(readers.back()->hear_until("\r\n\r\n")), 200);
  }
  EXPECT_EQ(server_->counters().downloads_open, most);
  const auto refused = ask();
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_EQ(refused->headers.at("retry-after"), "1");
  readers.clear();
  for (int i = 0; i < 300 && server_->counters().downloads_open > 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(server_->counters().downloads_open, 0u);
}

TEST_F(Download, ArrivesByteForByteWhateverItsSize) {
  for (const std::size_t size :
       {0u, 1u, (256u << 10) - 1, 256u << 10, (256u << 10) + 1, 3'000'000u}) {
    write(size);
    const auto answer = ask();
    ASSERT_TRUE(answer) << to_string(answer.error());
    EXPECT_EQ(answer->status, 200);
    EXPECT_EQ(answer->headers.at("content-length"), std::to_string(size));
    EXPECT_TRUE(answer->body == content_) << size;
  }
}

TEST_F(Download, HeadAndNotModifiedSendNoBody) {
  write(300'000);
  const auto head = ask("HEAD");
  ASSERT_TRUE(head);
  EXPECT_EQ(head->headers.at("content-length"), "300000");
  EXPECT_EQ(head->body, "");
  const auto again = ask("GET", {{"If-None-Match", head->headers.at("etag")}});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  EXPECT_EQ(again->body, "");
}

TEST_F(Download, OfWhatIsNoFileIsNotFound) {
  EXPECT_EQ(ask()->status, 404);
  path_ = folder_ / "";
  EXPECT_EQ(ask()->status, 404) << "a folder";
  path_ = folder_ / "link";
  std::filesystem::create_symlink("/etc/hostname", path_);
  EXPECT_EQ(ask()->status, 404) << "a link may lead anywhere";
}

TEST(FileBody, ThatShrinksMeanwhileSaysSo) {
  const chorus::testing::TemporaryFolder folder;
  std::ofstream(folder / "a") << std::string(1000, 'x');
  const auto body = FileBody::open(folder / "a");
  ASSERT_TRUE(body);
  std::string piece;
  EXPECT_TRUE((*body)->read(0, piece));
  EXPECT_EQ(piece.size(), 1000u);
  std::filesystem::resize_file(folder / "a", 10);
  EXPECT_FALSE((*body)->read(0, piece)) << "its length has been announced";
}

}  // namespace
}  // namespace chorus::http
