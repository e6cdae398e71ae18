#include "services/ctl/convert/pose_import.h"

#include "common/importers/pose_frames.h"
#include "common/sensor/pixel_ray.h"
#include "services/ctl/calibrate/lens_file.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

Result<record::FrameRecording> import_one(const fs::path& input, const std::string& lens_file,
                                          double rate_hz, const importers::ImportOptions& options) {
  const auto lens = lens_in(lens_file);
  if (!lens) return pass(lens);
  auto recording = importers::read_pose_frames(input, {lens->camera, rate_hz}, options);
  if (!recording) return recording;
  for (SensorFrame& frame : recording->frames) {
    for (BodyFrame& body : frame.bodies) {
      for (Joint& joint : body.skeleton.joints) widen_ray(joint, lens->focal_sigma);
    }
  }
  return recording;
}

}  // namespace

Result<importers::ImportedSet> import_poses(const std::vector<fs::path>& inputs,
                                            const importers::ImportOptions& options,
                                            const PoseImport& how) {
  if (how.lenses.empty())
    return fail(ErrorCode::InvalidArgument, "--intrinsics",
                "is missing: landmarks in pixels have no direction without the lens (chorus "
                "calibrate camera, or its --fov)");
  if (auto ok = check_lens_count(how.lenses, inputs.size()); !ok) return pass(ok);
  return importers::import_recordings(
      inputs, options,
      [&](const fs::path& input, const importers::ImportOptions& own, std::size_t index) {
        return import_one(input, how.lenses[how.lenses.size() == 1 ? 0 : index], how.rate_hz, own);
      });
}

}  // namespace chorus::ctl
