#include "common/http/gzip.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace chorus::http {
namespace {

/// What a gzip reader decodes from these bytes.
std::string unpacked(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 16 + MAX_WBITS), Z_OK);
  std::string out(1u << 20, '\0');
  std::string in = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int result = inflate(&stream, Z_SYNC_FLUSH);
  EXPECT_TRUE(result == Z_OK || result == Z_STREAM_END) << result;
  inflateEnd(&stream);
  return out.substr(0, stream.total_out);
}

std::string repetitive_text() {
  std::string text;
  for (int i = 0; i < 200; ++i) text += "\"Head\": {\"x\": " + std::to_string(i * 37 % 101) + "}, ";
  return text;
}

TEST(Gzip, IsReadBackAndSmaller) {
  for (const std::string& text : {repetitive_text(), std::string(), std::string("x")}) {
    EXPECT_EQ(unpacked(gzipped(text)), text);
    EXPECT_EQ(unpacked(gzipped(text)), text) << "the state is used again";
  }
  EXPECT_LT(gzipped(repetitive_text()).size() * 4, repetitive_text().size());
}

TEST(Gzip, PiecesFollowEachOtherInAnyOrder) {
  const std::string a = gzip_piece(repetitive_text());
  const std::string b = gzip_piece("b\n");
  const std::string begin(gzip_begin());
  EXPECT_EQ(unpacked(begin + a + b + a), repetitive_text() + "b\n" + repetitive_text());
  EXPECT_EQ(unpacked(begin + b + b), "b\nb\n");
  EXPECT_EQ(unpacked(begin + a), repetitive_text()) << "whole as soon as it has come";
}

TEST(CodingFor, TakesGzipWhereItIsAccepted) {
  for (const auto yes : {"gzip", "GZIP", "deflate, gzip;q=0.5", "x-gzip", "*", "br, *;q=0.1",
                         "identity;q=0, gzip; q=1.0"}) {
    EXPECT_EQ(coding_for(yes), Coding::Gzip) << yes;
  }
  for (const auto no : {"", "identity", "br", "gzip;q=0", "gzip;q=0.000", "*;q=0", "gzip;q=0, *"}) {
    EXPECT_EQ(coding_for(no), Coding::Identity) << no;
  }
}

TEST(WorthCompressing, TextOfSomeSize) {
  EXPECT_TRUE(worth_compressing("application/ld+json", 5000));
  EXPECT_TRUE(worth_compressing("text/turtle", 5000));
  EXPECT_FALSE(worth_compressing("text/turtle", 100));
  EXPECT_FALSE(worth_compressing("text/turtle", 100u << 20));
  EXPECT_FALSE(worth_compressing("image/png", 5000));
  EXPECT_FALSE(worth_compressing("application/octet-stream", 5000));
}

}  // namespace
}  // namespace chorus::http
