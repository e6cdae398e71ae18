#include "services/ctl/calibrate/lens_file.h"

#include <fmt/format.h>

#include "common/base/config_reader.h"
#include "common/base/file.h"

namespace chorus::ctl {
namespace {

constexpr std::uintmax_t kMaxLensBytes = 1u << 20;

/// Only the lens, as JSON text.
Result<std::string> lens_text(const std::string& file) {
  const auto text = read_file(file, kMaxLensBytes);
  if (!text) return pass(text);
  auto root = ConfigReader::parse(*text, file);
  if (!root) return pass(root);
  if (!root->has("device")) return root->text();
  const std::string own = root->child("device").child("camera").text("intrinsics");
  if (!own.empty()) return own;
  return fail(ErrorCode::InvalidArgument, file,
              "is a sensor's configuration without device.camera.intrinsics");
}

}  // namespace

Result<camera::CameraSettings> read_lens_file(const std::string& file) {
  const auto lens = lens_text(file);
  if (!lens) return pass(lens);
  auto reader = ConfigReader::parse(R"({"intrinsics": )" + *lens + "}", file);
  if (!reader) return pass(reader);
  auto settings = camera::read_camera_settings(*reader);
  if (!settings.intrinsics)
    return fail(ErrorCode::InvalidArgument, file,
                "holds no lens: width, height, fx, fy, cx and cy are needed, in pixels, as "
                "`chorus calibrate camera --out` writes them");
  if (auto ok = reader->finish(); !ok) return pass(ok);
  return settings;
}

Result<camera::Lens> lens_in(const std::string& file) {
  const auto settings = read_lens_file(file);
  if (!settings) return pass(settings);
  return camera::lens_for(*settings, {settings->intrinsics->width, settings->intrinsics->height});
}

Result<void> check_lens_count(const std::vector<std::string>& lenses, std::size_t inputs) {
  if (lenses.size() <= 1 || lenses.size() == inputs) return {};
  return fail(ErrorCode::InvalidArgument, "--intrinsics",
              fmt::format("takes one lens for all, or one for each of the {} inputs, not {}",
                          inputs, lenses.size()));
}

}  // namespace chorus::ctl
