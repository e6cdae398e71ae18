#include "common/http/event_reader.h"

#include <algorithm>
#include <utility>

namespace chorus::http {

namespace {

/// Finds the ends of lines in order; examines each byte once for a carriage return and once for a
/// line feed.  (find_first_of would call memchr for every byte.)
class LineEnds {
 public:
  explicit LineEnds(std::string_view bytes)
      : bytes_(bytes), feed_(next('\n', 0)), return_(next('\r', 0)) {}

  /// The position of the first carriage return or line feed at or after `here`; the size when there
  /// is none.
  [[nodiscard]] std::size_t after(std::size_t here) {
    if (feed_ < here) feed_ = next('\n', here);
    if (return_ < here) return_ = next('\r', here);
    return std::min(feed_, return_);
  }

 private:
  [[nodiscard]] std::size_t next(char wanted, std::size_t here) const {
    return std::min(bytes_.find(wanted, here), bytes_.size());
  }

  std::string_view bytes_;
  std::size_t feed_;
  std::size_t return_;
};

}  // namespace

Result<std::vector<ServerEvent>> EventReader::take(std::string_view bytes) {
  std::vector<ServerEvent> events;
  LineEnds ends(bytes);
  for (std::size_t here = 0; here < bytes.size();) {
    if (std::exchange(after_return_, false) && bytes[here] == '\n') {
      ++here;
      continue;
    }
    const std::size_t end = ends.after(here);
    const std::string_view part = bytes.substr(here, end - here);
    since_event_ += part.size() + 1;
    if (line_.size() + part.size() + data_.size() > most_ || since_event_ > 2 * most_) {
      return fail(ErrorCode::TooLarge, "event stream",
                  "an event is larger than " + std::to_string(most_) + " bytes");
    }
    if (!line_.empty() || end == bytes.size()) line_.append(part);
    if (end == bytes.size()) break;
    after_return_ = bytes[end] == '\r';
    here = end + 1;
    end_line(line_.empty() ? part : line_, events);
    line_.clear();
  }
  return events;
}

void EventReader::end_line(std::string_view line, std::vector<ServerEvent>& out) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
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
    if (data_.empty()) data_.reserve(usual_);
    if (std::exchange(any_data_, true)) data_ += '\n';
    data_.append(value);
  } else if (field == "id" && value.find('\0') == std::string_view::npos) {
    id_ = value;
  }
}

void EventReader::end_event(std::vector<ServerEvent>& out) {
  if (!std::exchange(any_data_, false)) return;
  since_event_ = 0;
  usual_ = data_.size();
  out.push_back({id_, std::move(data_)});
  data_.clear();
}

}  // namespace chorus::http
