#include "common/motion/joint_names.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "common/motion/text_lines.h"

namespace chorus::motion {
namespace {

constexpr auto kSure = JointState::Tracked;
constexpr auto kGuess = JointState::Inferred;

enum class Use {
  Any,      ///< The first of the names that is there.
  All,      ///< The mean of all names, if all are there.
  Markers,  ///< As All; the names are canonical names of skin markers (kMarkers).
};

/// In `names`, "<stem" has the side of the joint, "l.stem" and "r.stem" state theirs, and ".stem"
/// has none.
struct NameRow {
  JointId left;  ///< For a joint without sides, the joint itself.
  JointId right;
  JointState state;
  Use use;
  std::string_view names;
};

// In order of preference: a joint uses the first row that applies.  A knee comes before the hip,
// an elbow before the shoulder, since "LeftLeg" and "LeftArm" are the lower or the upper part,
// depending on what else the file has.
// clang-format off
constexpr NameRow kRows[] = {
    {JointId::KneeLeft, JointId::KneeRight, kSure, Use::Any, "<kjc <feo"},
    {JointId::KneeLeft, JointId::KneeRight, kGuess, Use::Markers, "<kne <knm"},
    {JointId::KneeLeft, JointId::KneeRight, kSure, Use::Any,
     "<lowerleg <lowleg <calf <shin <shank <knee <tibia <leglower <kneejoint <crus <leg"},
    {JointId::KneeLeft, JointId::KneeRight, kGuess, Use::Markers, "<kne"},
    {JointId::HipLeft, JointId::HipRight, kSure, Use::Any, "<hjc <fep"},
    {JointId::HipLeft, JointId::HipRight, kSure, Use::Any,
     "<upleg <upperleg <thigh <femur <legupper <hip <hipjoint <leg"},
    {JointId::AnkleLeft, JointId::AnkleRight, kSure, Use::Any, "<ajc <tio"},
    {JointId::AnkleLeft, JointId::AnkleRight, kGuess, Use::Markers, "<ank <anm"},
    {JointId::AnkleLeft, JointId::AnkleRight, kSure, Use::Any, "<ankle <anklejoint <foot <talus"},
    {JointId::AnkleLeft, JointId::AnkleRight, kGuess, Use::Markers, "<ank"},
    {JointId::FootLeft, JointId::FootRight, kSure, Use::Any,
     "<toebase <toes <toe <ball <bigtoe <forefoot <toe1 <footend <ankleend <foot"},
    {JointId::FootLeft, JointId::FootRight, kGuess, Use::Markers, "<toe"},
    {JointId::FootLeft, JointId::FootRight, kGuess, Use::Markers, "<mt1 <mt5"},
    {JointId::FootLeft, JointId::FootRight, kGuess, Use::Markers, "<mt1 <mt2"},
    {JointId::ElbowLeft, JointId::ElbowRight, kSure, Use::Any, "<ejc <huo"},
    {JointId::ElbowLeft, JointId::ElbowRight, kGuess, Use::Markers, "<elb <elm"},
    {JointId::ElbowLeft, JointId::ElbowRight, kSure, Use::Any,
     "<forearm <lowerarm <lowarm <farm <elbow <loarm <radius <armlower <elbowjoint"},
    {JointId::ElbowLeft, JointId::ElbowRight, kGuess, Use::Markers, "<elb"},
    {JointId::ShoulderLeft, JointId::ShoulderRight, kSure, Use::Any, "<sjc <hup <clo"},
    {JointId::ShoulderLeft, JointId::ShoulderRight, kGuess, Use::Any, "<shouldertop"},
    {JointId::ShoulderLeft, JointId::ShoulderRight, kSure, Use::Any,
     "<upperarm <uparm <uarm <shldr <humerus <armupper <arm <shoulder <shoulderjoint"},
    {JointId::ShoulderLeft, JointId::ShoulderRight, kGuess, Use::Markers, "<sho"},
    {JointId::WristLeft, JointId::WristRight, kSure, Use::Any, "<wjc <rao"},
    {JointId::WristLeft, JointId::WristRight, kSure, Use::Any, "<wrist <wristjoint <hand <carpus"},
    {JointId::WristLeft, JointId::WristRight, kGuess, Use::Markers, "<wra <wrb"},
    {JointId::WristLeft, JointId::WristRight, kGuess, Use::Markers, "<wra"},
    {JointId::HandLeft, JointId::HandRight, kSure, Use::Any, "<hno <handmiddle1 <middle1 <middleproximal <palm <hand"},
    {JointId::HandLeft, JointId::HandRight, kGuess, Use::Markers, "<fin"},
    {JointId::HandTipLeft, JointId::HandTipRight, kSure, Use::Any, "<handtip <handmiddle3end <middle3end <handmiddle4 <handend <fingers"},
    {JointId::ThumbLeft, JointId::ThumbRight, kSure, Use::Any, "<handthumb3 <thumb3 <thumbdistal <handthumb2 <handthumb1 <thumb2 <thumb1 <thumb"},
    {JointId::SpineBase, JointId::SpineBase, kSure, Use::Any, ".midpel .hips .pelvis .hip .midhip .pelvisjoint"},
    {JointId::SpineBase, JointId::SpineBase, kSure, Use::All, "l.hjc r.hjc"},
    {JointId::SpineBase, JointId::SpineBase, kSure, Use::All, "l.fep r.fep"},
    {JointId::SpineBase, JointId::SpineBase, kSure, Use::All, "hip.left hip.right"},
    {JointId::SpineBase, JointId::SpineBase, kGuess, Use::Markers, "l.asi r.asi l.psi r.psi"},
    {JointId::SpineBase, JointId::SpineBase, kGuess, Use::Markers, "l.asi r.asi .sacr"},
    {JointId::SpineBase, JointId::SpineBase, kGuess, Use::Any, ".root"},
    {JointId::SpineMid, JointId::SpineMid, kSure, Use::Any,
     ".spine1 .chest2 .spine2 .middlespine .chest .spine .torso .abdomen .ab .lowerspine .lowerback .waist .trunk .t12"},
    {JointId::SpineMid, JointId::SpineMid, kGuess, Use::Markers, ".strn .t10"},
    {JointId::Neck, JointId::Neck, kSure, Use::Any, ".neck .neck1 .necktwist1 .neck2 .lowerneck .neckbase"},
    {JointId::Neck, JointId::Neck, kGuess, Use::Markers, ".c7"},
    {JointId::SpineShoulder, JointId::SpineShoulder, kGuess, Use::Markers, ".clav .c7"},
    {JointId::SpineShoulder, JointId::SpineShoulder, kGuess, Use::Any, ".upperchest .chest4 .thorax"},
    {JointId::Head, JointId::Head, kSure, Use::Any, ".head .hedo .headcentre .headcenter .headjoint .skull"},
    {JointId::Head, JointId::Head, kGuess, Use::Markers, "l.fhd r.fhd l.bhd r.bhd"},
    {JointId::Head, JointId::Head, kGuess, Use::All, "l.ear r.ear"},
    {JointId::Head, JointId::Head, kGuess, Use::Markers, "l.fhd r.fhd"},
    {JointId::Head, JointId::Head, kGuess, Use::All, ".head1 .head2 .head3"},
    {JointId::Head, JointId::Head, kGuess, Use::Any, ".headtop .tophead .ariel .nose"},
};

/// Skin markers: our word, and what laboratories and programs call them.
struct MarkerRow {
  std::string_view canonical;
  std::string_view names;
};
constexpr MarkerRow kMarkers[] = {
    {"asi", "asi asis ias fwt waistfront"},
    {"psi", "psi psis ips bwt waistback"},
    {"sacr", "sacr sacrum sacral vsacral vsacrum sac vsac s1 s2"},
    {"kne", "kne knee kneelat kneelateral kneeout knee1 fle lfc lfe lfep kl lek latknee"},
    {"knm", "knm kneemed kneemedial kneein knee2 fme mfc mfe km mek medknee mkne"},
    {"ank", "ank ankle anklelat anklelateral ankleout lmal mall fal lm al latankle ankle1"},
    {"anm", "anm anklemed anklemedial anklein mmal tam mm am medankle ankle2 med"},
    {"toe", "toe toetip mt2 fm2 met met2 mtp2 hallux bigtoe forefoot2 rmt2 toelat"},
    {"mt1", "mt1 fm1 fmm fm mh1 mtp1 met1 toemed"},
    {"mt5", "mt5 fm5 fml fl mh5 mtp5 met5 toelat"},
    {"mt2", "mt2"},
    {"sho", "sho acromion acromium acr acro acrom shouldertop saj should shoulder ac"},
    {"elb", "elb elbow elbowlat elbowlateral elbowout lateralepicondyle hle lel elbl lhe"},
    {"elm", "elm elbowmed elbowmedial elbowin medialepicondyle hme mel elbm mhe"},
    {"wra", "wra wristlat wristout radialstyloid rsp wristrad rad wrr wri faradius"},
    {"wrb", "wrb wristmed wristin ulnarstyloid usp uhe wristuln uln wru faulna"},
    {"fin", "fin hm2 handout handlat hand2 finger glove2"},
    {"strn", "strn xiph xiphoid sxs px sternum"},
    {"clav", "clav snj ij jn jugular manubrium clavicle spinefront"},
    {"c7", "c7 cv7 spinetop"},
    {"t10", "t10 tv10 t8 tv8 tv7 spinethoracic12"},
    {"fhd", "fhd hdf headfront"},
    {"bhd", "bhd hdb headback"},
};
// clang-format on

/// The index of each point by its plain name, and by the canonical names of markers.
struct Lookup {
  std::map<std::string, std::size_t> names;
  std::map<std::string, std::size_t> markers;
};

std::vector<std::string_view> words_in(std::string_view list) {
  std::vector<std::string_view> words;
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(' '), list.size());
    if (end > 0) words.push_back(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return words;
}

void add_marker(Lookup& out, const std::string& plain, std::size_t point) {
  const std::size_t dot = plain.find('.');
  const std::string_view stem = std::string_view(plain).substr(dot + 1);
  for (const MarkerRow& row : kMarkers) {
    for (const std::string_view name : words_in(row.names)) {
      if (name == stem)
        out.markers.emplace(plain.substr(0, dot + 1) + std::string(row.canonical), point);
    }
  }
}

/// A name without a side whose first letter may be one counts as that, too: "lkne", "RASI".
Lookup lookup_of(const std::vector<std::string>& names) {
  Lookup out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string plain = plain_name(names[i]);
    out.names.emplace(plain, i);
    add_marker(out, plain, i);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string plain = plain_name(names[i]);
    if (plain.size() < 4 || plain[0] != '.' || (plain[1] != 'l' && plain[1] != 'r')) continue;
    const std::string sided = plain.substr(1, 1) + "." + plain.substr(2);
    out.names.emplace(sided, i);
    add_marker(out, sided, i);
  }
  return out;
}

std::optional<std::size_t> point_named(const std::map<std::string, std::size_t>& names,
                                       std::string_view wanted, char side) {
  std::string key(wanted);
  if (key.front() == '<') key.replace(0, 1, std::string(1, side) + ".");
  const auto found = names.find(key);
  return found == names.end() ? std::nullopt : std::optional(found->second);
}

/// The joint that must not be made of the same point: "LeftLeg" is a thigh or a shin, never both.
std::optional<JointId> rival_of(JointId joint) {
  switch (joint) {
    case JointId::HipLeft:
      return JointId::KneeLeft;
    case JointId::HipRight:
      return JointId::KneeRight;
    case JointId::FootLeft:
      return JointId::AnkleLeft;
    case JointId::FootRight:
      return JointId::AnkleRight;
    case JointId::HandLeft:
      return JointId::WristLeft;
    case JointId::HandRight:
      return JointId::WristRight;
    default:
      return std::nullopt;
  }
}

bool is_taken(const JointSources& sources, JointId joint, std::size_t point) {
  const auto rival = rival_of(joint);
  return rival && sources[index_of(*rival)].points == std::vector<std::size_t>{point};
}

JointSource source_of(const Lookup& lookup, const NameRow& row, JointId joint,
                      const JointSources& sources) {
  const auto& names = row.use == Use::Markers ? lookup.markers : lookup.names;
  const char side = joint == row.left ? 'l' : 'r';
  JointSource source{{}, row.state, Placing::Mean};
  if (row.names == "hip.left hip.right") {
    const JointSource& left = sources[index_of(JointId::HipLeft)];
    const JointSource& right = sources[index_of(JointId::HipRight)];
    if (left.points.size() == 1 && right.points.size() == 1)
      source.points = {left.points[0], right.points[0]};
    return source;
  }
  for (const std::string_view word : words_in(row.names)) {
    const auto point = point_named(names, word, side);
    const bool usable = point && !is_taken(sources, joint, *point);
    if (usable) source.points.push_back(*point);
    if (usable && row.use == Use::Any) return source;
    if (!usable && row.use != Use::Any) return {};
  }
  return source;
}

/// Hip joint centres from the markers on the pelvis, for files that have no better ones.
void add_hips_of_pelvis(const Lookup& lookup, JointSources& sources) {
  std::vector<std::size_t> pelvis;
  for (const std::string_view name : {"l.asi", "r.asi", "l.psi", "r.psi"}) {
    if (const auto point = point_named(lookup.markers, name, 'l')) pelvis.push_back(*point);
  }
  const auto sacrum = point_named(lookup.markers, ".sacr", 'l');
  if (pelvis.size() == 2 && sacrum) pelvis.push_back(*sacrum);
  const bool front = lookup.markers.contains("l.asi") && lookup.markers.contains("r.asi");
  if (!front || pelvis.size() < 3 || (pelvis.size() == 3 && !sacrum)) return;
  for (const auto& [joint, placing] : {std::pair{JointId::HipLeft, Placing::LeftHipOfPelvis},
                                       std::pair{JointId::HipRight, Placing::RightHipOfPelvis}}) {
    JointSource& source = sources[index_of(joint)];
    if (source.points.empty()) source = {pelvis, kGuess, placing};
  }
}

void add_chosen(const std::vector<std::string>& names, const JointChoice& chosen,
                JointSources& sources) {
  const auto point_of = [&](const std::string& name) {
    const auto same = std::find(names.begin(), names.end(), name);
    if (same != names.end()) return same;
    return std::find_if(names.begin(), names.end(), [&](const std::string& each) {
      return plain_name(each) == plain_name(name);
    });
  };
  for (const auto& [joint, wanted] : chosen) {
    JointSource source{{}, kSure, Placing::Mean};
    for (const std::string& name : wanted) {
      const auto found = point_of(name);
      if (found != names.end())
        source.points.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (source.points.size() == wanted.size()) sources[index_of(joint)] = source;
  }
}

/// Our own 25 names, as chorus export writes them.  In BVH only if there is a SpineBase, because
/// "HandLeft" is a wrist in other dialects; true if so.
bool add_own(const std::vector<std::string>& names, Dialect dialect, JointSources& sources) {
  const bool ours = std::find(names.begin(), names.end(), "SpineBase") != names.end();
  if (!ours && dialect == Dialect::Joints) return false;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto joint = joint_named(names[i]);
    if (joint && sources[index_of(*joint)].points.empty())
      sources[index_of(*joint)] = {{i}, kSure, Placing::Mean};
  }
  return ours && dialect == Dialect::Joints;
}

}  // namespace

Eigen::Vector3d JointSource::placed(const std::vector<Eigen::Vector3d>& places) const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& place : places) mean += place;
  if (!places.empty()) mean /= static_cast<double>(places.size());
  if (placing == Placing::Mean || places.size() < 3) return mean;
  const Eigen::Vector3d front = 0.5 * (places[0] + places[1]);
  const Eigen::Vector3d back = places.size() < 4 ? places[2] : 0.5 * (places[2] + places[3]);
  const double width = (places[1] - places[0]).norm();
  const Eigen::Vector3d right = (places[1] - places[0]).stableNormalized();
  const Eigen::Vector3d ahead = (front - back - right * right.dot(front - back)).stableNormalized();
  const double side = placing == Placing::LeftHipOfPelvis ? -0.36 : 0.36;
  return front + width * (-0.19 * ahead - 0.30 * right.cross(ahead) + side * right);
}

JointSources joint_sources(const std::vector<std::string>& names, Dialect dialect,
                           const JointChoice& chosen) {
  JointSources sources;
  add_chosen(names, chosen, sources);
  if (add_own(names, dialect, sources)) return sources;
  const Lookup lookup = lookup_of(without_common_prefix(names));
  for (const NameRow& row : kRows) {
    if (row.use == Use::Markers && dialect == Dialect::Joints) continue;
    for (const JointId joint : {row.left, row.right}) {
      JointSource& source = sources[index_of(joint)];
      if (source.points.empty()) source = source_of(lookup, row, joint, sources);
    }
  }
  if (dialect == Dialect::JointsAndMarkers) add_hips_of_pelvis(lookup, sources);
  return sources;
}

std::size_t count_found(const JointSources& sources) {
  return static_cast<std::size_t>(
      std::count_if(sources.begin(), sources.end(),
                    [](const JointSource& source) { return !source.points.empty(); }));
}

}  // namespace chorus::motion
