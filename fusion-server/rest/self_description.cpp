#include "fusion-server/rest/self_description.h"

#include <memory>
#include <utility>

#include "common/http/html.h"
#include "common/resource/floor_plane_resource.h"

namespace chorus::rest {
namespace {

using resource::Ref;

http::DocumentPtr root_document(const RestContext& context, const std::string& title, bool viewer) {
  const auto node = std::make_shared<const resource::Node>(service_node(title, viewer));
  resource::Place here;
  here.root = context.root;
  std::vector<http::Variant> variants;
  for (const resource::Format format : resource::kFormats) {
    variants.push_back({std::string(resource::media_type(format)),
                        [node, format, here] { return write(*node, format, here); }});
  }
  variants.push_back(
      {"text/html; charset=utf-8", [title, viewer] { return landing_page(title, viewer); }});
  http::DocumentOptions options;
  options.version = context.instance;
  options.container = true;
  return std::make_shared<const http::Document>(std::move(variants), std::move(options));
}

http::DocumentPtr floor_document(const RestContext& context) {
  resource::Node node = resource::floor_plane_node(FloorPlane{}, resource::SpaceKind::World);
  http::DocumentOptions options;
  options.version = context.instance;
  resource::Place here;
  here.path = "floor-plane";
  here.root = context.root;
  return resource::document_of(std::move(node), std::move(options), here);
}

}  // namespace

resource::Node service_node(const std::string& title, bool with_viewer) {
  resource::Node node{"", {"Tracker", "dcat:DataService", "ldp:BasicContainer"}, {}};
  auto& out = node.properties;
  out.emplace_back("title", title);
  out.emplace_back("description",
                   std::string("many body-tracking sensors, fused into one virtual tracker"));
  out.emplace_back("endpointURL", Ref{""});
  out.emplace_back("endpointDescription", Ref{"openapi.json"});
  out.emplace_back("frame", Ref{"frame"});
  out.emplace_back("skeletons", Ref{"skeletons/"});
  out.emplace_back("floorPlane", Ref{"floor-plane"});
  out.emplace_back("sensorList", Ref{"sensors/"});
  out.emplace_back("registration", Ref{"registration"});
  out.emplace_back("recordingList", Ref{"recordings/"});
  out.emplace_back("clock", Ref{"clock"});
  if (with_viewer) out.emplace_back("viewer", Ref{"viewer/"});
  std::vector<Ref> contains{{"frame"},        {"skeletons/"},  {"floor-plane"}, {"sensors/"},
                            {"registration"}, {"recordings/"}, {"clock"}};
  out.emplace_back("contains", std::move(contains));
  return node;
}

std::string landing_page(const std::string& title, bool with_viewer) {
  const std::string name = http::escaped_html(title);
  std::string page = "<!doctype html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>" +
                     name +
                     "</title>\n<meta name=\"viewport\" content=\"width=device-width\">\n"
                     "<style>body{font:16px/1.5 system-ui,sans-serif;max-width:44rem;margin:3rem "
                     "auto;padding:0 1rem}"
                     "code{background:#8882;padding:.1em "
                     ".3em}a.big{font-size:1.25rem}</style></head>\n<body>\n<h1>" +
                     name + "</h1>\n<p>Many body-tracking sensors, one tracker.</p>\n";
  if (with_viewer) page += "<p><a class=\"big\" href=\"viewer/\">Open the viewer</a></p>\n";
  page +=
      "<ul>\n"
      "<li><a href=\"frame\">frame</a>: all bodies now; Turtle, JSON, JSON-LD, N-Triples by "
      "<code>Accept</code></li>\n"
      "<li><a href=\"skeletons/\">skeletons/</a>: one resource per body</li>\n"
      "<li><a href=\"sensors/\">sensors/</a>: state, age and clock of every sensor</li>\n"
      "<li><a href=\"registration\">registration</a>: where the sensors stand</li>\n"
      "<li><a href=\"recordings/\">recordings/</a>: what has been recorded</li>\n"
      "<li><a href=\"floor-plane\">floor-plane</a>, <a href=\"clock\">clock</a>, "
      "<a href=\"healthz\">healthz</a>, <a href=\"metrics\">metrics</a>, "
      "<a href=\"openapi.json\">openapi.json</a>, <a href=\"ns\">ns</a></li>\n"
      "</ul>\n<p>Try: <code>curl -H 'Accept: application/json' http://HOST:PORT/frame</code></p>\n"
      "</body>\n</html>\n";
  return page;
}

void add_description_routes(http::Router& router, const RestContext& context,
                            const std::string& title, const std::string& viewer_dir) {
  const auto root = root_document(context, title, !viewer_dir.empty());
  const auto floor = floor_document(context);
  router.get("/", [root](const http::Request&, const http::PathParams&) { return root; });
  router.get("/floor-plane",
             [floor](const http::Request&, const http::PathParams&) { return floor; });
  if (!viewer_dir.empty()) router.files("/viewer/", viewer_dir);
}

}  // namespace chorus::rest
