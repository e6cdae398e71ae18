// Serves the files of a folder as resources: nothing outside the folder and nothing larger than a
// limit.  The extension of a file decides its media type.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/http/document.h"

namespace chorus::http {

/// Media type by file extension; application/octet-stream when unknown.
[[nodiscard]] std::string_view media_type_of_file(std::string_view name);

/// What the files of a folder have in common.
struct FilesAre {
  std::string_view lines = {};    ///< Header lines of all answers, each with CR LF; must outlive
                                  ///< the documents.
  std::optional<Page> page = {};  ///< Set: they belong to such a page, scripts included.
  std::size_t max_bytes = 16u << 20;
};

/// Reads files on request and keeps each document until the file's mtime or size changes.
/// Thread-safe.
class StaticFiles {
 public:
  explicit StaticFiles(std::string folder, const FilesAre& about = {});
  ~StaticFiles();

  /// `path` is decoded and relative; "" and "sub/" stand for the index.html there.  NotFound unless
  /// the path, with symbolic links resolved, is a regular file inside the folder; Forbidden above
  /// the size limit.
  [[nodiscard]] Result<DocumentPtr> document(std::string_view path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::http
