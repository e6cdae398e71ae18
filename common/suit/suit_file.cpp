#include "common/suit/suit_file.h"

#include <utility>

#include <fmt/format.h>

#include "common/base/file.h"
#include "common/motion/htr.h"
#include "common/motion/mvnx.h"

namespace chorus::suit {
namespace {

constexpr double kShortest = 0.5;  // [m]
constexpr double kTallest = 2.5;   // [m]

Result<motion::Motion> motion_in(const std::filesystem::path& file, const SuitFileOptions& options,
                                 std::vector<std::string>& notes) {
  const std::string ending = file.extension().string();
  const bool mvnx = ending == ".mvnx" || ending == ".MVNX";
  const bool htr = ending == ".htr" || ending == ".HTR";
  if (!mvnx && !htr && ending != ".bvh" && ending != ".BVH")
    return fail(ErrorCode::Unsupported, file.string(),
                "a suit's take is a .bvh, .htr or .mvnx file; export one from the suit's program");
  const auto text = read_file(file, motion::kMaxMvnxBytes);
  if (!text) return pass(text);
  if (mvnx) {
    const auto parsed = motion::parse_mvnx(*text, file.string());
    return parsed ? motion::motion_from_mvnx(*parsed) : pass(parsed);
  }
  const auto parsed = htr ? motion::parse_htr(*text, file.string())
                          : motion::parse_bvh(*text, file.string(), options.metres_per_unit);
  if (!parsed) return pass(parsed);
  for (const std::string& note : parsed->notes)
    notes.push_back(file.filename().string() + " " + note);
  return motion::motion_from_bvh(*parsed);
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
  std::vector<std::string> notes;
  const auto motion = motion_in(file, options, notes);
  if (!motion) return pass(motion);
  auto take = take_of(*motion, options.stature);
  if (!take) {
    Error error = take.error();
    error.context = file.string();
    return tl::unexpected<Error>(std::move(error));
  }
  if (const auto ok = check_size(file, *take); !ok) return pass(ok);
  take->notes = std::move(notes);
  return take;
}

}  // namespace chorus::suit
