#include "common/suit/suit_file.h"

#include <fmt/format.h>

#include "common/base/file.h"
#include "common/motion/mvnx.h"

namespace chorus::suit {
namespace {

constexpr double kShortest = 0.5;  // [m]
constexpr double kTallest = 2.5;   // [m]

Result<motion::Motion> motion_in(const std::filesystem::path& file,
                                 const SuitFileOptions& options) {
  const std::string ending = file.extension().string();
  const bool mvnx = ending == ".mvnx" || ending == ".MVNX";
  if (!mvnx && ending != ".bvh" && ending != ".BVH")
    return fail(ErrorCode::Unsupported, file.string(),
                "a suit's take is a .bvh or .mvnx file; export one from the suit's program");
  const auto text = read_file(file, motion::kMaxMvnxBytes);
  if (!text) return pass(text);
  if (mvnx) {
    const auto parsed = motion::parse_mvnx(*text, file.string());
    return parsed ? motion::motion_from_mvnx(*parsed) : pass(parsed);
  }
  const auto parsed = motion::parse_bvh(*text, file.string(), options.metres_per_unit);
  return parsed ? motion::motion_from_bvh(*parsed) : pass(parsed);
}

Result<void> check_size(const std::filesystem::path& file, const SuitTake& take) {
  double stature = 0.0;
  for (const SuitPose& pose : take.poses) {
    stature = stature_of(pose);
    if (stature > 0.0) break;
  }
  if (stature == 0.0 || (stature > kShortest && stature < kTallest)) return {};
  std::string advice = "say --stature";
  for (const auto& [unit, factor] :
       {std::pair{"metres", 100.0}, std::pair{"inches", 2.54}, std::pair{"millimetres", 0.1}}) {
    const double other = stature * factor;
    if (other > 1.2 && other < 2.1)
      advice = fmt::format(
          "in {} it would be {:.2f} m: scale the file to centimetres, or say "
          "--stature",
          unit, other);
  }
  return fail(ErrorCode::InvalidArgument, file.string(),
              fmt::format("its person is {:.2f} m tall; {}", stature, advice));
}

}  // namespace

Result<SuitTake> read_suit_file(const std::filesystem::path& file, const SuitFileOptions& options) {
  const auto motion = motion_in(file, options);
  if (!motion) return pass(motion);
  auto take = take_of(*motion, options.stature);
  if (!take) {
    Error error = take.error();
    error.context = file.string();
    return tl::unexpected<Error>(std::move(error));
  }
  if (const auto ok = check_size(file, *take); !ok) return pass(ok);
  return take;
}

}  // namespace chorus::suit
