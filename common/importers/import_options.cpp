#include "common/importers/import_options.h"

#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "common/importers/text_rows.h"

namespace chorus::importers {
namespace {

// Read, so that a plane in millimetres can be told from a text that is no plane.
constexpr double kBeyondAnyPlane = 1e6;
constexpr std::size_t kMaxIdBytes = 64;  // as in SensorId::parse

bool is_id_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

}  // namespace

Result<SensorId> sensor_named_after(const std::filesystem::path& file) {
  std::string name = file.stem().string().substr(0, kMaxIdBytes);
  for (char& c : name) {
    if (!is_id_character(c)) c = '-';
  }
  return SensorId::parse(name);
}

Result<SensorId> sensor_for(const std::filesystem::path& file, const ImportOptions& options) {
  if (options.sensor) return *options.sensor;
  return sensor_named_after(file);
}

Result<FloorPlane> parse_floor(std::string_view text) {
  const LineReader at(text, "floor plane");
  const auto row = Row::split(at, text, ',', 4);
  std::array<double, 4> p{};
  const bool readable = row && row->numbers(0, p, kBeyondAnyPlane);
  if (!readable)
    return fail(ErrorCode::InvalidArgument, "floor plane",
                "must be four numbers a,b,c,d of the plane a x + b y + c z + d = 0 in sensor space "
                "[m], such as 0,0.98,0.17,1.8.");
  auto plane = make_plane(p[0], p[1], p[2], p[3]);
  if (plane && std::abs(plane->offset) > kMaxImported)
    return fail(ErrorCode::InvalidArgument, "floor plane",
                fmt::format("puts the sensor {:.0f} m above the floor; is that in millimetres?",
                            std::abs(plane->offset)));
  // A sensor stands above its floor, however it hangs; a ceiling's may look beyond straight down.
  if (plane && (plane->offset < 0 || (plane->offset == 0 && plane->normal.y() < 0))) {
    plane->normal = -plane->normal;
    plane->offset = -plane->offset;
  }
  return plane;
}

}  // namespace chorus::importers
