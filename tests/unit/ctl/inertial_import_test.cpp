// chorus import inertial: logs of worn sensors become a recording that is read again.
#include "services/ctl/convert/inertial_import.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/record/cell_reader.h"
#include "services/ctl/evaluate/inertial_files.h"
#include "tests/support/builders.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using testing::bytes_of;
using ::testing::HasSubstr;

class ImportedLogs : public ::testing::Test {
 protected:
  ImportedLogs() {
    std::string table =
        "DataRate=50\nDataType=Quaternion\nversion=3\nendheader\ntime\ttibia_l_imu\tpelvis_imu\n";
    for (int i = 0; i < 200; ++i)
      table += fmt::format("{:.2f}\t1,0,0,0\t{:.6f},0,{:.6f},0\n", 0.02 * i, std::cos(0.01 * i),
                           std::sin(0.01 * i));
    sto_ = folder_.write("walk.sto", table).string();
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  chorus::testing::TemporaryFolder folder_;
  std::string sto_;
};

TEST_F(ImportedLogs, BecomeARecordingOfOneSuit) {
  const Outcome done = run_chorus(
      {"import", "inertial", sto_, "--out", at("rec"), "--start", "2026-11-21T07:30:00Z"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.out,
              HasSubstr("suit: 2 sensors, 200 instants, 3.98 s from 2026-11-21T07:30:00"));
  const auto cell = record::read_cell(at("rec/suit.mcap"), {.inertial = true});
  ASSERT_TRUE(cell) << to_string(cell.error());
  const auto& instants = cell->inertial.at(chorus::testing::sensor_id("suit")).instants;
  ASSERT_EQ(instants.size(), 200u);
  EXPECT_EQ(instants[50].captured, chorus::testing::kStart + std::chrono::seconds(1));
  EXPECT_EQ(instants[50].readings.size(), 2u);
  const auto logs = read_inertial_files({at("rec/suit.mcap")}, {});
  ASSERT_TRUE(logs) << to_string(logs.error());
  ASSERT_EQ(logs->size(), 2u);
  EXPECT_EQ(logs->at(1).sensor, "tibia_l_imu");
  EXPECT_EQ(logs->at(1).readings.front().limb, inertial::Limb::ShankLeft);
  EXPECT_NEAR(logs->at(0).rate_hz, 50.0, 0.01);
}

TEST_F(ImportedLogs, GiveTheSameBytesAgain) {
  const std::vector<std::string> line{"import",  "inertial", sto_, "--out",
                                      at("rec"), "--sensor", "w"};
  ASSERT_EQ(run_chorus(line).code, kExitOk);
  const std::string first = bytes_of(at("rec/w.mcap"));
  ASSERT_EQ(run_chorus(line).code, kExitOk) << "an import may be repeated";
  EXPECT_EQ(bytes_of(at("rec/w.mcap")), first);
}

TEST_F(ImportedLogs, WithoutADateBeginAsAllImportsDo) {
  const Outcome done = run_chorus({"import", "inertial", sto_, "--out", at("rec")});
  EXPECT_THAT(done.out, HasSubstr("from 2020-01-01T00:00:00"));
}

TEST_F(ImportedLogs, OfACutFileSayThatALineIsShort) {
  (void)folder_.write("cut.sto", bytes_of(sto_).substr(0, bytes_of(sto_).find("0.02") + 12));
  const Outcome cut = run_chorus({"import", "inertial", at("cut.sto"), "--out", at("rec")});
  EXPECT_THAT(cut.error, HasSubstr("has nothing for column pelvis_imu: the line is too short"));
  EXPECT_THAT(cut.error, ::testing::Not(HasSubstr("with angles")));
}

TEST_F(ImportedLogs, AreRefusedWithWhatToChange) {
  const Outcome floor =
      run_chorus({"import", "inertial", sto_, "--out", at("rec"), "--floor", "0,1,0,0"});
  EXPECT_EQ(floor.code, kExitFailed);
  EXPECT_THAT(floor.error, HasSubstr("--sensor and --start only"));
  const Outcome twice = run_chorus({"import", "inertial", sto_, sto_, "--out", at("rec")});
  EXPECT_THAT(twice.error, HasSubstr("give each sensor a name of its own"));
  const Outcome empty = run_chorus({"import", "inertial", at("none.sto"), "--out", at("rec")});
  EXPECT_EQ(empty.code, kExitFailed);
  (void)folder_.write("odd.dat", "1 2 3");
  EXPECT_THAT(run_chorus({"import", "inertial", at("odd.dat"), "--out", at("rec")}).error,
              HasSubstr(".mcap (a recording)"));
}

}  // namespace
}  // namespace chorus::ctl
