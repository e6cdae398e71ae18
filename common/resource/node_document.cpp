#include <memory>

#include "common/resource/node.h"

namespace chorus::resource {

http::DocumentPtr document_of(Node node, http::DocumentOptions options, Place place, Kind kind) {
  const auto shared = std::make_shared<const Node>(std::move(node));
  std::vector<http::Variant> variants;
  for (const Format format : kFormats) {
    variants.push_back({std::string(media_type(format)),
                        [shared, place, format] { return write(*shared, format, place); }});
  }
  return std::make_shared<const http::Document>(linked(std::move(variants), kind),
                                                std::move(options));
}

}  // namespace chorus::resource
