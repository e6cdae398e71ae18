// Reads any bytes as a config file, and as a --set assignment: the result is a value or an Error,
// never a crash, and an accepted value is inside the range it was read with.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/config_reader.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void read_everything(chorus::ConfigReader& reader) {
  bool flag = false;
  int port = 8080;
  double distance = 2.5;
  std::string name;
  std::vector<double> position;
  std::vector<std::string> tags;
  chorus::Duration gap = std::chrono::milliseconds(100);
  double angle = 0.5;
  std::size_t choice = 1;
  reader.read("flag", flag);
  reader.read("port", port, 1, 65535);
  reader.read("distance_m", distance, 0.0, 10.0);
  reader.read("name", name);
  reader.read("position_m", position);
  reader.read("tags", tags);
  reader.read_ms("gap_ms", gap, chorus::Duration::zero(), std::chrono::seconds(1));
  reader.read_deg("angle_deg", angle, -180.0, 180.0);
  reader.read_choice("kind", choice, {"simulated", "replay", "bridge"});
  require(port >= 1 && port <= 65535);
  require(distance >= 0.0 && distance <= 10.0);
  require(gap >= chorus::Duration::zero() && gap <= std::chrono::seconds(1));
  require(std::isfinite(angle) && choice < 3);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  // The first line is an assignment, the rest the file.
  const std::size_t line = text.find('\n');
  const std::string_view assignment = text.substr(0, line);
  const std::string_view file = line == std::string_view::npos ? text : text.substr(line + 1);
  auto root = chorus::ConfigReader::parse(file, "fuzz.json");
  if (!root) return 0;
  (void)root->set(assignment);
  read_everything(*root);
  auto nested = root->child("quality");
  read_everything(nested);
  for (chorus::ConfigReader& item : root->items("sensors")) read_everything(item);
  const auto verdict = root->finish();
  require(verdict.has_value() || !verdict.error().message.empty());
  return 0;
}
