// A service as a thing of the Web of Things: a W3C Thing Description 1.1
// (https://www.w3.org/TR/wot-thing-description11/).
#pragma once

#include <string>

#include "common/http/router.h"
#include "common/service/self_description.h"

namespace chorus::service {

/// What depends on the reader and the configuration.
struct ThingFacts {
  std::string base;             ///< Absolute IRI of `/`; empty: not known.
  bool guards_reading = false;  ///< Whether reading needs a token, at least from other hosts.
  bool guards_writing = false;  ///< The same of writing.

  bool operator==(const ThingFacts&) const = default;
};

/// JSON.  Names, sentences, media types and inputs are those of proto/openapi.json.  Only what the
/// router answers is in it and, of the paths without parameters, only what `self` lists: resources
/// as properties, writing methods as actions, live resources as events too.
[[nodiscard]] std::string thing_description(const Self& self, const http::Router& router,
                                            const ThingFacts& facts);

}  // namespace chorus::service
