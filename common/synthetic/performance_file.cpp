#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <system_error>

#include "common/base/file.h"
#include "common/motion/asf_amc.h"
#include "common/motion/bvh.h"
#include "common/motion/c3d.h"
#include "common/motion/mvnx.h"
#include "common/synthetic/performance.h"

namespace chorus::synthetic {
namespace {

using Captured = Result<std::vector<motion::Motion>>;

constexpr std::uintmax_t kMaxBytes = 256u << 20;

Result<std::string> text_of(const std::filesystem::path& path) {
  std::error_code problem;
  if (std::filesystem::is_directory(path, problem)) {
    return fail(ErrorCode::InvalidArgument, path.string(), "is a folder; name a motion file");
  }
  return read_file(path, kMaxBytes);
}

/// One motion as a result; when its conversion fails, the error names the file.
Captured single(Result<motion::Motion> motion, const std::string& origin) {
  if (!motion) return fail(motion.error().code, origin, to_string(motion.error()));
  std::vector<motion::Motion> one;
  one.push_back(std::move(*motion));
  return one;
}

Captured from_bvh(const MotionFile& file, const std::string& text) {
  const auto bvh = motion::parse_bvh(text, file.path.string(), file.metres_per_unit);
  if (!bvh) return pass(bvh);
  return single(motion::motion_from_bvh(*bvh), file.path.string());
}

/// The skeleton's file: "02_01.amc" -> "02_01.asf" if that exists, otherwise "02.asf".
std::filesystem::path skeleton_of(const std::filesystem::path& amc) {
  std::filesystem::path own = amc;
  own.replace_extension(".asf");
  std::error_code ignored;
  const std::string name = amc.stem().string();
  if (std::filesystem::exists(own, ignored) || name.find('_') == std::string::npos) return own;
  return amc.parent_path() / (name.substr(0, name.find('_')) + ".asf");
}

Captured from_amc(const MotionFile& file, const std::string& text) {
  const std::filesystem::path asf = skeleton_of(file.path);
  const auto described = text_of(asf);
  if (!described) {
    return fail(described.error().code, asf.string(),
                described.error().message + "; an .amc needs its skeleton beside it");
  }
  const auto skeleton = motion::parse_asf(*described, asf.string());
  if (!skeleton) return pass(skeleton);
  const auto frames = motion::parse_amc(text, file.path.string(), *skeleton);
  if (!frames) return pass(frames);
  return single(motion::motion_from_amc(*skeleton, *frames), file.path.string());
}

Captured from_c3d(const MotionFile& file, const std::string& bytes) {
  const auto c3d = motion::parse_c3d(bytes, file.path.string());
  if (!c3d) return pass(c3d);
  auto found = motion::motion_from_markers(*c3d);
  if (!found) return fail(found.error().code, file.path.string(), to_string(found.error()));
  std::vector<motion::Motion> people;
  for (auto& subject : found->subjects) people.push_back(std::move(subject.motion));
  return people;
}

Captured from_mvnx(const MotionFile& file, const std::string& text) {
  const auto mvnx = motion::parse_mvnx(text, file.path.string());
  if (!mvnx) return pass(mvnx);
  return single(motion::motion_from_mvnx(*mvnx), file.path.string());
}

struct Reader {
  std::string_view ending;
  Captured (*read)(const MotionFile&, const std::string&);
};

constexpr std::array kReaders{Reader{".bvh", from_bvh}, Reader{".amc", from_amc},
                              Reader{".c3d", from_c3d}, Reader{".mvnx", from_mvnx}};

std::string ending_of(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

Result<Performance> read_performance(const MotionFile& file) {
  const std::string ending = ending_of(file.path);
  const auto reader = std::ranges::find(kReaders, ending, &Reader::ending);
  if (reader == kReaders.end()) {
    return fail(ErrorCode::Unsupported, file.path.string(),
                "is no motion file that can be played; these can: .bvh, .amc (with its .asf), "
                ".c3d, .mvnx");
  }
  const auto text = text_of(file.path);
  if (!text) return pass(text);
  auto captured = reader->read(file, *text);
  if (!captured) return pass(captured);
  auto performance = staged(std::move(*captured));
  if (performance) return performance;
  return fail(performance.error().code, file.path.string(), to_string(performance.error()));
}

}  // namespace chorus::synthetic
