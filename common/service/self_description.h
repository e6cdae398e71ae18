// `/`: what a service is, with links to all of its resources, for people and for machines, from one
// table per service.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/http/router.h"
#include "common/resource/node.h"
#include "common/service/serving.h"

namespace chorus::service {

/// One resource of a service.
struct Listed {
  std::string path;
  std::string key;   ///< The property that links to it; empty: it is only listed.
  std::string what;  ///< For people, half a sentence.
};

struct Self {
  std::string title;
  std::string description;  ///< One sentence.
  std::string type;         ///< "Sensor"; in addition to the types of every service.
  std::vector<std::pair<std::string, resource::Value>> facts;  ///< Specific to this service.
  /// Its resources in addition to /clock, /healthz and the others that every service has.
  std::vector<Listed> resources;
};

/// A DCAT data service and LDP container whose links lead to every joint of every body:
/// / -> skeletons/ -> skeletons/1 -> #Head.
[[nodiscard]] resource::Node self_node(const Self& self);

/// A page for browsers; every text is escaped.
[[nodiscard]] std::string self_page(const Self& self);

/// `version` changes whenever `self` changes within one run.
[[nodiscard]] http::DocumentPtr self_document(const Self& self, const Serving& serving,
                                              const std::string& version);

}  // namespace chorus::service
