// The parts of proto/ that say which fields a frame has, made from the fields' table.
#pragma once

#include <string>

namespace chorus::contract {

/// Each takes a file's text and returns it with its generated parts as the table wants them.  In
/// Turtle these are between the lines kBegin and kEnd; in JSON and in the README they are the
/// entries of the table's names, which are replaced where they stand, new ones behind the others.
[[nodiscard]] std::string with_vocabulary(const std::string& text);
[[nodiscard]] std::string with_shapes(const std::string& text);
[[nodiscard]] std::string with_context(const std::string& text);
[[nodiscard]] std::string with_openapi(const std::string& text);
[[nodiscard]] std::string with_schema(const std::string& text);
[[nodiscard]] std::string with_readme(const std::string& text);

inline constexpr const char* kBegin =
    "# Generated from the fields' table by chorus-contract: begin\n";
inline constexpr const char* kEnd = "# Generated: end\n";

}  // namespace chorus::contract
