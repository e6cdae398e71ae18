// The header lines of every HTML page, in one table: what a page may load, and that no other page
// may show it in a frame, where a hidden click could move the origin or begin a recording.
#pragma once

#include <string>
#include <string_view>

namespace chorus::http {

enum class Page {
  Plain,    ///< Text, tables and links: no script, nothing to load.
  Viewer,   ///< Own scripts and styles, an import map, pictures, and questions to this service.
  Capture,  ///< The same without the import map, and a camera and WebAssembly.
};

/// The header lines of a page, each with its line end.  `import_map`: the text between the tags of
/// the page's import map, which is the only script within the page that may run; empty: there is
/// none.
[[nodiscard]] std::string page_lines(Page page, std::string_view import_map = {});

/// The text of the import map of one of our own pages; empty if it has none.
[[nodiscard]] std::string_view import_map_of(std::string_view html);

/// Whether a page of this media type needs such lines: browsers run its scripts or show it in
/// frames.
[[nodiscard]] bool is_page(std::string_view media_type);

}  // namespace chorus::http
