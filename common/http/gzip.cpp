#include "common/http/gzip.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

#include "common/http/text.h"

namespace chorus::http {
namespace {

constexpr std::size_t kMin = 512;       // Below this size, headers are most of the answer.
constexpr std::size_t kMax = 1u << 20;  // Compressing this much takes about 12 ms.
constexpr int kGzipFormat = 16 + MAX_WBITS;
constexpr int kRawFormat = -MAX_WBITS;

/// zlib's state needs 256 KiB, so each thread keeps one Deflater per format.
class Deflater {
 public:
  explicit Deflater(int format) {
    if (deflateInit2(&stream_, Z_BEST_SPEED, Z_DEFLATED, format, MAX_MEM_LEVEL - 1,
                     Z_DEFAULT_STRATEGY) != Z_OK)
      throw std::bad_alloc();
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  std::string run(std::string_view bytes, int flush) {
    constexpr std::size_t kFlushMarks = 16;
    deflateReset(&stream_);
    std::string out(deflateBound(&stream_, bytes.size()) + kFlushMarks, '\0');
    // zlib does not write to its input; its interface merely lacks the const.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream_.avail_in = static_cast<uInt>(bytes.size());
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = static_cast<uInt>(out.size());
    deflate(&stream_, flush);
    out.erase(out.size() - stream_.avail_out);
    return out;
  }

 private:
  z_stream stream_{};
};

bool refused(std::string_view parameters) {
  while (!parameters.empty()) {
    std::string_view parameter = next_element(parameters, ';');
    const std::string_view name = next_element(parameter, '=');
    if (!equal_ignoring_case(name, "q")) continue;
    return parameter.find_first_not_of("0.") == std::string_view::npos;
  }
  return false;
}

}  // namespace

Coding coding_for(std::string_view accept_encoding) {
  Coding found = Coding::Identity;
  while (!accept_encoding.empty()) {
    std::string_view parameters = next_element(accept_encoding, ',');
    const std::string_view name = next_element(parameters, ';');
    const bool named = equal_ignoring_case(name, "gzip") || equal_ignoring_case(name, "x-gzip");
    if (!named && name != "*") continue;
    const Coding said = refused(parameters) ? Coding::Identity : Coding::Gzip;
    if (named) return said;
    found = said;
  }
  return found;
}

bool worth_compressing(std::string_view media_type, std::size_t size) {
  if (size < kMin || size > kMax) return false;
  constexpr std::array kParts{"text/", "json", "javascript", "n-triples", "xml", "wasm"};
  return std::any_of(kParts.begin(), kParts.end(), [&](std::string_view part) {
    return media_type.find(part) != std::string_view::npos;
  });
}

std::string gzipped(std::string_view bytes) {
  thread_local Deflater deflater(kGzipFormat);
  return deflater.run(bytes, Z_FINISH);
}

std::string_view gzip_begin() {
  static constexpr std::string_view kBegin("\x1f\x8b\x08\0\0\0\0\0\0\x03", 10);
  return kBegin;
}

std::string gzip_piece(std::string_view bytes) {
  thread_local Deflater deflater(kRawFormat);
  return deflater.run(bytes, Z_FULL_FLUSH);
}

}  // namespace chorus::http
