#include "services/ctl/evaluate/recorded_marks.h"

#include <filesystem>
#include <system_error>

#include "common/record/marks.h"
#include "common/record/recording_files.h"
#include "common/record/recording_view.h"
#include "common/service/recording_views.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

}  // namespace

Result<ergonomics::Marks> marks_of(const std::string& source, const FusedSpan& span) {
  ergonomics::Marks out{{}, span.seconds};
  std::error_code failed;
  const bool folder = fs::is_directory(source, failed);
  if (!folder && !source.ends_with(".mcap")) return out;
  const auto files = record::find_recordings({source});
  if (!files) return pass(files);
  const fs::path kept = (folder ? fs::path(source) : fs::path(source).parent_path()) / "marks.json";
  if (fs::exists(kept, failed)) {
    const auto stored = service::stored_marks(kept);
    if (!stored) return pass(stored);
    const auto view = record::RecordingView::open(*files);
    if (!view) return pass(view);
    // Their seconds count from the recording's first message.
    const double shift = seconds(view->first() - span.start);
    for (const service::Mark& mark : *stored) out.all.push_back({mark.seconds + shift, mark.text});
    return out;
  }
  const auto marks = record::marks_in(*files);
  if (!marks) return pass(marks);
  for (const record::Marked& mark : *marks)
    out.all.push_back({seconds(mark.at - span.start), mark.text});
  return out;
}

}  // namespace chorus::ctl
