// Names of other programs: one normaliser and one table of dialects.
#include "common/motion/joint_names.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace chorus::motion {
namespace {

using ::testing::HasSubstr;

struct Spelling {
  const char* name;
  const char* plain;
};

TEST(PlainName, IsASideAndAStem) {
  const Spelling spellings[] = {
      {"mixamorig:LeftUpLeg", "l.mixamorigupleg"},  // its prefix is what all names share
      {"LeftUpLeg", "l.upleg"},
      {"thigh.L", "l.thigh"},
      {"DEF-upper_arm.R", "r.upperarm"},
      {"upperarm_l", "l.upperarm"},
      {"Bip01 L Thigh", "l.bip1thigh"},
      {"LEFT_UPPER_ARM", "l.upperarm"},
      {"lShldr", "l.shldr"},
      {"LUArm", "l.uarm"},
      {"ArmL", "l.arm"},
      {"rightforearm", "r.forearm"},
      {"R.Knee.Lat", "r.kneelat"},
      {"ASISr", "r.asis"},
      {"rASIS", "r.asis"},
      {"spine_01", ".spine1"},
      {"LASI", ".lasi"},
      {"Root_M", ".root"},
      {"", "."},
  };
  for (const auto& [name, plain] : spellings) EXPECT_EQ(plain_name(name), plain) << name;
}

/// The joints that every dialect of whole bodies has.
constexpr std::array kWhole{JointId::SpineBase,     JointId::Head,       JointId::ShoulderLeft,
                            JointId::ShoulderRight, JointId::ElbowLeft,  JointId::ElbowRight,
                            JointId::WristLeft,     JointId::WristRight, JointId::HipLeft,
                            JointId::HipRight,      JointId::KneeLeft,   JointId::KneeRight,
                            JointId::AnkleLeft,     JointId::AnkleRight};

std::string source_name(const std::vector<std::string>& names, const JointSources& sources,
                        JointId joint) {
  const auto& points = sources[index_of(joint)].points;
  return points.size() == 1 ? names[points[0]] : std::string();
}

struct Dialects {
  const char* program;
  std::vector<std::string> names;
  const char* left_hip;
  const char* left_knee;
  const char* left_shoulder;
};

TEST(JointNames, ProgramsNameWholeBodies) {
  const Dialects dialects[] = {
      {"Mixamo",
       {"mixamorig_Hips", "mixamorig_Spine", "mixamorig_Head", "mixamorig_LeftShoulder",
        "mixamorig_LeftArm", "mixamorig_LeftForeArm", "mixamorig_LeftHand",
        "mixamorig_RightShoulder", "mixamorig_RightArm", "mixamorig_RightForeArm",
        "mixamorig_RightHand", "mixamorig_LeftUpLeg", "mixamorig_LeftLeg", "mixamorig_LeftFoot",
        "mixamorig_RightUpLeg", "mixamorig_RightLeg", "mixamorig_RightFoot"},
       "mixamorig_LeftUpLeg",
       "mixamorig_LeftLeg",
       "mixamorig_LeftArm"},
      {"Rokoko",
       {"Hips", "Spine", "Head", "LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand",
        "RightShoulder", "RightArm", "RightForeArm", "RightHand", "LeftThigh", "LeftShin",
        "LeftFoot", "RightThigh", "RightShin", "RightFoot"},
       "LeftThigh",
       "LeftShin",
       "LeftArm"},
      {"Motive",
       {"Skeleton 001_Hip", "Skeleton 001_Ab", "Skeleton 001_Chest", "Skeleton 001_Head",
        "Skeleton 001_LShoulder", "Skeleton 001_LUArm", "Skeleton 001_LFArm", "Skeleton 001_LHand",
        "Skeleton 001_RShoulder", "Skeleton 001_RUArm", "Skeleton 001_RFArm", "Skeleton 001_RHand",
        "Skeleton 001_LThigh", "Skeleton 001_LShin", "Skeleton 001_LFoot", "Skeleton 001_RThigh",
        "Skeleton 001_RShin", "Skeleton 001_RFoot"},
       "Skeleton 001_LThigh",
       "Skeleton 001_LShin",
       "Skeleton 001_LUArm"},
      {"Rocketbox, 3ds Max",
       {"Bip01 Pelvis", "Bip01 Spine", "Bip01 Head", "Bip01 L Clavicle", "Bip01 L UpperArm",
        "Bip01 L Forearm", "Bip01 L Hand", "Bip01 R Clavicle", "Bip01 R UpperArm",
        "Bip01 R Forearm", "Bip01 R Hand", "Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot",
        "Bip01 R Thigh", "Bip01 R Calf", "Bip01 R Foot"},
       "Bip01 L Thigh",
       "Bip01 L Calf",
       "Bip01 L UpperArm"},
      {"SMPL",
       {"m_avg_Pelvis",     "m_avg_L_Hip",    "m_avg_R_Hip",    "m_avg_Spine1",  "m_avg_L_Knee",
        "m_avg_R_Knee",     "m_avg_L_Ankle",  "m_avg_R_Ankle",  "m_avg_L_Foot",  "m_avg_R_Foot",
        "m_avg_Neck",       "m_avg_L_Collar", "m_avg_R_Collar", "m_avg_Head",    "m_avg_L_Shoulder",
        "m_avg_R_Shoulder", "m_avg_L_Elbow",  "m_avg_R_Elbow",  "m_avg_L_Wrist", "m_avg_R_Wrist"},
       "m_avg_L_Hip",
       "m_avg_L_Knee",
       "m_avg_L_Shoulder"},
      {"Poser, DAZ",
       {"hip", "abdomen", "chest", "head", "lCollar", "lShldr", "lForeArm", "lHand", "rCollar",
        "rShldr", "rForeArm", "rHand", "lThigh", "lShin", "lFoot", "rThigh", "rShin", "rFoot"},
       "lThigh",
       "lShin",
       "lShldr"},
      {"VRoid",
       {"J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_Head", "J_Bip_L_UpperArm", "J_Bip_L_LowerArm",
        "J_Bip_L_Hand", "J_Bip_R_UpperArm", "J_Bip_R_LowerArm", "J_Bip_R_Hand", "J_Bip_L_UpperLeg",
        "J_Bip_L_LowerLeg", "J_Bip_L_Foot", "J_Bip_R_UpperLeg", "J_Bip_R_LowerLeg", "J_Bip_R_Foot"},
       "J_Bip_L_UpperLeg",
       "J_Bip_L_LowerLeg",
       "J_Bip_L_UpperArm"},
      {"thigh called leg",
       {"root", "head", "LeftArm", "LeftElbow", "LeftHand", "RightArm", "RightElbow", "RightHand",
        "LeftLeg", "LeftKnee", "LeftFoot", "RightLeg", "RightKnee", "RightFoot"},
       "LeftLeg",
       "LeftKnee",
       "LeftArm"},
  };
  for (const auto& [program, names, hip, knee, shoulder] : dialects) {
    const JointSources sources = joint_sources(names, Dialect::Joints);
    for (const JointId joint : kWhole)
      EXPECT_FALSE(sources[index_of(joint)].points.empty()) << program << ' ' << name_of(joint);
    EXPECT_EQ(source_name(names, sources, JointId::HipLeft), hip) << program;
    EXPECT_EQ(source_name(names, sources, JointId::KneeLeft), knee) << program;
    EXPECT_EQ(source_name(names, sources, JointId::ShoulderLeft), shoulder) << program;
  }
}

TEST(JointNames, SkinMarkersOfLaboratoriesAreInferredAndOnlyInMarkerFiles) {
  const std::vector<std::string> names{"L_IAS", "R_IAS", "L_IPS", "R_IPS", "L_FLE",
                                       "L_FME", "L_FAL", "L_TAM", "L_SAJ", "L_HLE",
                                       "L_HME", "CV7",   "SXS"};
  const JointSources sources = joint_sources(names, Dialect::JointsAndMarkers);
  for (const JointId joint :
       {JointId::SpineBase, JointId::HipLeft, JointId::HipRight, JointId::KneeLeft,
        JointId::AnkleLeft, JointId::ElbowLeft, JointId::ShoulderLeft}) {
    EXPECT_FALSE(sources[index_of(joint)].points.empty()) << name_of(joint);
    EXPECT_EQ(sources[index_of(joint)].state, JointState::Inferred) << name_of(joint);
  }
  EXPECT_EQ(sources[index_of(JointId::KneeLeft)].points, (std::vector<std::size_t>{4, 5}));
  EXPECT_EQ(count_found(joint_sources(names, Dialect::Joints)), 0u);
}

TEST(JointNames, HipsFollowFromThePelvisByBell) {
  // Somebody who faces +z with +y up, so that left is +x: front spines 0.24 m apart.
  const std::vector<Eigen::Vector3d> pelvis{
      {0.12, 1.0, 0.1}, {-0.12, 1.0, 0.1}, {0.05, 1.0, -0.1}, {-0.05, 1.0, -0.1}};
  const JointSource left{{0, 1, 2, 3}, JointState::Inferred, Placing::LeftHipOfPelvis};
  const Eigen::Vector3d hip = left.placed(pelvis);
  EXPECT_NEAR(hip.x(), 0.36 * 0.24, 1e-9);
  EXPECT_NEAR(hip.y(), 1.0 - 0.30 * 0.24, 1e-9);
  EXPECT_NEAR(hip.z(), 0.1 - 0.19 * 0.24, 1e-9);
}

TEST(JointChoiceFile, NamesPointsOfJointsAndWins) {
  const auto chosen = parse_joint_choice(
      "# mine\nHead = top\nHipLeft = a, b  # their mean\nNeck =\n", "joints.txt");
  ASSERT_TRUE(chosen) << to_string(chosen.error());
  const std::vector<std::string> names{"a", "b", "top", "Head"};
  const JointSources sources = joint_sources(names, Dialect::JointsAndMarkers, *chosen);
  EXPECT_EQ(sources[index_of(JointId::Head)].points, (std::vector<std::size_t>{2}));
  EXPECT_EQ(sources[index_of(JointId::HipLeft)].points, (std::vector<std::size_t>{0, 1}));
  const auto typo = parse_joint_choice("HipLefd = a", "joints.txt");
  ASSERT_FALSE(typo);
  EXPECT_THAT(to_string(typo.error()), HasSubstr("did you mean HipLeft?"));
  EXPECT_FALSE(parse_joint_choice("Head = a\nHead = b", "joints.txt"));
  EXPECT_FALSE(parse_joint_choice("just text", "joints.txt"));
}

TEST(JointChoiceFile, ItsTemplateListsTheNamesAndReadsBack) {
  const std::vector<std::string> names{"LHJC", "odd one"};
  const auto sources = joint_sources(names, Dialect::JointsAndMarkers);
  const std::string text = joint_choice_template(names, sources);
  EXPECT_THAT(text, HasSubstr("#   odd one\n"));
  const auto read = parse_joint_choice(text, "template");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->at(JointId::HipLeft), std::vector<std::string>{"LHJC"});
}

}  // namespace
}  // namespace chorus::motion
