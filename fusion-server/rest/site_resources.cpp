#include "fusion-server/rest/site_resources.h"

#include <algorithm>
#include <string>
#include <utility>

#include "common/resource/frame_document.h"
#include "fusion-server/wire/snapshot_resource.h"

namespace chorus::rest {
namespace {

using resource::Decimal;
using resource::Node;
using ViewPtr = std::shared_ptr<const site::SiteView>;

/// Places to a hundredth of a millimetre, as cells tell them one another.
constexpr int kSiteDigits = 5;

void add_vector(Node& node, const std::array<const char*, 3>& keys, const Eigen::Vector3d& value) {
  for (Eigen::Index i = 0; i < 3; ++i)
    node.properties.emplace_back(keys[static_cast<std::size_t>(i)], Decimal{value[i], kSiteDigits});
}

std::string_view state_of(const site::KnownCell& cell, const site::CellId& own) {
  if (cell.state.cell == own) return "own";
  if (cell.state.mistrusted) return "mistrusted";
  return cell.state.heard ? "heard" : "silent";
}

Node cell_node(const site::KnownCell& cell, const site::CellId& own) {
  const std::string name = cell.state.cell.str();
  Node node{name, {"SiteCell"}, {}};
  auto& out = node.properties;
  out.emplace_back("cellId", name);
  out.emplace_back("state", std::string(state_of(cell, own)));
  out.emplace_back("placed", cell.state.placed);
  out.emplace_back("people", static_cast<std::int64_t>(cell.state.people));
  out.emplace_back("refused", static_cast<std::int64_t>(cell.state.refused));
  if (cell.state.last != Timestamp{}) out.emplace_back("lastHeard", cell.state.last);
  if (!cell.url.empty()) out.emplace_back("address", cell.url);
  if (cell.state.learned > 0.0) {
    out.emplace_back("learnedFor", Decimal{cell.state.learned, 1});
    out.emplace_back("offX", Decimal{cell.state.off.x(), 3});
    out.emplace_back("offZ", Decimal{cell.state.off.y(), 3});
  }
  if (!cell.software.empty()) out.emplace_back("software", cell.software);
  if (!cell.place) return node;
  add_vector(node, {"x", "y", "z"}, cell.place->site_from_cell.translation());
  const Eigen::Quaterniond q(cell.place->site_from_cell.linear());
  constexpr int kTurnDigits = 6;
  out.emplace_back("qx", Decimal{q.x(), kTurnDigits});
  out.emplace_back("qy", Decimal{q.y(), kTurnDigits});
  out.emplace_back("qz", Decimal{q.z(), kTurnDigits});
  out.emplace_back("qw", Decimal{q.w(), kTurnDigits});
  return node;
}

http::DocumentPtr frame_of(const ViewPtr& view, const service::Serving& serving) {
  auto frame = wire::to_resource(*view->snapshot);
  frame.source = "site";
  http::DocumentOptions options;
  options.version = serving.run + "-" + std::to_string(frame.sequence);
  options.captured = frame.captured;
  return resource::frame_document(std::make_shared<const resource::FrameResource>(std::move(frame)),
                                  serving.place("site/frame", "site/"), std::move(options));
}

http::DocumentPtr list_of(const ViewPtr& view, const service::Serving& serving, const char* path,
                          Node (*make)(const site::SiteView&)) {
  http::DocumentOptions options;
  options.version = serving.run + "-" + std::to_string(view->snapshot->sequence);
  return resource::document_of(make(*view), std::move(options), serving.place(path),
                               resource::Kind::Container);
}

}  // namespace

Node site_person_node(const site::SitePerson& person, std::uint64_t number, std::string id) {
  Node node{std::move(id), {"SitePerson"}, {}};
  auto& out = node.properties;
  out.emplace_back("siteId", person.id.str());
  out.emplace_back("bodyId", static_cast<std::int64_t>(number));
  out.emplace_back("siteCertainty", Decimal{person.certainty, 3});
  out.emplace_back("cell", person.cell.str());
  out.emplace_back("cellBodyId", static_cast<std::int64_t>(person.body.value));
  out.emplace_back("captured", person.at);
  add_vector(node, {"x", "y", "z"}, person.place);
  add_vector(node, {"vx", "vy", "vz"}, person.velocity);
  std::vector<std::string> cells;
  for (const site::CellId& cell : person.seen_by) cells.push_back(cell.str());
  node.properties.emplace_back("cells", std::move(cells));
  return node;
}

Node site_people_node(const site::SiteView& view) {
  Node node{"", {"SitePersonList", "ldp:BasicContainer", "ldp:Container"}, {}};
  std::vector<resource::Ref> contains;
  std::vector<Node> members;
  for (std::size_t i = 0; i < view.people.size(); ++i) {
    const std::string id = "#" + view.people[i].id.str();
    contains.push_back({id});
    // The snapshot has everybody in the same order.
    members.push_back(site_person_node(view.people[i], view.snapshot->bodies[i].id.value, id));
  }
  node.properties.emplace_back("title", "people of " + view.site);
  node.properties.emplace_back("contains", std::move(contains));
  node.properties.emplace_back("sitePeople", std::move(members));
  return node;
}

Node site_cells_node(const site::SiteView& view) {
  Node node{"", {"SiteCellList", "ldp:BasicContainer", "ldp:Container"}, {}};
  std::vector<resource::Ref> contains;
  std::vector<Node> members;
  for (const site::KnownCell& cell : view.cells) {
    members.push_back(cell_node(cell, view.own));
    members.back().id = "#" + members.back().id;
    contains.push_back({members.back().id});
  }
  const site::SiteConnection& connection = view.connection;
  node.properties.emplace_back("title", "cells of " + view.site);
  node.properties.emplace_back("siteName", view.site);
  node.properties.emplace_back("cell", view.own.str());
  node.properties.emplace_back("connected", connection.connected);
  if (!connection.server.empty()) node.properties.emplace_back("server", connection.server);
  if (!connection.trouble.empty()) node.properties.emplace_back("trouble", connection.trouble);
  node.properties.emplace_back("dropped", static_cast<std::int64_t>(connection.dropped));
  node.properties.emplace_back("refused", static_cast<std::int64_t>(connection.refused));
  if (!connection.last_refusal.empty())
    node.properties.emplace_back("lastRefusal", connection.last_refusal);
  node.properties.emplace_back("contains", std::move(contains));
  node.properties.emplace_back("siteCells", std::move(members));
  return node;
}

SiteResources::SiteResources(service::Serving serving)
    : serving_(std::move(serving)),
      frame_(std::make_shared<http::LiveDocument>()),
      people_(std::make_shared<http::LiveDocument>()),
      cells_(std::make_shared<http::LiveDocument>()) {}

bool SiteResources::lists(std::string_view cell) const {
  const std::scoped_lock lock(mutex_);
  if (!shown_) return true;
  return std::ranges::any_of(
      shown_->cells, [&](const site::KnownCell& known) { return known.state.cell.str() == cell; });
}

void SiteResources::show(ViewPtr view) {
  {
    const std::scoped_lock lock(mutex_);
    shown_ = view;
  }
  frame_->publish_lazily([view, serving = serving_] { return frame_of(view, serving); });
  people_->publish_lazily([view, serving = serving_] {
    return list_of(view, serving, "site/people/", &site_people_node);
  });
  cells_->publish_lazily([view, serving = serving_] {
    return list_of(view, serving, "site/cells/", &site_cells_node);
  });
}

void SiteResources::add_routes(http::Router& router) {
  router.live("/site/frame", frame_);
  router.live("/site/people/", people_);
  router.live("/site/cells/", cells_);
}

}  // namespace chorus::rest
