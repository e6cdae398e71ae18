// Makes text from outside safe in a page for browsers.
#pragma once

#include <string>
#include <string_view>

namespace chorus::http {

/// Safe between tags and in quoted attributes: & < > " become entities.
[[nodiscard]] std::string escaped_html(std::string_view text);

}  // namespace chorus::http
