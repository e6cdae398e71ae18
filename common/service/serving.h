// How this run of a service identifies itself in its documents.
#pragma once

#include <string>
#include <utility>

#include "common/resource/place.h"

namespace chorus::service {

struct Serving {
  /// Part of the ETags, so that an ETag from an earlier run does not match a document of this run.
  std::string run;
  std::string root = "http://localhost/";  ///< Absolute IRI of `/`, for N-Triples.

  /// A document's place.  `path`: "sensors/s1/frame"; `names`: what comes before the names in the
  /// document, "sensors/s1/".
  [[nodiscard]] resource::Place place(std::string path, std::string names = {}) const {
    return {std::move(path), std::move(names), root};
  }
};

}  // namespace chorus::service
