// chorus align: a fused walk beside what another tracker saw of it.
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/record/recorded_cell.h"
#include "tests/unit/ctl/program_run.h"
#include "tests/unit/ctl/scripted_server.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A walk of 20 s, fused once for all tests in this file.
const Cell& aligned_cell() {
  static const Cell cell(20.0);
  static const Outcome fused =
      run_chorus({"fuse", cell.recordings(), "--out", cell.file("walk.mcap"), "--from-walk"});
  EXPECT_EQ(fused.code, kExitOk) << fused.error;
  return cell;
}

Registration places() {
  return **RecordedCell::open({aligned_cell().file("walk.mcap")})->registration();
}

constexpr double kYaw = deg(30);
const Eigen::Vector3d kPlace(0.7, 0.0, -1.2);

Eigen::Vector3d in_reference(const Eigen::Vector3d& x_in_world) {
  return about_y(kYaw).inverse() * (x_in_world - kPlace);
}

/// Writes what a tracker at (kYaw, kPlace) sees of the heads in the walk, as columns t,x,y,z.
std::string head_file(const char* name, double late = 0.0) {
  const Cell& cell = aligned_cell();
  const std::string exported = cell.file("exported.csv");
  EXPECT_EQ(
      run_chorus({"export", cell.file("walk.mcap"), "--format", "csv", "--out", exported}).code,
      kExitOk);
  std::ofstream file(cell.file(name));
  file << "time,x,y,z\n";
  for (const std::string& line : lines_of(chorus::testing::bytes_of(exported))) {
    if (line.find(",Head,Tracked,") == std::string::npos) continue;
    double frame = 0, time = 0, person = 0, x = 0, y = 0, z = 0;
    char utc[64];
    const int read = std::sscanf(line.c_str(), "%lf,%lf,%63[^,],%lf,Head,Tracked,%lf,%lf,%lf",
                                 &frame, &time, utc, &person, &x, &y, &z);
    EXPECT_EQ(read, 7) << line;
    const Eigen::Vector3d there = in_reference({x, y, z});
    file << fmt::format("{:.6f},{:.6f},{:.6f},{:.6f}\n", time - late, there.x(), there.y(),
                        there.z());
  }
  return cell.file(name);
}

Json aligned(std::vector<std::string> words) {
  words.insert(words.begin(), "align");
  words.emplace_back("--json");
  const Outcome done = run_chorus(words);
  EXPECT_EQ(done.code, kExitOk) << done.error;
  return Json::parse(done.out, nullptr, false);
}

TEST(AlignCommand, FindsTheOriginOfTheOtherTracker) {
  const Json found = aligned({head_file("head.csv"), aligned_cell().file("walk.mcap")});
  EXPECT_NEAR(found.at("origin").at("x"), kPlace.x(), 0.005);
  EXPECT_NEAR(found.at("origin").at("z"), kPlace.z(), 0.005);
  EXPECT_NEAR(found.at("origin").at("yawDegrees"), 30.0, 0.1);
  EXPECT_LT(found.at("walk").at("residuals").at("all").at("medianMillimetres"), 1.0);
}

TEST(AlignCommand, SaysWhatToCall) {
  const Outcome done =
      run_chorus({"align", head_file("head2.csv"), aligned_cell().file("walk.mcap")});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.out, HasSubstr("Head beside the reference"));
  EXPECT_THAT(done.out, HasSubstr("(they are not UTC)"));
  EXPECT_THAT(done.out, HasSubstr("mm above ours, or the marker so far below Head"));
  EXPECT_THAT(done.out, HasSubstr("the same origin and front: chorus origin --x=0."));
}

TEST(AlignCommand, OurOwnExportIsAReferenceToo) {
  head_file("head3.csv");
  const Json found =
      aligned({aligned_cell().file("exported.csv"), aligned_cell().file("walk.mcap")});
  EXPECT_EQ(found.at("walk").at("body"), "Head");
  EXPECT_NEAR(found.at("walk").at("clockOffsetMilliseconds"), 0.0, 1.0);
  EXPECT_NEAR(found.at("origin").at("yawDegrees"), 0.0, 0.05);
}

TEST(AlignCommand, AnotherJointIsNotTakenForTheMarked) {
  const Outcome done = run_chorus(
      {"align", head_file("head4.csv"), aligned_cell().file("walk.mcap"), "--joint", "HandLeft"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("Another joint (--joint)"));
}

TEST(AlignCommand, NamesTheAxesThatWouldFit) {
  const std::string file = aligned_cell().file("turned.csv");
  std::ofstream out(file);
  bool first = true;
  for (const std::string& line : lines_of(chorus::testing::bytes_of(head_file("head5.csv")))) {
    double t = 0, x = 0, y = 0, z = 0;
    if (!first) std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &t, &x, &y, &z);
    out << (first ? line + "\n" : fmt::format("{},{},{},{}\n", t, x, -z, y));
    first = false;
  }
  out.close();
  const std::string walk = aligned_cell().file("walk.mcap");
  const Outcome wrong = run_chorus({"align", file, walk});
  EXPECT_EQ(wrong.code, kExitFailed);
  EXPECT_THAT(wrong.error, HasSubstr("With --axes z-up they fit"));
  EXPECT_NEAR(aligned({file, walk, "--axes", "z-up"}).at("origin").at("yawDegrees"), 30.0, 0.1);
}

TEST(AlignCommand, NamesTheUnitThatWouldFit) {
  const std::string file = aligned_cell().file("millimetres.csv");
  std::ofstream out(file);
  bool first = true;
  for (const std::string& line : lines_of(chorus::testing::bytes_of(head_file("head10.csv")))) {
    double t = 0, x = 0, y = 0, z = 0;
    if (!first) std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &t, &x, &y, &z);
    out << (first ? line + "\n" : fmt::format("{},{},{},{}\n", t, 1e3 * x, 1e3 * y, 1e3 * z));
    first = false;
  }
  out.close();
  const Outcome wrong = run_chorus({"align", file, aligned_cell().file("walk.mcap")});
  EXPECT_EQ(wrong.code, kExitFailed);
  EXPECT_THAT(wrong.error, HasSubstr("With --unit mm they fit"));
}

std::string sensors_file() {
  const std::string file = aligned_cell().file("sensors.csv");
  std::ofstream out(file);
  out << "name,x,y,z,qx,qy,qz,qw\n";
  for (const auto& [sensor, place] : places().sensors) {
    Eigen::Isometry3d pose = place.world_from_sensor;
    if (sensor.str() == "s2") pose.translation() += Eigen::Vector3d(0.0, 0.02, 0.0);
    const Eigen::Vector3d p = in_reference(pose.translation());
    const Eigen::Quaterniond q(about_y(kYaw).inverse() * pose.linear());
    out << fmt::format("{},{},{},{},{},{},{},{}\n", sensor.str(), p.x(), p.y(), p.z(), q.x(), q.y(),
                       q.z(), q.w());
  }
  return file;
}

TEST(AlignCommand, ComparesTheSensorsWithBodiesOnThem) {
  const Json found = aligned({sensors_file(), aligned_cell().file("walk.mcap"), "--sensor-axes"});
  EXPECT_FALSE(found.contains("walk"));
  EXPECT_NEAR(found.at("origin").at("yawDegrees"), 30.0, 0.01);
  ASSERT_EQ(found.at("sensorsFromMaster").size(), 3u);
  for (const Json& each : found.at("sensorsFromMaster")) {
    const bool raised = each.at("sensorId") == "s2";
    const bool master = places().master.str() == "s2";
    EXPECT_NEAR(each.at("horizontalMillimetres"), 0.0, 0.1);
    EXPECT_NEAR(each.at("verticalMillimetres"),
                raised == master ? 0.0
                : master         ? 20.0
                                 : -20.0,
                0.1);
    EXPECT_NEAR(each.at("pitchDegrees"), 0.0, 0.01);
  }
}

TEST(AlignCommand, AppliesOnlyToTheWorldOfTheRecording) {
  const std::string same = wire::write_registration(places());
  const ScriptedServer server(ScriptedServer::Texts{{"/registration", {same}}});
  const std::string file = head_file("head6.csv");
  const std::string walk = aligned_cell().file("walk.mcap");
  const Outcome done = run_chorus({"align", file, walk, "--apply", "--url", server.url()});
  EXPECT_EQ(done.code, kExitOk) << done.error;
  ASSERT_EQ(server.written().size(), 1u);
  EXPECT_THAT(server.written()[0], HasSubstr("POST /registration/origin"));

  for (const bool turned : {false, true}) {
    auto moved = places();
    auto& first = moved.sensors.begin()->second.world_from_sensor;
    if (turned) {
      first.linear() = about_y(deg(0.5)) * first.linear();
    } else {
      first.translation().x() += 0.01;
    }
    const ScriptedServer other(
        ScriptedServer::Texts{{"/registration", {wire::write_registration(moved)}}});
    const Outcome refused = run_chorus({"align", file, walk, "--apply", "--url", other.url()});
    EXPECT_EQ(refused.code, kExitFailed);
    EXPECT_THAT(refused.error, HasSubstr("do not stand where they stood"));
    EXPECT_TRUE(other.written().empty());
  }
}

TEST(AlignCommand, AppliesNothingIfNobodyKnowsWhereTheSensorsStood) {
  const ScriptedServer server(
      ScriptedServer::Texts{{"/registration", {wire::write_registration(places())}}});
  const std::string walk = aligned_cell().file("walk.ndjson");
  ASSERT_EQ(run_chorus({"fuse", aligned_cell().recordings(), "--out", walk, "--from-walk"}).code,
            kExitOk);
  const Outcome refused =
      run_chorus({"align", head_file("head9.csv"), walk, "--apply", "--url", server.url()});
  EXPECT_EQ(refused.code, kExitFailed);
  EXPECT_THAT(refused.error, HasSubstr("name their places with --registration"));
  EXPECT_TRUE(server.written().empty());
}

TEST(AlignCommand, WithoutASourceAsksTheServerOfTheUrl) {
  const Outcome done =
      run_chorus({"align", sensors_file(), "--seconds", "0", "--url", "http://127.0.0.1:1/"});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("127.0.0.1:1"));
}

TEST(AlignCommand, SaysWhatIsMissing) {
  const std::string walk = aligned_cell().file("walk.mcap");
  EXPECT_EQ(run_chorus({"align", "/nothing.csv", walk}).code, kExitFailed);
  EXPECT_EQ(run_chorus({"align", walk, walk}).code, kExitFailed);
  EXPECT_EQ(run_chorus({"align", head_file("head7.csv"), walk, "--joint", "Nose"}).code,
            kExitUsage);
  const Outcome nobody = run_chorus({"align", head_file("head8.csv"), walk, "--body", "Cap"});
  EXPECT_EQ(nobody.code, kExitFailed);
  EXPECT_THAT(nobody.error, HasSubstr("has no body \"Cap\""));
}

}  // namespace
}  // namespace chorus::ctl
