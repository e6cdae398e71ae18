#include "common/record/cell_stream.h"

#include <utility>

#include "common/record/cell_sorting.h"

namespace chorus::record {
namespace {

namespace fs = std::filesystem;

bool is_scene(std::string_view topic) {
  return topic.ends_with("/scene") || topic == "/transforms";
}

}  // namespace

ReadLimits limits_of(const CellQuery& query) {
  ReadLimits limits = query.limits;
  const std::string own = std::string(kSensorsPrefix) + query.only.str() + "/";
  const std::string worn = std::string(kInertialPrefix) + query.only.str();
  limits.wanted = [raw = query.raw, all = query.only.str().empty(), own, worn,
                   inertial = query.inertial](std::string_view topic) {
    if (topic.starts_with(kInertialPrefix))
      return inertial && (all || topic.starts_with(worn + "/"));
    if (!raw) return topic == kFusedTopic;
    const bool others = !all && topic.starts_with(kSensorsPrefix);
    return !is_scene(topic) && (!others || topic.starts_with(own));
  };
  return limits;
}

struct CellStream::Impl {
  Impl(std::vector<fs::path> all, CellQuery asked)
      : files(in_log_order(std::move(all))), query(std::move(asked)), sorting(query) {}

  Result<void> open_next() {
    const fs::path& file = files[next_file++];
    auto opened = RecordingStream::open(file, limits_of(query));
    if (!opened) return pass(opened);
    current.emplace(std::move(*opened));
    sorting.begin_file(file, current->channels(), current->metadata());
    return {};
  }

  Result<void> close_current() {
    const RecordingStream closed = std::move(*current);
    current.reset();
    return sorting.end_file(closed.channels(), closed.notes());
  }

  std::vector<fs::path> files;
  std::size_t next_file = 0;
  CellQuery query;
  Sorting sorting;
  std::optional<RecordingStream> current;
};

CellStream::CellStream(std::vector<fs::path> files, CellQuery query)
    : impl_(std::make_unique<Impl>(std::move(files), std::move(query))) {}
CellStream::CellStream(CellStream&&) noexcept = default;
CellStream& CellStream::operator=(CellStream&&) noexcept = default;
CellStream::~CellStream() = default;

Result<std::optional<SessionItem>> CellStream::next() {
  Impl& in = *impl_;
  while (true) {
    if (auto item = in.sorting.ready()) return item;
    if (!in.current) {
      if (in.next_file == in.files.size()) break;
      if (auto ok = in.open_next(); !ok) return pass(ok);
    }
    const auto message = in.current->next();
    if (!message) {
      Error error = message.error();
      error.context = in.files[in.next_file - 1].string();
      return tl::unexpected<Error>(std::move(error));
    }
    if (!*message) {
      if (auto ok = in.close_current(); !ok) return pass(ok);
      continue;
    }
    if (auto ok = in.sorting.take(**message); !ok) return pass(ok);
  }
  in.sorting.end();
  return in.sorting.ready();
}

CellRecording CellStream::finish() { return impl_->sorting.finish(); }

}  // namespace chorus::record
