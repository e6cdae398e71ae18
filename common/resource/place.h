// Where a document stands, so that the names in it lead to the right resources.
#pragma once

#include <algorithm>
#include <string>

namespace chorus::resource {

/// Bodies hold IRIs relative to the document's own path, so the same bytes are right behind any
/// host name and proxy prefix.
struct Place {
  std::string path = {};  ///< From the service's root: "frame", "frames/42", "sensors/"; "" is `/`.
  /// Frames: what precedes "frame" and "skeletons/7", such as "sensors/s1/".
  std::string names = {};
  std::string root = "http://localhost/";  ///< Absolute IRI of `/`; only N-Triples needs it.

  /// "" at the top, "../" one folder down: leads from the document to the root.
  [[nodiscard]] std::string up() const {
    std::string steps;
    for (auto n = std::count(path.begin(), path.end(), '/'); n > 0; --n) steps += "../";
    return steps;
  }
};

}  // namespace chorus::resource
