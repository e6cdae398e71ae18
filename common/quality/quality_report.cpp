#include "common/quality/quality_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace chorus::quality {
namespace {

using report::Figure;
using report::Judgement;
using report::Plot;
using report::readable;
using report::Section;
using report::Table;

std::string percent(double share) { return fmt::format("{:.1f} %", 100.0 * share); }
std::string in_millimetres(double metres) {
  return std::isfinite(metres) ? readable(1e3 * metres) : "-";
}

Figure measured(std::string key, std::string name, double value, std::string unit,
                std::string meaning) {
  Figure out{std::move(key), std::move(name)};
  out.value = value;
  out.unit = std::move(unit);
  out.meaning = std::move(meaning);
  return out;
}

Section overview(const RecordingQuality& quality) {
  const FusedQuality& fused = quality.fused;
  Section section{"overview", "Overview"};
  section.figures = {
      measured("seconds", "length", fused.seconds, "s", "from the first to the last fused frame"),
      measured("rate", "output rate", fused.rate, "Hz", "by the usual step between frames"),
      measured("pauses", "pauses", fused.pauses, "", "steps longer than three usual ones"),
      measured("longest_pause", "longest pause", fused.longest_pause, "s", ""),
      measured("with_people", "frames with somebody", 100.0 * fused.with_people, "%", ""),
      measured("people", "ids", static_cast<double>(fused.people.size()), "",
               "people, and those who came back under a new id"),
      measured("switches", "ids handed on", static_cast<double>(fused.switches.size()), "",
               "an id ended and another one began within 1 s and 0.7 m"),
      measured("doubles", "people published twice", static_cast<double>(fused.doubles.size()), "",
               "two bodies within 0.25 m for more than 0.5 s"),
      measured("turned", "exchanges of left and right", static_cast<double>(fused.turned.size()),
               "", "hips or shoulders turned by more than 120 deg within 0.2 s")};
  return section;
}

Section findings_section(const std::vector<Finding>& findings) {
  Section section{"findings", "Findings"};
  if (findings.empty()) section.paragraphs = {"Nothing is wrong by these figures."};
  for (std::size_t i = 0; i < findings.size(); ++i) {
    Figure each{"finding_" + std::to_string(i + 1), findings[i].what};
    each.text = report::name_of(findings[i].judgement);
    each.judgement = findings[i].judgement;
    each.advice = findings[i].advice;
    section.figures.push_back(std::move(each));
  }
  return section;
}

std::vector<std::string> joint_row(std::string_view name, const JointQuality& joint,
                                   double error_by_views) {
  return {std::string(name),
          percent(joint.tracked),
          percent(joint.inferred),
          percent(joint.missing),
          percent(joint.unseen),
          percent(joint.carried),
          std::to_string(joint.gaps),
          readable(joint.longest_gap),
          readable(joint.longest_gap_at),
          readable(joint.sensors),
          in_millimetres(joint.jitter_at_rest),
          in_millimetres(joint.jitter_in_motion),
          in_millimetres(joint.stated),
          in_millimetres(error_by_views),
          std::to_string(joint.jumps)};
}

Section joints(const RecordingQuality& quality) {
  const FusedQuality& fused = quality.fused;
  Section section{"joints", "Joints"};
  section.paragraphs = {
      "Shares are of the instants in which a person is present. A guessed joint is where it is "
      "expected while no sensor sees it. A carried joint is where it is "
      "expected while nobody sees the person. Jitter is the noise per axis, by second differences "
      "at "
      "rest (below 0.1 m/s) and third ones in motion. Stated is the standard deviation per axis "
      "that the tracker gives; it covers slow errors too, so it should be larger than jitter at "
      "rest. The error by views is how large the error is by the disagreement of the sensors; what "
      "all of them get wrong alike does not show in it."};
  Table table{"",
              {"joint", "tracked", "inferred", "missing", "guessed", "carried", "gaps",
               "longest [s]", "at [s]", "sensors", "jitter at rest [mm]", "in motion [mm]",
               "stated [mm]", "error by views [mm]", "jumps"},
              {}};
  Plot plot{"Missing and inferred", {"joint"}, {"share [%]"}};
  report::Series missing{"missing", report::Mark::Bars};
  report::Series inferred{"inferred", report::Mark::Bars};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const JointQuality& joint = fused.joints[j];
    table.rows.push_back(joint_row(kJointNames[j], joint, quality.views[j].found));
    missing.x.push_back(static_cast<double>(j));
    missing.y.push_back(100.0 * joint.missing);
    inferred.x.push_back(static_cast<double>(j));
    inferred.y.push_back(100.0 * joint.inferred);
    plot.x.categories.push_back(std::to_string(j));
  }
  plot.x.label = "number of the joint, in the order of the table";
  plot.series = {missing, inferred};
  section.tables = {table};
  section.plots = {plot};
  return section;
}

Section people(const FusedQuality& fused) {
  Section section{"people", "People"};
  Table table{"",
              {"id", "from [s]", "to [s]", "present [s]", "least certain sides", "uncertain sides",
               "bones vary by"},
              {}};
  for (const PersonQuality& person : fused.people) {
    double worst = 0.0;
    std::string bone = "-";
    for (std::size_t b = 0; b < kBones.size(); ++b) {
      if (!(person.bones[b].variation > worst)) continue;
      worst = person.bones[b].variation;
      bone = fmt::format("{} ({} to {})", percent(worst), name_of(kBones[b].parent),
                         name_of(kBones[b].child));
    }
    table.rows.push_back({std::to_string(person.id), readable(person.from), readable(person.to),
                          readable(person.seconds), percent(person.least_certain_sides),
                          percent(person.uncertain_sides), bone});
  }
  section.tables = {table};
  Table moments{"Moments to look at", {"at [s]", "person", "what"}, {}};
  for (const auto* list : {&fused.switches, &fused.doubles, &fused.turned})
    for (const Moment& moment : *list)
      moments.rows.push_back({readable(moment.at), std::to_string(moment.person), moment.what});
  if (!moments.rows.empty()) section.tables.push_back(moments);
  return section;
}

Section sensors(const RecordingQuality& quality) {
  Section section{"sensors", "Sensors"};
  section.paragraphs = {
      "The residual is how far a sensor's tracked joints are from the fused ones. The fused body "
      "contains the sensor, so a residual shows who disagrees, not who is right. Moved is by how "
      "much the "
      "middle of its views changed from the first to the last third of the recording; clock by how "
      "much its capture times are late, from residuals along the motion."};
  Table table{"",
              {"sensor", "frames/s", "longest silence [s]", "late 95 % [ms]", "sees somebody",
               "share", "residual [mm]", "90 % [mm]", "below 2 m, 2-3, 3-4, farther [mm]",
               "moved [mm]", "beside [mm]", "clock [ms]", "exchanged sides", "repeated"},
              {}};
  for (const auto& [id, sensor] : quality.sensors) {
    const auto share = quality.fused.shares.find(id.str());
    std::string distances;
    for (const double residual : sensor.by_distance)
      distances += (distances.empty() ? "" : ", ") + in_millimetres(residual);
    table.rows.push_back(
        {id.str(), readable(sensor.rate), readable(sensor.longest_silence),
         readable(1e3 * sensor.lateness), percent(sensor.sees),
         share == quality.fused.shares.end() ? "-" : percent(share->second),
         in_millimetres(sensor.residual), in_millimetres(sensor.residual_p90), distances,
         in_millimetres((sensor.offset_last - sensor.offset_first).norm()),
         in_millimetres(sensor.offset_in_sensor.norm()), readable(1e3 * sensor.clock),
         percent(sensor.exchanged), percent(sensor.repeated)});
  }
  section.tables = {table};
  return section;
}

std::string sentence(const std::vector<Finding>& findings) {
  if (findings.empty()) return "usable: nothing is wrong by these figures";
  const bool bad = findings.front().judgement == Judgement::Bad;
  std::string out = bad ? "not usable as it is: " : "usable, with care: ";
  for (std::size_t i = 0; i < std::min(findings.size(), kMostInVerdict); ++i)
    out += (i == 0 ? "" : "; ") + findings[i].what;
  if (findings.size() > kMostInVerdict)
    out += fmt::format("; and {} more", findings.size() - kMostInVerdict);
  return out;
}

}  // namespace

report::Report report_of(const RecordingQuality& quality) {
  const std::vector<Finding> findings = findings_of(quality);
  report::Report out{"recording", "Quality of " + quality.name};
  out.judgement = findings.empty() ? Judgement::Good : findings.front().judgement;
  out.verdict = sentence(findings);
  out.subject = {{"recording", quality.name},
                 {"registration", quality.verdict.empty() ? "not recorded" : quality.verdict}};
  for (const std::string& remark : remarks_of(quality)) out.subject.emplace_back("remark", remark);
  for (const std::string& note : quality.notes) out.subject.emplace_back("note", note);
  out.sections = {findings_section(findings), overview(quality), joints(quality),
                  people(quality.fused)};
  if (!quality.sensors.empty()) out.sections.push_back(sensors(quality));
  return out;
}

}  // namespace chorus::quality
