#include "common/http/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

namespace chorus::http {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Document frame(std::atomic<int>* renders = nullptr) {
  const auto written = [renders](std::string text) {
    return [renders, text] {
      if (renders != nullptr) ++*renders;
      return text;
    };
  };
  DocumentOptions options;
  options.version = "42";
  options.content_location = "frames/42";
  return Document({{"text/turtle", written("<frame> a <x> .")},
                   {"application/ld+json", written("{\"@context\":{}}")},
                   {"application/json", written("{\n\"a\": 1\r\n}\n")},
                   {"text/turtle", written("long"), "arvida"}},
                  options);
}

TEST(Document, EachRepresentationHasItsOwnStrongTag) {
  const Document document = frame();
  EXPECT_EQ((*document.choose(""))->etag, "\"42-ttl\"");
  EXPECT_EQ((*document.choose("application/json"))->etag, "\"42-json\"");
  EXPECT_EQ((*document.choose("application/ld+json"))->etag, "\"42-jsonld\"");
  EXPECT_EQ((*document.choose("*/*", "arvida"))->etag, "\"42-arvida-ttl\"");
}

TEST(Document, WireIsHeadersBlankLineBody) {
  const Document document = frame();
  const Rendered& turtle = **document.choose("text/turtle");
  EXPECT_EQ(turtle.body(), "<frame> a <x> .");
  EXPECT_THAT(std::string(turtle.head()), HasSubstr("Content-Type: text/turtle\r\n"));
  EXPECT_THAT(std::string(turtle.head()), HasSubstr("Content-Length: 15\r\n"));
  EXPECT_THAT(std::string(turtle.head()), HasSubstr("Cache-Control: no-cache\r\n"));
  EXPECT_THAT(std::string(turtle.head()), HasSubstr("Content-Location: frames/42\r\n"));
  EXPECT_TRUE(turtle.head().ends_with("\r\n\r\n"));
}

TEST(Document, NotModifiedHasTheValidatorsAndNoBody) {
  const Document document = frame();
  const std::string& lines = (*document.choose(""))->not_modified;
  EXPECT_THAT(lines, HasSubstr("ETag: \"42-ttl\"\r\n"));
  EXPECT_THAT(lines, HasSubstr("Content-Location"));
  EXPECT_THAT(lines, Not(HasSubstr("Content-Length")));
  EXPECT_TRUE(lines.ends_with("\r\n\r\n"));
}

TEST(Document, AVariantHasLinesOfItsOwnBeforeThoseOfAll) {
  DocumentOptions options;
  options.headers = {{"Accept-Post", "text/plain"}};
  const Document document({{"text/turtle", [] { return std::string(); }, "", "Link: <a>\r\n"},
                           {"application/json", [] { return std::string(); }}},
                          options);
  EXPECT_THAT(std::string((*document.choose(""))->head()),
              HasSubstr("Link: <a>\r\nAccept-Post: text/plain\r\n"));
  EXPECT_THAT((*document.choose(""))->not_modified, HasSubstr("Link: <a>\r\n"));
  EXPECT_THAT(std::string((*document.choose("application/json"))->head()), Not(HasSubstr("Link")));
}

TEST(Document, ErrorsNameWhatThereIs) {
  const Document document = frame();
  const auto image = document.choose("image/png");
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, ErrorCode::NotAcceptable);
  EXPECT_THAT(image.error().message, HasSubstr("text/turtle, application/ld+json"));
  const auto profile = document.choose("", "nirvana");
  ASSERT_FALSE(profile);
  EXPECT_EQ(profile.error().code, ErrorCode::NotFound);
}

TEST(Document, RendersOnceForAllThreads) {
  std::atomic<int> renders = 0;
  const Document document = frame(&renders);
  std::vector<std::thread> readers;
  for (int i = 0; i < 4; ++i)
    readers.emplace_back([&] { EXPECT_TRUE(document.choose("").has_value()); });
  for (auto& reader : readers) reader.join();
  EXPECT_EQ(renders, 1);
}

TEST(Document, ThrowingWriterIsAnInternalErrorAndMayRecover) {
  auto broken = std::make_shared<bool>(true);
  const Document document({{"text/plain",
                            [broken]() -> std::string {
                              if (*broken) throw std::runtime_error("no disk");
                              return "well";
                            }}},
                          {});
  const auto failed = document.choose("");
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, ErrorCode::Internal);
  *broken = false;
  EXPECT_EQ((*document.choose(""))->body(), "well");
}

TEST(Document, EventIsJsonInOneLine) {
  EXPECT_EQ(*frame().event("application/json"), "id: 42\ndata: { \"a\": 1  } \n\n");
  EXPECT_EQ(make_document("text/plain", "x", {})->event("application/json"), nullptr);
  EXPECT_EQ(make_document("text/plain", "x", {})->event("text/plain"), nullptr);
}

TEST(Document, EventInTurtleKeepsItsLines) {
  DocumentOptions options;
  options.version = "7";
  const auto turtle = make_document("text/turtle", "<a>\r\n  <b> 1 .\n", options);
  EXPECT_EQ(*turtle->event("text/turtle"), "id: 7\ndata: <a>\ndata:   <b> 1 .\ndata: \n\n");
  EXPECT_EQ(turtle->event("application/json"), nullptr);
}

TEST(Document, TagNeverHoldsQuotesOrSpaces) {
  DocumentOptions options;
  options.version = "a \"b\"\n";
  EXPECT_EQ((*make_document("image/png", "", options)->choose(""))->etag, "\"a__b__-v0\"");
}

TEST(Document, ALineBreakInAValueBeginsNoOtherHeader) {
  DocumentOptions options;
  options.content_location = "frames/1\r\nSet-Cookie: a";
  const auto document = make_document("image/png", "", options);
  EXPECT_THAT(std::string((*document->choose(""))->head()),
              HasSubstr("Content-Location: frames/1  Set-Cookie: a\r\n"));
}

TEST(Document, WithoutVariantsNothingIsAcceptable) {
  const Document empty({}, {});
  EXPECT_EQ(empty.choose("").error().code, ErrorCode::NotFound);
}

}  // namespace
}  // namespace chorus::http
