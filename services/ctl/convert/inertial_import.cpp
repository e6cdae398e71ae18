#include "services/ctl/convert/inertial_import.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/importers/import_options.h"
#include "common/record/cell_writer.h"
#include "services/ctl/convert/import_output.h"
#include "services/ctl/evaluate/inertial_files.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using inertial::InertialFrame;

/// As a service would have sent them: at most fifty documents a second.
constexpr Duration kBatch = std::chrono::milliseconds(20);

void shift(std::vector<InertialFrame>& instants, Duration by) {
  for (InertialFrame& instant : instants) {
    instant.captured += by;
    instant.received += by;
    for (inertial::InertialReading& reading : instant.readings) reading.captured += by;
  }
}

/// When the first instant shall be: as stated, and where times count from zero, as in all imports.
std::optional<Timestamp> first_instant(Timestamp found, std::optional<Timestamp> stated) {
  constexpr Duration kNoDate = std::chrono::hours(24 * 365);  // after 1970
  if (stated || found.time_since_epoch() > kNoDate) return stated;
  return importers::ImportOptions{}.start;
}

Result<void> write_batch(record::CellWriter& writer, const SensorId& source,
                         std::vector<InertialFrame> batch, std::uint64_t sequence) {
  auto document = std::make_shared<resource::OrientationsResource>();
  document->sequence = sequence;
  document->captured = batch.back().captured;
  document->source = source.str();
  document->instants = std::move(batch);
  const Timestamp received = document->captured;
  return writer.write(
      record::RawOrientations{source, std::move(document), received,
                              record::ClockModel{Duration{0}, Duration{0}, Duration{0}}});
}

Result<void> write_recording(const ImportedSuit& suit) {
  record::CellHead head;
  head.metadata["title"] = "inertial sensors of " + suit.source.str();
  auto writer = record::CellWriter::create(suit.file, head);
  if (!writer) return pass(writer);
  std::vector<InertialFrame> batch;
  std::uint64_t sequence = 0;
  for (const InertialFrame& instant : suit.instants) {
    const bool full = !batch.empty() && (batch.size() >= resource::kMaxInstants ||
                                         instant.captured - batch.front().captured >= kBatch);
    if (full) {
      auto ok = write_batch(*writer, suit.source, std::exchange(batch, {}), ++sequence);
      if (!ok) return ok;
    }
    batch.push_back(instant);
  }
  auto ok = write_batch(*writer, suit.source, std::move(batch), ++sequence);
  if (!ok) return ok;
  return writer->close();
}

}  // namespace

Result<ImportedSuit> import_inertial(const std::vector<std::string>& files, const fs::path& folder,
                                     const InertialImport& how) {
  auto logs = read_inertial_files(files, {});
  if (!logs) return pass(logs);
  std::ranges::sort(*logs, {}, &inertial::SensorLog::sensor);
  auto instants = inertial::frames_of(*logs, how.source);
  if (!instants) return pass(instants);
  if (instants->empty())
    return fail(ErrorCode::NotFound, files.front(), "holds no reading of a sensor");
  if (const auto start = first_instant(instants->front().captured, how.start))
    shift(*instants, *start - instants->front().captured);
  ImportedSuit suit{
      folder / (how.source.str() + ".mcap"), how.source, std::move(*instants), {}, {}};
  for (const inertial::SensorLog& log : *logs) {
    suit.sensors.push_back(log.sensor);
    for (const std::string& note : log.notes)
      suit.notes.push_back("sensor " + log.sensor + ": " + note);
  }
  for (std::string& note : inertial::heading_notes(*logs)) suit.notes.push_back(std::move(note));
  if (auto ok = make_room_for(suit.file); !ok) return pass(ok);
  if (auto ok = write_recording(suit); !ok) return pass(ok);
  return suit;
}

void print_imported(const ImportedSuit& suit, bool json) {
  for (const std::string& note : suit.notes) std::cerr << "note: " << note << '\n';
  const Timestamp first = suit.instants.front().captured;
  const Timestamp last = suit.instants.back().captured;
  if (!json) {
    std::cout << fmt::format("{}: {} sensors, {} instants, {:.2f} s from {}\nwrote {}\n",
                             suit.source.str(), suit.sensors.size(), suit.instants.size(),
                             seconds(last - first), to_iso8601(first), suit.file.string());
    return;
  }
  const nlohmann::json told{{"files", {suit.file.string()}},
                            {"source", suit.source.str()},
                            {"sensors", suit.sensors},
                            {"instants", suit.instants.size()},
                            {"first", to_iso8601(first)},
                            {"last", to_iso8601(last)},
                            {"notes", suit.notes}};
  std::cout << told.dump(2) << '\n';
}

}  // namespace chorus::ctl
