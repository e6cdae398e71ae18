// `/`: what a service is, with links to all of its resources, readable for humans and machines.
// Made from one table per service.
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
  std::string key;   ///< The property that links to the resource; empty: it is only listed.
  std::string what;  ///< Human-readable, half a sentence.

  bool operator==(const Listed&) const = default;
};

struct Self {
  std::string title;
  std::string description;  ///< One sentence.
  std::string type;  ///< A class such as "Sensor", in addition to the classes of every service.
  std::vector<std::pair<std::string, resource::Value>> facts;  ///< Specific to this service.
  /// The service's resources besides those that every service has (/clock, /healthz, ...).
  std::vector<Listed> resources;
};

/// All resources of the service: its own, and those that every service has.
[[nodiscard]] std::vector<Listed> all_resources(const Self& self);

/// A DCAT data service and LDP container whose links lead to every joint of every body:
/// / -> skeletons/ -> skeletons/1 -> #Head.
[[nodiscard]] resource::Node self_node(const Self& self);

/// A page for browsers; every string in it is escaped.
[[nodiscard]] std::string self_page(const Self& self);

/// The document for `/`.  `version` must change whenever `self` changes within one run.
[[nodiscard]] http::DocumentPtr self_document(const Self& self, const Serving& serving,
                                              const std::string& version);

}  // namespace chorus::service
