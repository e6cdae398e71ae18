// A document of one instant, of whatever kind: what rings, servers and followers have in common.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/http/document.h"
#include "common/resource/media_type.h"
#include "common/time/timestamp.h"

namespace chorus::resource {

/// A frame, orientations, ...: whoever made it knows the type of the value.
struct Document {
  std::uint64_t sequence = 0;
  Timestamp captured;
  std::shared_ptr<const void> value;  ///< Null: no document.
};

/// `value` must have the members sequence and captured.
template <class Value>
[[nodiscard]] Document document_of_value(std::shared_ptr<const Value> value) {
  return {value->sequence, value->captured, std::move(value)};
}

/// The options of such documents.  The version is the sequence, with `run`, so that the ETags of a
/// restarted service differ.  latest_options(): the latest document is revalidated; its
/// Content-Location is its immutable copy, below `kept` ("frames/").  kept_options(): a copy may be
/// cached for a minute.
[[nodiscard]] http::DocumentOptions latest_options(const Document& document, std::string_view kept,
                                                   const std::string& run);
[[nodiscard]] http::DocumentOptions kept_options(const Document& document, const std::string& run);

/// One variant for each format, rendered when the first client asks for it.
[[nodiscard]] std::vector<http::Variant> variants_of(
    const std::function<std::string(Format)>& render);

}  // namespace chorus::resource
