#include "common/resource/document.h"

namespace chorus::resource {
namespace {

/// A document never changes, but a restarted service may reuse its number.  So caches may keep it
/// for about as long as a service does, but not for ever.
constexpr std::string_view kImmutable = "public, max-age=60, immutable";

std::string version_of(const Document& document, const std::string& run) {
  return std::to_string(document.sequence) + (run.empty() ? "" : "." + run);
}

}  // namespace

http::DocumentOptions latest_options(const Document& document, std::string_view kept,
                                     const std::string& run) {
  http::DocumentOptions options;
  options.version = version_of(document, run);
  options.content_location = std::string(kept) + std::to_string(document.sequence);
  options.captured = document.captured;
  return options;
}

http::DocumentOptions kept_options(const Document& document, const std::string& run) {
  http::DocumentOptions options;
  options.version = version_of(document, run);
  options.cache_control = kImmutable;  // Without `captured`: the age of an old one is of no use.
  return options;
}

std::vector<http::Variant> variants_of(const std::function<std::string(Format)>& render) {
  std::vector<http::Variant> variants;
  for (const Format format : kFormats) {
    variants.push_back(
        {std::string(media_type(format)), [render, format] { return render(format); }});
  }
  return variants;
}

}  // namespace chorus::resource
