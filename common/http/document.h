// One version of one resource: its representations, their ETags, and the bytes that are sent.
//
// Immutable once built and shared between threads.  A representation is rendered at most once, when
// the first client asks for it; after that, answers send the same bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/http/file_body.h"
#include "common/http/gzip.h"
#include "common/http/page_lines.h"
#include "common/time/timestamp.h"

namespace chorus::http {

using Header = std::pair<std::string, std::string>;

/// One representation of the resource; the server prefers the variants in the order they have in
/// Document.
struct Variant {
  std::string media_type;               ///< "text/turtle"; may have parameters, which are sent too.
  std::function<std::string()> render;  ///< Pure and thread-safe; not called again once it has
                                        ///< returned.
  std::string profile = {};             ///< Chosen only by ?profile=NAME; empty is the default.
  std::string_view lines = {};          ///< The variant's header lines, each with CR LF; must
                                        ///< outlive the document.
};

struct DocumentOptions {
  std::string version;  ///< Part of the ETag, which is "<version>-<variant>" and strong.
  std::string cache_control = "no-cache";
  std::string content_location = {};  ///< Relative IRI of the immutable version: "frames/42".
  std::vector<Header> headers = {};   ///< Further headers, such as Link.
  /// If set, the document is, or belongs to, such a page.  Without it HTML is Page::Plain.
  std::optional<Page> page = {};
  std::string import_map = {};                ///< Of the page, see page_lines().
  std::shared_ptr<const FileBody> file = {};  ///< The body, instead of what the variant renders.
  /// If set, adds Server-Timing with the age of the capture.
  std::optional<Timestamp> captured = {};
};

/// The bytes of one representation, shared by all its answers.  Before them, the server writes the
/// status line and the header lines of the single answer.
struct Rendered {
  std::string media_type;
  std::string etag;  ///< Quoted.
  /// Header lines of the representation, the blank line, the body.
  std::shared_ptr<const std::string> wire;
  std::size_t head_size = 0;      ///< Where the body begins in `wire`.
  std::string not_modified = {};  ///< Header lines of a 304, with the blank line.

  [[nodiscard]] std::string_view head() const {
    return std::string_view(*wire).substr(0, head_size);
  }
  [[nodiscard]] std::string_view body() const { return std::string_view(*wire).substr(head_size); }
};

class Document {
 public:
  Document(std::vector<Variant> variants, DocumentOptions options);
  ~Document();
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;

  /// Chooses a representation by RFC 9110 12.5.1; without an Accept, the first variant of the
  /// profile. NotAcceptable, with a list of the available types, if none is acceptable; NotFound
  /// for an unknown profile; Internal if the variant cannot be rendered.  Coding::Gzip compresses
  /// where that is worth it, once for all clients.
  [[nodiscard]] Result<const Rendered*> choose(std::string_view accept,
                                               std::string_view profile = {},
                                               Coding coding = Coding::Identity) const;

  /// The representation of a profile in JSON or Turtle as one server-sent event (id = version),
  /// with Coding::Gzip as a gzip_piece; null when the document has no variant of that type or
  /// cannot render it.  Each event is made at most once.
  [[nodiscard]] std::shared_ptr<const std::string> event(std::string_view media_type,
                                                         std::string_view profile = {},
                                                         Coding coding = Coding::Identity) const;

  /// The media types of a profile, best first, without parameters.
  [[nodiscard]] std::vector<std::string_view> media_types(std::string_view profile = {}) const;
  [[nodiscard]] const DocumentOptions& options() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

using DocumentPtr = std::shared_ptr<const Document>;

/// A document with one fixed representation (an image, a static page).
[[nodiscard]] DocumentPtr make_document(std::string media_type, std::string body,
                                        DocumentOptions options);

}  // namespace chorus::http
