// Marks: instants that somebody named while a recording ran ("takes the drill").  In a recording
// they are messages of the topic /marks.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/time/timestamp.h"

namespace chorus::record {

inline constexpr std::string_view kMarksTopic = "/marks";
inline constexpr std::string_view kMarkSchemaName = "chorus.Mark";
inline constexpr std::string_view kMarkSchema = R"({
  "$schema": "http://json-schema.org/draft-07/schema#",
  "title": "chorus.Mark",
  "description": "An instant that somebody named while it was recorded, by the recorder's clock",
  "type": "object",
  "required": ["capturedNanoseconds", "text"],
  "properties": {
    "capturedNanoseconds": {"type": "string"},
    "text": {"type": "string", "minLength": 1, "maxLength": 200}
  }
})";

struct Marked {
  Timestamp at;
  std::string text;

  bool operator==(const Marked&) const = default;
};

[[nodiscard]] std::string mark_json(const Marked& mark);

/// The marks in a recording's files, in the order of time.  Messages that are no marks are left
/// out.
[[nodiscard]] Result<std::vector<Marked>> marks_in(const std::vector<std::filesystem::path>& files);

}  // namespace chorus::record
