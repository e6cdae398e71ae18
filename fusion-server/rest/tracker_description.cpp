#include "fusion-server/rest/tracker_description.h"

#include <utility>

#include "common/resource/floor_plane_resource.h"
#include "common/resource/link_lines.h"

namespace chorus::rest {
namespace {

http::DocumentPtr floor_document(const service::Serving& serving) {
  http::DocumentOptions options;
  options.version = serving.run;
  return resource::document_of(resource::floor_plane_node(FloorPlane{}, resource::SpaceKind::World),
                               std::move(options), serving.place("floor-plane"));
}

}  // namespace

service::Self self_of(const std::string& title, bool with_viewer, bool judged) {
  service::Self self;
  self.title = title;
  self.description = "Many body-tracking sensors, fused into one virtual tracker.";
  self.type = "Tracker";
  if (with_viewer) self.resources.push_back({"viewer/", "viewer", "all of it, to look at"});
  self.resources.insert(self.resources.end(),
                        {{"frame", "frame", "the latest frame: all bodies with their joints, live"},
                         {"skeletons/", "skeletons", "the bodies in the latest frame, one by one"},
                         {"floor-plane", "floorPlane", "where the floor is"},
                         {"sensors/", "sensorList", "state, age and clock of every sensor"},
                         {"registration", "registration", "where the sensors stand"},
                         {"people/", "personList", "who is there, and what they are called"},
                         {"events", "eventList", "what happened in the last day"},
                         {"props/", "propList", "what people hold, and where it is"},
                         {"outputs/", "", "which other protocols are served, and to how many"}});
  if (judged)
    self.resources.push_back({"evaluation", "evaluation", "what worn sensors say of it, live"});
  return self;
}

void add_description_routes(http::Router& router, const service::Serving& serving,
                            const service::Self& self, const std::string& viewer_dir) {
  const auto root = service::self_document(self, serving, "1");
  const auto floor = floor_document(serving);
  router.get("/", [root](const http::Request&, const http::PathParams&) { return root; });
  router.get("/floor-plane",
             [floor](const http::Request&, const http::PathParams&) { return floor; });
  if (!viewer_dir.empty()) {
    router.files("/viewer/", viewer_dir,
                 {resource::link_lines(resource::Kind::Other), http::Page::Viewer});
  }
}

}  // namespace chorus::rest
