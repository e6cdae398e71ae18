// The site over HTTP, the same on every cell: /site/frame has everybody in the site's space under
// the numbers of the site, /site/people/ who they are and which cell answers for them, /site/cells/
// which cells there are.
#pragma once

#include <memory>
#include <mutex>
#include <string_view>

#include "common/http/router.h"
#include "common/resource/node.h"
#include "common/service/serving.h"
#include "fusion-server/site/site_view.h"

namespace chorus::rest {

/// `number`: the id in /site/frame.  `id` is the node's IRI within the document.
[[nodiscard]] resource::Node site_person_node(const site::SitePerson& person, std::uint64_t number,
                                              std::string id);
[[nodiscard]] resource::Node site_people_node(const site::SiteView& view);
[[nodiscard]] resource::Node site_cells_node(const site::SiteView& view);

/// Thread-safe.
class SiteResources {
 public:
  explicit SiteResources(service::Serving serving);

  /// Documents are rendered when somebody asks for them.
  void show(std::shared_ptr<const site::SiteView> view);
  void add_routes(http::Router& router);
  /// Whether /site/cells/ lists this cell; true before anything was shown.
  [[nodiscard]] bool lists(std::string_view cell) const;

 private:
  service::Serving serving_;
  std::shared_ptr<http::LiveDocument> frame_;
  std::shared_ptr<http::LiveDocument> people_;
  std::shared_ptr<http::LiveDocument> cells_;
  mutable std::mutex mutex_;
  std::shared_ptr<const site::SiteView> shown_;  ///< Guarded by mutex_.
};

}  // namespace chorus::rest
