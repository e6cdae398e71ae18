// A folder of files as resources: nothing outside it, types by extension, limited size.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/http/document.h"

namespace chorus::http {

/// Media type by file extension; application/octet-stream when unknown.
[[nodiscard]] std::string_view media_type_of_file(std::string_view name);

/// Reads files on request and keeps the documents until mtime or size change.  Thread-safe.
class StaticFiles {
 public:
  /// `lines`: header lines for the answer of every file, each with CR LF; constant.
  explicit StaticFiles(std::string folder, std::string_view lines = {},
                       std::size_t max_file_bytes = 16u << 20);
  ~StaticFiles();

  /// `path` is decoded and relative; "" and "sub/" mean index.html.  NotFound unless it is a
  /// regular file inside the folder, symbolic links resolved; Forbidden above the size limit.
  [[nodiscard]] Result<DocumentPtr> document(std::string_view path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::http
