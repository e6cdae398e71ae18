#include "common/record/marks.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/parse.h"
#include "common/record/recording.h"

namespace chorus::record {

std::string mark_json(const Marked& mark) {
  const nlohmann::json out{{"capturedNanoseconds", std::to_string(to_unix_ns(mark.at))},
                           {"text", mark.text}};
  return out.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Result<std::vector<Marked>> marks_in(const std::vector<std::filesystem::path>& files) {
  std::vector<Marked> marks;
  ReadLimits limits;
  limits.wanted = [](std::string_view topic) { return topic == kMarksTopic; };
  for (const std::filesystem::path& file : files) {
    const auto recording = read_recording(file, limits);
    if (!recording) return pass(recording);
    for (const Message& message : recording->messages) {
      const auto json = parse_json(message.data).value_or(nlohmann::json());
      if (!json.is_object() || !json.value("text", nlohmann::json()).is_string()) continue;
      marks.push_back({message.publish_time, json["text"].get<std::string>()});
    }
  }
  std::ranges::stable_sort(marks, {}, &Marked::at);
  return marks;
}

}  // namespace chorus::record
