// What inertial sensors said, and their calibration, are recorded and read again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/cell_reader.h"
#include "common/record/recorder.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"

namespace chorus::record {
namespace {

using chorus::testing::IsOk;
using chorus::testing::kStart;
using chorus::testing::sensor_id;
using chorus::testing::TemporaryFolder;
using std::chrono::milliseconds;

/// Two instants in one document, by the clock of the source's host.
RawOrientations said(int number, Duration behind) {
  auto document = std::make_shared<resource::OrientationsResource>();
  document->sequence = static_cast<std::uint64_t>(number);
  document->source = "suit";
  for (const int i : {0, 1}) {
    inertial::InertialFrame& instant = document->instants.emplace_back();
    instant.sequence = static_cast<std::uint64_t>(2 * number + i);
    instant.captured = kStart + milliseconds(20 * number + 10 * i) - behind;
    inertial::InertialReading& one = instant.readings.emplace_back();
    one.sensor = "pelvis";
    one.captured = instant.captured;
    one.inertial_from_sensor = Eigen::Quaterniond::Identity();
  }
  document->captured = document->instants.back().captured;
  return {sensor_id("suit"), document, document->captured + behind + milliseconds(5),
          ClockModel{behind, behind, milliseconds(1)}};
}

CalibrationChanged calibrated() {
  inertial::InertialCalibration calibration{"suit", kStart, {}};
  calibration.sensors.push_back({"pelvis", inertial::Limb::Pelvis, 1.25});
  return {sensor_id("suit"), kStart, calibration};
}

void write_suit(const std::filesystem::path& file) {
  auto writer = CellWriter::create(file, {});
  ASSERT_THAT(writer, IsOk());
  ASSERT_THAT(writer->write(calibrated()), IsOk());
  for (int i = 1; i <= 10; ++i) ASSERT_THAT(writer->write(said(i, milliseconds(400))), IsOk());
  ASSERT_THAT(writer->close(), IsOk());
}

TEST(InertialRecording, GivesEveryInstantAgainByTheRecordersClock) {
  const TemporaryFolder folder;
  write_suit(folder / "suit.mcap");
  const auto cell = read_cell(folder / "suit.mcap", {.inertial = true});
  ASSERT_THAT(cell, IsOk());
  ASSERT_TRUE(cell->inertial.contains(sensor_id("suit")));
  const InertialRecording& suit = cell->inertial.at(sensor_id("suit"));
  ASSERT_EQ(suit.instants.size(), 20u);
  for (std::size_t i = 0; i < suit.instants.size(); ++i) {
    const auto& instant = suit.instants[i];
    EXPECT_EQ(instant.sequence, i + 2);
    EXPECT_EQ(instant.captured, kStart + milliseconds(10) * static_cast<int>(i + 2));
    EXPECT_EQ(instant.readings.at(0).captured, instant.captured);
    EXPECT_EQ(instant.source, sensor_id("suit"));
  }
  ASSERT_EQ(suit.calibrations.size(), 1u);
  EXPECT_DOUBLE_EQ(suit.calibrations[0].sensors.at(0).heading, 1.25);
}

TEST(InertialRecording, IsLeftAloneUnlessAskedFor) {
  const TemporaryFolder folder;
  write_suit(folder / "suit.mcap");
  const auto cell = read_cell(folder / "suit.mcap");
  ASSERT_THAT(cell, IsOk());
  EXPECT_TRUE(cell->inertial.empty());
  EXPECT_TRUE(cell->cell.empty()) << "a suit is no sensor of the cell";
}

TEST(InertialRecording, RecorderCountsItAndBeginsEachFileWithTheCalibration) {
  const TemporaryFolder folder;
  RecorderOptions options;
  options.name = "suit";
  options.folder = folder / "suit";
  options.limits.min_free_bytes = 0;
  options.limits.max_file_bytes = 1;  // Every document begins a new file.
  auto recorder = Recorder::start(options);
  ASSERT_THAT(recorder, IsOk());
  (*recorder)->offer(calibrated());
  for (int i = 1; i <= 3; ++i) (*recorder)->offer(said(i, milliseconds(0)));
  (*recorder)->ask_to_stop();
  ASSERT_TRUE((*recorder)->wait(std::chrono::seconds(20)));
  EXPECT_EQ((*recorder)->report().frames, 3u);
  const auto cell = read_cell(folder / "suit", {.inertial = true});
  ASSERT_THAT(cell, IsOk());
  const InertialRecording& suit = cell->inertial.at(sensor_id("suit"));
  EXPECT_EQ(suit.instants.size(), 6u);
  // The first file begins before there is a calibration, and ends at once.
  EXPECT_EQ(suit.calibrations.size(), (*recorder)->report().files.size() - 1);
}

}  // namespace
}  // namespace chorus::record
