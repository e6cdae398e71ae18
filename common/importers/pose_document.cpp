#include "common/importers/pose_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "common/importers/json_values.h"
#include "common/importers/picture_numbers.h"
#include "common/layout/tables.h"
#include "common/sensor/limits.h"

namespace chorus::importers {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kMaxConfidence = 1e3;  // some networks exceed 1, which then counts as 1
constexpr std::uint64_t kMostId = 1'000'000'000;
// [s] after the first picture: 115 days.  A larger number is surely wrong, and could overflow a
// Timestamp.
constexpr double kLongest = 1e7;

struct Count {
  std::size_t points;
  const layout::Layout* layout;
};
const std::array<Count, 6> kCounts{{{17, &layout::kCoco17},
                                    {18, &layout::kCoco18},
                                    {25, &layout::kBody25},
                                    {26, &layout::kHalpe26},
                                    {133, &layout::kCoco17},
                                    {136, &layout::kHalpe26}}};

Result<PosePerson> checked(PosePerson person, const std::string& at) {
  if (layout_of(person) != nullptr) return person;
  return fail(ErrorCode::Unsupported, at,
              fmt::format("has {} landmarks; known are 17 (COCO), 18 (COCO of OpenPose), 25 "
                          "(BODY_25), 26 (HALPE), 133 and 136 (their whole bodies).",
                          person.points.size()));
}

double confidence_of(double value) { return std::clamp(value, 0.0, 1.0); }

/// A tracker's id plus 1.  The file has a number, or an array with one; none if it is negative or
/// absurdly large.
std::optional<std::uint64_t> id_in(const json& person) {
  for (const char* key : {"person_id", "track_id"}) {
    const auto found = person.find(key);
    if (found == person.end()) continue;
    const json& value = found->is_array() && found->size() == 1 ? (*found)[0] : *found;
    if (value.is_number_unsigned() && value.get<std::uint64_t>() < kMostId)
      return value.get<std::uint64_t>() + 1;  // ours begin at 1
  }
  return std::nullopt;
}

/// A landmark; not seen where a number is NaN, or at the pixel 0, 0.
PosePoint point_of(double u, double v, double confidence, Pictures& out) {
  if (std::isnan(u + v + confidence)) return {};
  if (u == 0.0 && v == 0.0) {
    if (confidence > 0.0) ++out.at_origin;
    return {};
  }
  return {{u, v}, confidence_of(confidence)};
}

Result<PosePerson> read_flat(const json& numbers, const std::string& at, Pictures& out) {
  constexpr std::size_t kEach = 3;
  if (!numbers.is_array() || numbers.size() % kEach != 0)
    return fail(ErrorCode::Malformed, at, "must be u, v and confidence of each landmark.");
  std::vector<double> values(numbers.size());
  if (const auto read = read_numbers_or_null(numbers, values, kMaxPixel, at); !read)
    return pass(read);
  PosePerson person;
  for (std::size_t i = 0; i < values.size(); i += kEach)
    person.points.push_back(point_of(values[i], values[i + 1], values[i + 2], out));
  return checked(std::move(person), at);
}

Result<PosePerson> read_pairs(const json& instance, const std::string& at, Pictures& out) {
  const auto points = member(instance, "keypoints", at);
  if (!points) return pass(points);
  const auto scores = member(instance, "keypoint_scores", at);
  if (!scores) return pass(scores);
  if (!(*points)->is_array())
    return fail(ErrorCode::Malformed, at, "\"keypoints\" must be an array.");
  std::vector<double> confidence((*points)->size());
  if (const auto read =
          read_numbers_or_null(**scores, confidence, kMaxConfidence, at + ".keypoint_scores");
      !read)
    return pass(read);
  PosePerson person;
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    std::array<double, 2> pixel{};
    const auto read = read_numbers_or_null((**points)[i], pixel, kMaxPixel, at + ".keypoints");
    if (!read) return pass(read);
    person.points.push_back(point_of(pixel[0], pixel[1], confidence[i], out));
  }
  return checked(std::move(person), at);
}

/// The member with u, v and confidence of each landmark in a row; none if there is no such one.
const json* flat_in(const json& person) {
  for (const char* key : {"pose_keypoints_2d", "joints", "keypoints"}) {
    const auto found = person.find(key);
    if (found == person.end() || !found->is_array()) continue;
    if (!found->empty() && found->front().is_array()) continue;  // MMPose's pairs
    return &*found;
  }
  return nullptr;
}

Result<PosePerson> read_person(const json& person, const std::string& at, Pictures& out) {
  if (!person.is_object()) return fail(ErrorCode::Malformed, at, "must be an object.");
  const json* flat = flat_in(person);
  auto read = flat != nullptr ? read_flat(*flat, at, out) : read_pairs(person, at, out);
  if (read) read->id = id_in(person);
  return read;
}

/// True for a person without any landmark: Pose2Sim's association writes `{}` for who is absent.
bool is_absent(const json& person) {
  if (person.is_null() || (person.is_object() && person.empty())) return true;
  const json* flat = person.is_object() ? flat_in(person) : nullptr;
  return flat != nullptr && flat->empty();
}

/// Adds a person to `people`, or counts why not.  TooLarge or Unsupported when the layout is
/// unknown to us, which is then that of the whole file.
Result<void> add_person(const json& person, const std::string& at, Pictures& out, People& people) {
  if (people.size() >= kMaxBodies) return {};
  if (is_absent(person)) {
    ++out.without_landmarks;
    return {};
  }
  auto read = read_person(person, at, out);
  if (!read && read.error().code == ErrorCode::Unsupported) return pass(read);
  if (read) {
    people.push_back(std::move(*read));
  } else if (out.unreadable++ == 0) {
    out.first_unreadable = to_string(read.error());
  }
  return {};
}

Result<People> read_people(const json& list, const std::string& at, Pictures& out) {
  if (!list.is_array()) return fail(ErrorCode::Malformed, at, "must be an array of people.");
  People people;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (auto ok = add_person(list[i], fmt::format("{}[{}]", at, i), out, people); !ok)
      return pass(ok);
  }
  return people;
}

/// The list of pictures in a video's file; none if the document describes a single picture.
const json* pictures_in(const json& document) {
  const json* list = &document;
  if (document.is_object()) {
    const auto found = document.find("instance_info");
    if (found == document.end()) return nullptr;
    list = &*found;
  }
  const bool numbered = list->is_array() && !list->empty() && list->front().is_object() &&
                        list->front().contains("instances");
  return numbered ? list : nullptr;
}

Result<void> read_video(const json& list, const std::string& at, Pictures& out) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string here = fmt::format("{}: [{}]", at, i);
    const auto instances = member(list[i], "instances", here);
    if (!instances) return pass(instances);
    auto people = read_people(**instances, here + ".instances", out);
    if (!people) return pass(people);
    const auto number = list[i].find("frame_id");
    const bool numbered = number != list[i].end() && number->is_number_unsigned();
    const auto added =
        out.add(numbered ? number->get<std::uint64_t>() : i, std::move(*people), here);
    if (!added) return pass(added);
  }
  return {};
}

/// The pictures of a list of people who name theirs, as COCO's results and AlphaPose's do.
bool names_pictures(const json& list) {
  return list.is_array() && !list.empty() && list.front().is_object() &&
         list.front().contains("image_id");
}

std::string picture_name(const json& id) {
  return id.is_string() ? fs::path(id.get<std::string>()).stem().string() : id.dump();
}

/// The number of each picture by its name.  `names` are all names, without repetition.
std::map<std::string, std::uint64_t> numbers_by_name(std::vector<std::string> names,
                                                     Pictures& into) {
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const auto numbers = picture_numbers(names);
  std::map<std::string, std::uint64_t> out;
  for (std::size_t i = 0; i < names.size(); ++i) out.emplace(names[i], numbers.numbers[i]);
  into.by_order = into.by_order || numbers.by_order;
  return out;
}

/// "image_id" of COCO's annotations -> name of the picture's file; empty for lists of results.
using FileNames = std::map<std::string, std::string>;

Result<void> read_coco(const json& list, const FileNames& files, const std::string& at,
                       Pictures& out) {
  std::map<std::string, People> by_picture;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string here = fmt::format("{}: [{}]", at, i);
    const auto id = member(list[i], "image_id", here);
    if (!id) return pass(id);
    const std::string name = picture_name(**id);
    const auto file = files.find(name);
    People& people = by_picture[file == files.end() ? name : file->second];
    if (auto ok = add_person(list[i], here, out, people); !ok) return ok;
  }
  std::vector<std::string> names;
  for (const auto& [name, people] : by_picture) names.push_back(name);
  const auto numbers = numbers_by_name(std::move(names), out);
  for (auto& [name, people] : by_picture) {
    if (auto ok = out.add(numbers.at(name), std::move(people), at); !ok) return ok;
  }
  return {};
}

FileNames file_names(const json& document) {
  FileNames files;
  const auto images = document.find("images");
  if (images == document.end() || !images->is_array()) return files;
  for (const json& image : *images) {
    if (!image.is_object() || !image.contains("id") || !image.contains("file_name")) continue;
    files.emplace(picture_name(image["id"]), picture_name(image["file_name"]));
  }
  return files;
}

/// True for AlphaPose's documents in which each member is a picture: {"7.jpg": {"people": ...}}.
bool is_by_picture(const json& document) {
  return document.is_object() && !document.empty() &&
         std::all_of(document.begin(), document.end(), [](const json& each) {
           return each.is_object() && (each.contains("people") || each.contains("bodies"));
         });
}

Result<void> read_by_picture(const json& document, const std::string& at, Pictures& out) {
  std::vector<std::string> names;
  for (const auto& [name, each] : document.items()) names.push_back(fs::path(name).stem().string());
  const auto numbers = numbers_by_name(std::move(names), out);
  for (const auto& [name, each] : document.items()) {
    const json& people = each.contains("people") ? each["people"] : each["bodies"];
    auto read = read_people(people, at + ": " + name, out);
    if (!read) return pass(read);
    const std::uint64_t number = numbers.at(fs::path(name).stem().string());
    if (auto ok = out.add(number, std::move(*read), at); !ok) return ok;
  }
  return {};
}

}  // namespace

const layout::Layout* layout_of(const PosePerson& person) {
  const auto found = std::find_if(kCounts.begin(), kCounts.end(), [&](const Count& each) {
    return each.points == person.points.size();
  });
  return found == kCounts.end() ? nullptr : found->layout;
}

Result<void> Pictures::add(std::uint64_t number, People&& found, const std::string& at) {
  if (!(static_cast<double>(number) <= kLongest * rate_hz))
    return fail(
        ErrorCode::Malformed, at,
        fmt::format("is picture {}, which is more than {:g} s from the first.", number, kLongest));
  if (people.try_emplace(number, std::move(found)).second) return {};
  return fail(ErrorCode::Conflict, at,
              fmt::format("is picture {}, and another one is that too; each picture of a camera "
                          "needs a number of its own, and each camera a folder.",
                          number));
}

Result<void> read_pose_document(const fs::path& file, std::uint64_t number,
                                const ImportLimits& limits, Pictures& out) {
  const std::string at = file.string();
  const auto document = read_json(file, limits.max_json_bytes, Nan::IsNull);
  if (!document) return pass(document);
  if (const json* pictures = pictures_in(*document)) return read_video(*pictures, at, out);
  if (names_pictures(*document)) return read_coco(*document, {}, at, out);
  if (document->is_object() && document->contains("annotations") &&
      names_pictures((*document)["annotations"]))
    return read_coco((*document)["annotations"], file_names(*document), at, out);
  if (is_by_picture(*document)) return read_by_picture(*document, at, out);
  const json* people = &*document;
  if (document->is_object()) {
    const auto listed = member(*document, "people", at);
    if (!listed) return pass(listed);
    people = *listed;
  }
  const std::size_t unreadable = out.unreadable;
  auto read = read_people(*people, at + ": people", out);
  if (!read) return pass(read);
  if (read->empty() && out.unreadable > unreadable)
    return fail(ErrorCode::Malformed, at, out.first_unreadable);
  return out.add(number, std::move(*read), at);
}

}  // namespace chorus::importers
