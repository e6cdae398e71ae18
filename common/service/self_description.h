// `/`: what a service is, with links to everything it has, for people and for machines, from one
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
  std::string key;   ///< The property that names its role; empty: only listed.
  std::string what;  ///< For people, half a sentence.
};

struct Self {
  std::string title;
  std::string description;  ///< One sentence.
  std::string type;         ///< "Sensor", beside what every service is.
  std::vector<std::pair<std::string, resource::Value>> facts;  ///< Particular to this service.
  /// What it has beside /clock, /healthz and so on, which every service has.
  std::vector<Listed> resources;
};

/// A DCAT data service and an LDP container, from which links lead to every body's joints:
/// / -> skeletons/ -> skeletons/1 -> #Head.
[[nodiscard]] resource::Node self_node(const Self& self);

/// A page for browsers; every text is escaped.
[[nodiscard]] std::string self_page(const Self& self);

/// `version`: changes with `self`, within one run.
[[nodiscard]] http::DocumentPtr self_document(const Self& self, const Serving& serving,
                                              const std::string& version);

}  // namespace chorus::service
