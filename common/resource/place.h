// Where a document is located, so that the relative IRIs in it lead to the right resources.
#pragma once

#include <algorithm>
#include <string>

namespace chorus::resource {

/// The path of a document.  Documents contain IRIs relative to their own path, so the same bytes
/// are correct under any host name and proxy prefix.
struct Place {
  std::string path = {};  ///< Relative to the service's root: "frame", "frames/42"; "" is `/`.
  /// For frames: what comes before "frame" and "skeletons/7", such as "sensors/s1/".
  std::string names = {};
  std::string root = "http://localhost/";  ///< Absolute IRI of `/`; needed only by N-Triples.

  /// Leads from the document to the root: "" for a document in the root, "../" one folder down.
  [[nodiscard]] std::string up() const {
    std::string steps;
    for (auto n = std::count(path.begin(), path.end(), '/'); n > 0; --n) steps += "../";
    return steps;
  }
};

}  // namespace chorus::resource
