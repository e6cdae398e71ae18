#include "common/motion/mvnx.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <expat.h>

#include "common/geometry/rotation.h"
#include "common/motion/text_lines.h"
#include "common/sensor/limits.h"

namespace chorus::motion {
namespace {

constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxElementText = 1u << 20;  // a frame's positions take about 2 kB
constexpr std::size_t kMaxPointsPerSegment = 256;
constexpr double kMaxRateHz = 1e4;

/// The numbers in an element, in groups of `width`; none if a group is incomplete or a word is not
/// a number.
std::optional<std::vector<double>> numbers_in(std::string_view text, std::size_t width) {
  constexpr std::string_view kXmlBlanks = " \t\r\n";
  std::vector<double> numbers;
  while (true) {
    const std::size_t begin = text.find_first_not_of(kXmlBlanks);
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find_first_of(kXmlBlanks), text.size());
    double number = 0;
    if (!read_finite(text.substr(0, end), number)) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(end);
  }
  if (numbers.size() % width != 0) return std::nullopt;
  return numbers;
}

class MvnxReader {
 public:
  explicit MvnxReader(std::string_view origin)
      : origin_(origin), parser_(XML_ParserCreate(nullptr), &XML_ParserFree) {}
  Result<Mvnx> read(std::string_view xml);

 private:
  static void on_start(void* self, const XML_Char* name, const XML_Char** attributes);
  static void on_end(void* self, const XML_Char* name);
  static void on_text(void* self, const XML_Char* text, int length);
  static void on_entity(void* self, const XML_Char*, int, const XML_Char*, int, const XML_Char*,
                        const XML_Char*, const XML_Char*, const XML_Char*);

  void start(std::string_view name, const XML_Char** attributes);
  void start_subject(const XML_Char** attributes);
  void start_frame(const XML_Char** attributes);
  double time_of(const XML_Char** attributes);
  void end(std::string_view name);
  void end_point();
  void end_vectors();
  void end_quaternions(std::vector<Eigen::Quaterniond>& out, std::string_view what);
  void end_frame();
  void stop(ErrorCode code, std::string message);
  /// True within the body's own segments, and not in those of fingers or of objects.
  [[nodiscard]] bool in_body() const {
    return std::find(path_.begin(), path_.end(), "segments") != path_.end();
  }
  [[nodiscard]] std::string place() const;

  std::string origin_;
  std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser_;
  Mvnx mvnx_;
  std::vector<std::string> path_;  ///< Names of the open elements.
  std::string text_;               ///< Text of the innermost element.
  MvnxFrame frame_;
  bool in_frame_ = false;  ///< True in a frame of type "normal".
  std::optional<double> first_index_;
  std::optional<double> first_time_;  ///< [ms]
  std::optional<Error> wrong_;
};

std::string_view attribute(const XML_Char** attributes, std::string_view name) {
  for (std::size_t i = 0; attributes[i] != nullptr; i += 2) {
    if (attributes[i] == name) return attributes[i + 1];
  }
  return {};
}

std::string MvnxReader::place() const {
  return origin_ + ":" + std::to_string(XML_GetCurrentLineNumber(parser_.get()));
}

void MvnxReader::stop(ErrorCode code, std::string message) {
  if (wrong_) return;
  wrong_ = Error{code, place(), std::move(message)};
  XML_StopParser(parser_.get(), XML_FALSE);
}

void MvnxReader::on_start(void* self, const XML_Char* name, const XML_Char** attributes) {
  static_cast<MvnxReader*>(self)->start(name, attributes);
}
void MvnxReader::on_end(void* self, const XML_Char* name) {
  static_cast<MvnxReader*>(self)->end(name);
}
void MvnxReader::on_text(void* self, const XML_Char* text, int length) {
  auto& reader = *static_cast<MvnxReader*>(self);
  reader.text_.append(text, static_cast<std::size_t>(length));
  if (reader.text_.size() > kMaxElementText)
    reader.stop(ErrorCode::TooLarge, "an element holds more than 1 MB of text");
}
void MvnxReader::on_entity(void* self, const XML_Char*, int, const XML_Char*, int, const XML_Char*,
                           const XML_Char*, const XML_Char*, const XML_Char*) {
  static_cast<MvnxReader*>(self)->stop(ErrorCode::Unsupported, "entities are not read");
}

void MvnxReader::start(std::string_view name, const XML_Char** attributes) {
  text_.clear();
  path_.emplace_back(name);
  if (path_.size() > kMaxDepth) return stop(ErrorCode::TooLarge, "elements are nested too deep");
  if (name.starts_with("fingerTracking")) mvnx_.fingers = true;
  if (name == "subject") start_subject(attributes);
  if (name == "frame") start_frame(attributes);
  if (name == "segment" && in_body()) {
    mvnx_.segments.push_back({std::string(attribute(attributes, "label")), {}});
    if (mvnx_.segments.size() > kMaxSegments) stop(ErrorCode::TooLarge, "more than 512 segments");
  }
  if (name == "sensor") {
    mvnx_.sensors.emplace_back(attribute(attributes, "label"));
    if (mvnx_.sensors.size() > kMaxSegments) stop(ErrorCode::TooLarge, "more than 512 sensors");
  }
  if (name == "point" && in_body() && !mvnx_.segments.empty()) {
    auto& points = mvnx_.segments.back().points;
    points.push_back({std::string(attribute(attributes, "label")), Eigen::Vector3d::Zero()});
    if (points.size() > kMaxPointsPerSegment)
      stop(ErrorCode::TooLarge, "more than 256 points on a segment");
  }
}

void MvnxReader::start_subject(const XML_Char** attributes) {
  if (mvnx_.rate_hz != 0)
    return stop(ErrorCode::Unsupported, "a second subject; export one person a file");
  mvnx_.subject = std::string(attribute(attributes, "label"));
  const bool read = read_finite(attribute(attributes, "frameRate"), mvnx_.rate_hz);
  if (!read || !(mvnx_.rate_hz > 0) || mvnx_.rate_hz > kMaxRateHz)
    stop(ErrorCode::Malformed, "the subject has no frameRate above zero");
}

/// Seconds since the first frame: by its index, unless "time" disagrees, which then wins.
double MvnxReader::time_of(const XML_Char** attributes) {
  double index = 0;
  double milliseconds = 0;
  const bool indexed = read_finite(attribute(attributes, "index"), index);
  const bool timed = read_finite(attribute(attributes, "time"), milliseconds);
  if (!first_index_ && indexed) first_index_ = index;
  if (!first_time_ && timed) first_time_ = milliseconds;
  const double by_index = indexed ? (index - *first_index_) / mvnx_.rate_hz : 0.0;
  const double by_time = timed ? (milliseconds - *first_time_) / 1000.0 : 0.0;
  // "time" is cut to milliseconds: where both agree, the index is exact.
  constexpr double kCut = 0.0021;
  if (indexed && (!timed || std::abs(by_index - by_time) < kCut)) return by_index;
  if (timed) return by_time;
  return static_cast<double>(mvnx_.frames.size()) / mvnx_.rate_hz;
}

void MvnxReader::start_frame(const XML_Char** attributes) {
  const std::string_view type = attribute(attributes, "type");
  in_frame_ = type.empty() || type == "normal";
  frame_ = {};
  if (!in_frame_) return;
  if (mvnx_.frames.size() >= kMaxFrames)
    return stop(ErrorCode::TooLarge, "more than 200000 frames");
  frame_.time = time_of(attributes);
}

void MvnxReader::end(std::string_view name) {
  if (wrong_) return;
  if (name == "pos_b" && in_body()) end_point();
  if (in_frame_ && name == "position") end_vectors();
  if (in_frame_ && name == "orientation") end_quaternions(frame_.orientations, "orientation");
  if (in_frame_ && name == "sensorOrientation")
    end_quaternions(frame_.sensor_orientations, "sensorOrientation");
  if (in_frame_ && name == "frame") end_frame();
  text_.clear();
  if (!path_.empty()) path_.pop_back();
}

void MvnxReader::end_point() {
  const auto xyz = numbers_in(text_, 3);
  if (!xyz || xyz->size() != 3 || mvnx_.segments.empty() || mvnx_.segments.back().points.empty())
    return stop(ErrorCode::Malformed, "pos_b must be three numbers within a point");
  mvnx_.segments.back().points.back().in_segment = Eigen::Vector3d(xyz->data());
}

void MvnxReader::end_vectors() {
  const auto numbers = numbers_in(text_, 3);
  if (!numbers) return stop(ErrorCode::Malformed, "a position is not three numbers");
  frame_.positions.clear();
  for (std::size_t i = 0; i < numbers->size(); i += 3) {
    frame_.positions.emplace_back(numbers->data() + i);
    if (frame_.positions.back().cwiseAbs().maxCoeff() > kMaxCoordinate)
      return stop(ErrorCode::Malformed, "a position is farther than 10 km");
  }
}

void MvnxReader::end_quaternions(std::vector<Eigen::Quaterniond>& out, std::string_view what) {
  const auto numbers = numbers_in(text_, 4);
  if (!numbers)
    return stop(ErrorCode::Malformed, "an " + std::string(what) + " is not four numbers");
  out.clear();
  for (std::size_t i = 0; i < numbers->size(); i += 4) {
    const double* wxyz = numbers->data() + i;
    out.emplace_back(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    if (!is_unit(out.back()))
      return stop(ErrorCode::Malformed, "an " + std::string(what) + " is no unit quaternion");
    out.back().normalize();
  }
}

void MvnxReader::end_frame() {
  in_frame_ = false;
  const std::size_t count = mvnx_.segments.size();
  if (count == 0 || frame_.positions.size() != count || frame_.orientations.size() != count)
    return stop(ErrorCode::Malformed, "a frame must hold position and orientation of all " +
                                          std::to_string(count) + " segments");
  mvnx_.frames.push_back(std::move(frame_));
}

Result<Mvnx> MvnxReader::read(std::string_view xml) {
  if (!parser_) return fail(ErrorCode::Internal, origin_, "no memory for a parser");
  XML_SetUserData(parser_.get(), this);
  XML_SetElementHandler(parser_.get(), &on_start, &on_end);
  XML_SetCharacterDataHandler(parser_.get(), &on_text);
  XML_SetEntityDeclHandler(parser_.get(), &on_entity);
  constexpr std::size_t kPiece = 1u << 20;
  while (true) {
    const std::string_view piece = xml.substr(0, kPiece);
    xml.remove_prefix(piece.size());
    const auto status =
        XML_Parse(parser_.get(), piece.data(), static_cast<int>(piece.size()), xml.empty());
    if (wrong_) return tl::unexpected<Error>(*wrong_);
    if (status != XML_STATUS_OK)
      return fail(
          ErrorCode::Malformed, place(),
          std::string("is no complete XML: ") + XML_ErrorString(XML_GetErrorCode(parser_.get())));
    if (xml.empty()) break;
  }
  if (mvnx_.rate_hz == 0) return fail(ErrorCode::Malformed, origin_, "holds no subject");
  if (mvnx_.frames.empty()) return fail(ErrorCode::Malformed, origin_, "holds no normal frame");
  return std::move(mvnx_);
}

}  // namespace

Result<Mvnx> parse_mvnx(std::string_view xml, std::string_view origin) {
  if (xml.size() > kMaxMvnxBytes)
    return fail(ErrorCode::TooLarge, std::string(origin), "the file is larger than 512 MB");
  return MvnxReader(origin).read(xml);
}

}  // namespace chorus::motion
