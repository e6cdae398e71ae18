#include "common/service/self_description.h"

#include <memory>
#include <string_view>
#include <utility>

#include "common/http/html.h"
#include "common/resource/link_lines.h"

namespace chorus::service {
namespace {

using resource::Format;
using resource::Node;
using resource::Ref;

/// Resources that every service has (common_resources.h, recordings.h).
std::vector<Listed> everywhere() {
  return {{"recordings/", "recordingList", "what has been recorded here"},
          {"clock", "clock", "how well this host keeps time"},
          {"healthz", "", "whether frames are coming"},
          {"metrics", "", "counters for Prometheus"},
          {"configuration", "", "what is in force, and what waits for a restart"},
          {"openapi.json", "endpointDescription", "the interface for tools"},
          {".well-known/wot", "", "the interface for the Web of Things"},
          {"ns", "", "the vocabulary"},
          {"shapes", "", "what valid Turtle looks like (SHACL)"},
          {"context.jsonld", "", "the JSON-LD context"}};
}

constexpr std::string_view kPageStart =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n"
    "<style>body{font:16px/1.5 sans-serif;max-width:44em;margin:2em auto;padding:0 1em}"
    "td{padding:.1em 1em .1em 0;vertical-align:top}pre{background:#8882;padding:1em}</style>\n";

constexpr std::string_view kPageEnd =
    "<p>Every resource speaks Turtle, JSON, JSON-LD and N-Triples; ask with "
    "<code>Accept</code>:</p>\n"
    "<pre>curl -H 'Accept: application/json' http://HOST:PORT/frame\n"
    "curl -H 'Prefer: wait=10' -H 'If-None-Match: ETAG' http://HOST:PORT/frame   # the next frame\n"
    "curl -N -H 'Accept: text/event-stream' http://HOST:PORT/frame              # all of "
    "them</pre>\n"
    "</body></html>\n";

}  // namespace

std::vector<Listed> all_resources(const Self& self) {
  std::vector<Listed> all = self.resources;
  for (Listed& one : everywhere()) all.push_back(std::move(one));
  return all;
}

Node self_node(const Self& self) {
  Node node{"", {self.type, "ldp:BasicContainer", "dcat:DataService"}, {}};
  auto& say = node.properties;
  say.emplace_back("title", self.title);
  say.emplace_back("description", self.description);
  say.insert(say.end(), self.facts.begin(), self.facts.end());
  say.emplace_back("endpointURL", Ref{""});
  std::vector<Ref> contains;
  for (const Listed& one : all_resources(self)) {
    if (!one.key.empty()) say.emplace_back(one.key, Ref{one.path});
    contains.push_back({one.path});
  }
  say.emplace_back("contains", std::move(contains));
  return node;
}

std::string self_page(const Self& self) {
  std::string page(kPageStart);
  const std::string name = http::escaped_html(self.title);
  page += "<title>" + name + "</title></head><body>\n<h1>" + name + "</h1>\n<p>";
  page += http::escaped_html(self.description) + "</p>\n<table>\n";
  for (const Listed& one : all_resources(self)) {
    const std::string path = http::escaped_html(one.path);
    page += "<tr><td><a href=\"" + path + "\">/" + path + "</a></td><td>" +
            http::escaped_html(one.what) + "</td></tr>\n";
  }
  return page.append("</table>\n").append(kPageEnd);
}

http::DocumentPtr self_document(const Self& self, const Serving& serving,
                                const std::string& version) {
  const auto node = std::make_shared<const Node>(self_node(self));
  std::vector<http::Variant> variants;
  for (const Format format : resource::kFormats) {
    variants.push_back(
        {std::string(resource::media_type(format)),
         [node, format, here = serving.place("")] { return write(*node, format, here); }});
  }
  variants.push_back({"text/html; charset=utf-8", [self] { return self_page(self); }});
  http::DocumentOptions options;
  options.version = version + "." + serving.run;
  options.headers = {
      {"Link", "</openapi.json>; rel=\"service-desc\""},
      {"Link", "</.well-known/wot>; rel=\"describedby\"; type=\"application/td+json\""}};
  return std::make_shared<const http::Document>(
      resource::linked(std::move(variants), resource::Kind::Container), std::move(options));
}

}  // namespace chorus::service
