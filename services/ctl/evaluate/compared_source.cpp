#include "services/ctl/evaluate/compared_source.h"

#include <algorithm>
#include <filesystem>

#include "common/base/duration.h"
#include "services/ctl/convert/fused_samples.h"

namespace chorus::ctl {
namespace {

constexpr std::pair<std::string_view, importers::MotionFormat> kMotionFiles[]{
    {".c3d", importers::MotionFormat::C3d},
    {".trc", importers::MotionFormat::Trc},
    {".bvh", importers::MotionFormat::Bvh},
    {".htr", importers::MotionFormat::Htr},
    {".mvnx", importers::MotionFormat::Mvnx}};

}  // namespace

std::optional<importers::MotionFormat> motion_format(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [name, format] : kMotionFiles)
    if (name == ending) return format;
  return std::nullopt;
}

Result<ComparedSource> read_motion(const std::string& file, importers::MotionFormat format,
                                   const importers::ImportOptions& options) {
  const auto motion = importers::read_motion_file(file, format, options);
  if (!motion) return pass(motion);
  ComparedSource out;
  const auto& frames = motion->recording.frames;
  for (const importers::TruthFrame& each : motion->truth) {
    if (each.index >= frames.size()) continue;
    const double time = seconds(frames[each.index].captured.time_since_epoch());
    out.people[each.person].push_back({time, each.skeleton});
  }
  for (const auto& [name, text] : motion->recording.notes)
    if (name.starts_with("damage")) out.notes.push_back(file + ": " + text);
  return out;
}

Result<ComparedSource> read_compared(const std::string& source, double seconds_of_server) {
  if (const auto format = motion_format(source)) return read_motion(source, *format);
  auto frames = read_fused_frames(
      source, std::chrono::milliseconds(static_cast<int>(1e3 * seconds_of_server)));
  if (!frames) return pass(frames);
  ComparedSource out;
  out.notes = std::move(frames->notes);
  for (exporters::FusedSample& sample : frames->samples)
    out.people[sample.person.value].push_back(
        {seconds(sample.instant.time_since_epoch()), sample.skeleton});
  for (auto& [id, track] : out.people)
    std::ranges::stable_sort(track, {}, &comparison::Moment::time);
  return out;
}

}  // namespace chorus::ctl
