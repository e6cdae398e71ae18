// Compression for clients that ask for it (RFC 9110 12.5.3, RFC 1952).
#pragma once

#include <string>
#include <string_view>

namespace chorus::http {

enum class Coding { Identity, Gzip };

/// Gzip if an Accept-Encoding field allows it, by name or by "*", unless with q=0; otherwise
/// Identity.
[[nodiscard]] Coding coding_for(std::string_view accept_encoding);

/// True for text that is large enough to gain from compression and small enough not to delay other
/// clients.
[[nodiscard]] bool worth_compressing(std::string_view media_type, std::size_t size);

/// All of `bytes` as one gzip file; prefers speed to size.
[[nodiscard]] std::string gzipped(std::string_view bytes);

/// The bytes that a gzip file begins with, for streams.
[[nodiscard]] std::string_view gzip_begin();
/// A piece of a gzip stream, to be sent after gzip_begin().  Pieces may follow in any order,
/// because none refers to another, so one piece can be shared by all streams.  A reader can decode
/// each piece as soon as it arrives.
[[nodiscard]] std::string gzip_piece(std::string_view bytes);

}  // namespace chorus::http
