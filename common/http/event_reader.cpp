#include "common/http/event_reader.h"

#include <utility>

namespace chorus::http {

Result<std::vector<ServerEvent>> EventReader::take(std::string_view bytes) {
  std::vector<ServerEvent> events;
  while (!bytes.empty()) {
    if (std::exchange(after_return_, false) && bytes.front() == '\n') {
      bytes.remove_prefix(1);
      continue;
    }
    const std::size_t end = bytes.find_first_of("\r\n");
    const std::string_view part = bytes.substr(0, end);
    if (line_.size() + part.size() + data_.size() > most_) {
      return fail(ErrorCode::TooLarge, "event stream",
                  "an event is larger than " + std::to_string(most_) + " bytes");
    }
    line_.append(part);
    if (end == std::string_view::npos) break;
    after_return_ = bytes[end] == '\r';
    bytes.remove_prefix(end + 1);
    end_line(events);
  }
  return events;
}

void EventReader::end_line(std::vector<ServerEvent>& out) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  std::string_view line = line_;
  if (std::exchange(at_begin_, false) && line.starts_with(kByteOrderMark))
    line.remove_prefix(kByteOrderMark.size());
  const std::size_t colon = line.find(':');
  const std::string_view field = line.substr(0, colon);
  std::string_view value;
  if (colon != std::string_view::npos) value = line.substr(colon + 1);
  if (value.starts_with(' ')) value.remove_prefix(1);
  if (line.empty()) {
    end_event(out);
  } else if (field == "data") {
    if (std::exchange(any_data_, true)) data_ += '\n';
    data_.append(value);
  } else if (field == "id" && value.find('\0') == std::string_view::npos) {
    id_ = value;
  }
  line_.clear();
}

void EventReader::end_event(std::vector<ServerEvent>& out) {
  if (std::exchange(any_data_, false)) out.push_back({id_, std::move(data_)});
  data_.clear();
}

}  // namespace chorus::http
