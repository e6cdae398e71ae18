// Uses libjpeg and zlib instead of an image library, so that a sensor host without a camera needs
// no code that reads picture formats.
#include "common/synthetic/picture.h"

#include <zlib.h>

#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

namespace chorus::synthetic {
namespace {

constexpr int kJpegQuality = 85;
constexpr int kPngEffort = 1;  // The lowest of nine, because a picture is usually viewed only once.

/// Lets give_up(), which libjpeg calls on an error, return to compress_jpeg().
struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
};

void give_up(j_common_ptr codec) {
  std::longjmp(reinterpret_cast<JpegErrors*>(codec->err)->back, 1);
}

struct JpegBuffer {
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
};

/// False when libjpeg failed.  No object here has a destructor, because longjmp would skip it.
bool compress_jpeg(const std::uint8_t* pixels, PictureSize size, JpegBuffer& out) {
  jpeg_compress_struct codec;
  JpegErrors errors;
  codec.err = jpeg_std_error(&errors.base);
  errors.base.error_exit = give_up;
  if (setjmp(errors.back) != 0) {
    jpeg_destroy_compress(&codec);
    return false;
  }
  jpeg_create_compress(&codec);
  jpeg_mem_dest(&codec, &out.bytes, &out.size);
  codec.image_width = static_cast<JDIMENSION>(size.width);
  codec.image_height = static_cast<JDIMENSION>(size.height);
  codec.input_components = 3;
  codec.in_color_space = JCS_RGB;
  jpeg_set_defaults(&codec);
  jpeg_set_quality(&codec, kJpegQuality, TRUE);
  jpeg_start_compress(&codec, TRUE);
  while (codec.next_scanline < codec.image_height) {
    const std::size_t row = std::size_t{codec.next_scanline} * codec.image_width * 3;
    JSAMPROW line = const_cast<JSAMPROW>(pixels + row);  // libjpeg only reads it.
    jpeg_write_scanlines(&codec, &line, 1);
  }
  jpeg_finish_compress(&codec);
  jpeg_destroy_compress(&codec);
  return true;
}

Result<void> check(std::size_t values, std::size_t per_pixel, PictureSize size) {
  if (size.width > 0 && size.height > 0 &&
      values == static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) *
                    per_pixel) {
    return {};
  }
  return fail(ErrorCode::InvalidArgument, "picture", "the pixels do not fill the picture");
}

void append_number(std::string& out, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(number >> shift & 0xFF);
}

/// A chunk is length, type, content, and a checksum of type and content (PNG specification 5.3).
void append_chunk(std::string& out, const char* type, const std::string& content) {
  append_number(out, static_cast<std::uint32_t>(content.size()));
  const std::string checked = type + content;
  out += checked;
  append_number(out, static_cast<std::uint32_t>(
                         crc32(0, reinterpret_cast<const unsigned char*>(checked.data()),
                               static_cast<unsigned>(checked.size()))));
}

/// Each row as its differences, byte by byte, from the row above (filter type 2), high byte first.
std::string filtered(std::span<const std::uint16_t> pixels, PictureSize size) {
  const auto width = static_cast<std::size_t>(size.width);
  std::string out;
  out.reserve(pixels.size() * 2 + static_cast<std::size_t>(size.height));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i % width == 0) out += '\x02';
    const int above = i < width ? 0 : pixels[i - width];
    out += static_cast<char>((pixels[i] >> 8) - (above >> 8));
    out += static_cast<char>((pixels[i] & 0xFF) - (above & 0xFF));
  }
  return out;
}

}  // namespace

Result<std::string> jpeg_of(std::span<const std::uint8_t> pixels, PictureSize size) {
  if (auto ok = check(pixels.size(), 3, size); !ok) return pass(ok);
  JpegBuffer buffer;
  const bool done = compress_jpeg(pixels.data(), size, buffer);
  std::string bytes(reinterpret_cast<const char*>(buffer.bytes), done ? buffer.size : 0);
  std::free(buffer.bytes);
  if (!done) return fail(ErrorCode::Internal, "picture", "the JPEG could not be encoded");
  return bytes;
}

Result<std::string> png_of(std::span<const std::uint16_t> pixels, PictureSize size) {
  if (auto ok = check(pixels.size(), 1, size); !ok) return pass(ok);
  const std::string raw = filtered(pixels, size);
  uLongf packed_size = compressBound(static_cast<uLong>(raw.size()));
  std::string packed(packed_size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size,
                reinterpret_cast<const Bytef*>(raw.data()), static_cast<uLong>(raw.size()),
                kPngEffort) != Z_OK) {
    return fail(ErrorCode::Internal, "picture", "the PNG could not be compressed");
  }
  packed.resize(packed_size);
  std::string header;
  append_number(header, static_cast<std::uint32_t>(size.width));
  append_number(header, static_cast<std::uint32_t>(size.height));
  // 16 bits, grey, the only methods of compression and filtering that PNG defines, not interlaced.
  header += std::string("\x10\x00\x00\x00\x00", 5);
  std::string out = "\x89PNG\r\n\x1a\n";
  append_chunk(out, "IHDR", header);
  append_chunk(out, "IDAT", packed);
  append_chunk(out, "IEND", {});
  return out;
}

}  // namespace chorus::synthetic
