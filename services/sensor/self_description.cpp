#include "services/sensor/self_description.h"

#include <array>
#include <utility>
#include <vector>

#include "common/http/html.h"

namespace chorus::sensor_service {

namespace {

using resource::Decimal;
using resource::Format;
using resource::Node;
using resource::Ref;

/// One resource of a sensor.  `key`: the property that names its role; empty: only contained.
struct Resource {
  std::string_view path;
  std::string_view key;
  std::string_view what;
  bool only_with_images = false;
};

constexpr std::array kResources{
    Resource{"frame", "frame", "the latest frame: all bodies with their joints, live"},
    Resource{"skeletons/", "skeletons", "the bodies in the latest frame, one by one"},
    Resource{"floor-plane", "floorPlane", "where the floor is"},
    Resource{"images/", "", "the camera images and their intrinsics", true},
    Resource{"images/color", "colorImage", "the latest colour image, JPEG", true},
    Resource{"images/depth", "depthImage", "the latest depth image, 16-bit PNG in millimetres",
             true},
    Resource{"recordings/", "recordingList", "what this sensor has recorded"},
    Resource{"clock", "clock", "how well this host keeps time"},
    Resource{"healthz", "", "whether frames are coming in"},
    Resource{"metrics", "", "counters for Prometheus"},
    Resource{"openapi.json", "endpointDescription", "the interface for tools"},
    Resource{"ns", "", "the vocabulary"},
    Resource{"shapes", "", "what valid Turtle looks like (SHACL)"},
    Resource{"context.jsonld", "", "the JSON-LD context"},
};

std::vector<Resource> resources_of(const Self& self) {
  std::vector<Resource> shown;
  for (const Resource& one : kResources) {
    if (self.images || !one.only_with_images) shown.push_back(one);
  }
  return shown;
}

constexpr std::string_view kPageStart =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n"
    "<style>body{font:16px/1.5 sans-serif;max-width:44em;margin:2em auto;padding:0 1em}"
    "td{padding:.1em 1em .1em 0;vertical-align:top}pre{background:#eee;padding:1em}</style>\n";

constexpr std::string_view kPageEnd =
    "<p>Every resource speaks Turtle, JSON, JSON-LD and N-Triples; ask with "
    "<code>Accept</code>:</p>\n"
    "<pre>curl -H 'Accept: application/json' http://HOST:PORT/frame\n"
    "curl -H 'Prefer: wait=10' -H 'If-None-Match: ETAG' http://HOST:PORT/frame   # the next frame\n"
    "curl -N -H 'Accept: text/event-stream' http://HOST:PORT/frame              # all of "
    "them</pre>\n"
    "</body></html>\n";

}  // namespace

Node self_node(const Self& self) {
  Node node{"", {"Sensor", "ldp:BasicContainer", "dcat:DataService"}, {}};
  auto& say = node.properties;
  say.emplace_back("title", "Sensor " + self.id.str());
  say.emplace_back("description",
                   "One body-tracking sensor: what it sees as linked-data resources.");
  say.emplace_back("sensorId", self.id.str());
  say.emplace_back("deviceKind", self.device.kind);
  say.emplace_back("deviceLabel", self.device.label);
  say.emplace_back("nominalRateHz", Decimal{self.device.nominal_rate_hz, 2});
  say.emplace_back("endpointURL", Ref{""});
  std::vector<Ref> contains;
  for (const Resource& one : resources_of(self)) {
    if (!one.key.empty()) say.emplace_back(std::string(one.key), Ref{std::string(one.path)});
    contains.push_back({std::string(one.path)});
  }
  say.emplace_back("contains", std::move(contains));
  return node;
}

std::string self_page(const Self& self) {
  std::string page(kPageStart);
  const std::string name = http::escaped_html(self.id.str());
  page += "<title>Sensor " + name + "</title></head><body>\n<h1>Sensor " + name + "</h1>\n<p>";
  page += http::escaped_html(self.device.label) + "</p>\n<table>\n";
  for (const Resource& one : resources_of(self)) {
    const std::string path(one.path);
    page += "<tr><td><a href=\"" + path + "\">/" + path + "</a></td><td>" + std::string(one.what) +
            "</td></tr>\n";
  }
  return page.append("</table>\n").append(kPageEnd);
}

http::DocumentPtr self_document(const Self& self, const Serving& serving) {
  const auto node = std::make_shared<const Node>(self_node(self));
  std::vector<http::Variant> variants;
  for (const Format format : resource::kFormats) {
    variants.push_back(
        {std::string(resource::media_type(format)), [node, format, root = serving.root] {
           return resource::write(*node, format, {.root = root});
         }});
  }
  variants.push_back({"text/html", [self] { return self_page(self); }});
  http::DocumentOptions options;
  options.version = std::string(self.images ? "images" : "plain") + "." + serving.run;
  options.container = true;
  options.headers = {{"Link", "</openapi.json>; rel=\"service-desc\""}};
  return std::make_shared<const http::Document>(std::move(variants), std::move(options));
}

}  // namespace chorus::sensor_service
