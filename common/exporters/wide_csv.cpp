#include "common/exporters/wide_csv.h"

#include <cmath>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/exporters/number_text.h"
#include "common/exporters/skeleton_fit.h"
#include "common/geometry/rotation.h"

namespace chorus::exporters {
namespace {

constexpr int kWideDigits = 6;  // of metres and quaternions
constexpr int kWideDeviationDigits = 3;
constexpr std::array<char, 3> kAxes{'x', 'y', 'z'};

/// Of the two quaternions of a rotation the one nearer to the last.
class Continued {
 public:
  Eigen::Quaterniond next(Eigen::Quaterniond q) {
    if (last_.coeffs().dot(q.coeffs()) < 0.0) q.coeffs() = -q.coeffs();
    last_ = q;
    return q;
  }

 private:
  Eigen::Quaterniond last_ = Eigen::Quaterniond(0, 0, 0, 0);
};

void append_cell(std::string& row, double value, int digits) {
  row += ',';
  append_fixed(row, value, digits);
}

void append_time(std::string& row, const Take& take, std::size_t frame) {
  row += std::to_string(frame);
  append_cell(row, static_cast<double>(frame) / take.rate_hz, kTimeDigits);
}

void append_joint(std::string& row, const Joint& joint, double variance, Continued& turn) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    if (joint.seen())
      append_cell(row, joint.position[axis], kWideDigits);
    else
      row += ',';
  }
  if (joint.seen() && is_unit(joint.orientation)) {
    const Eigen::Quaterniond q = turn.next(joint.orientation);
    for (Eigen::Index i = 0; i < 4; ++i) append_cell(row, q.coeffs()[i], kWideDigits);
  } else {
    row += ",,,,";
  }
  if (joint.seen() && variance >= 0.0)
    append_cell(row, to_mm(std::sqrt(variance)), kWideDeviationDigits);
  else
    row += ',';
}

std::string chorus_columns(const Take& take) {
  std::string text = "frame,time_s,utc,person";
  for (const std::string_view joint : kJointNames)
    for (const char* column : {"x_m", "y_m", "z_m", "qx", "qy", "qz", "qw", "sd_mm"})
      text.append(",").append(joint).append(".").append(column);
  text += '\n';
  std::vector<std::array<Continued, kJointCount>> turns(take.persons.size());
  for (std::size_t f = 0; f < take.frames; ++f) {
    for (std::size_t p = 0; p < take.persons.size(); ++p) {
      const Pose& pose = take.persons[p].poses[f];
      append_time(text, take, f);
      text += "," + to_iso8601(instant_of(take, f)) + "," +
              std::to_string(take.persons[p].person.value);
      for (std::size_t j = 0; j < kJointCount; ++j)
        append_joint(text, pose.skeleton.joints[j], pose.variance[j], turns[p][j]);
      text += '\n';
    }
  }
  return text;
}

std::string pose2sim_columns(const Take& take) {
  std::string text = "frame,time_s";
  for (const PersonTrack& track : take.persons) {
    const std::string prefix = prefix_of(take, track);
    for (const NamedJoint& each : kPose2SimMarkers)
      for (const char axis : kAxes)
        text.append(",").append(prefix).append(each.name).append("_").append(1, axis).append("_m");
  }
  text += '\n';
  for (std::size_t f = 0; f < take.frames; ++f) {
    append_time(text, take, f);
    for (const PersonTrack& track : take.persons) {
      for (const NamedJoint& each : kPose2SimMarkers) {
        const Joint& joint = track.poses[f].skeleton[each.joint];
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
          if (joint.seen())
            append_cell(text, joint.position[axis], kWideDigits);
          else
            text += ',';
        }
      }
    }
    text += '\n';
  }
  return text;
}

/// A person's bones as Motive names them, and how far each frame's are turned in the world.
struct MotivePerson {
  const PersonTrack& track;
  SkeletonFit fit;
  std::vector<std::size_t> bones;  ///< Of fit.joints.
  std::vector<std::string_view> names;
  std::vector<Continued> turns;
};

MotivePerson motive_person(const PersonTrack& track, SkeletonFit fit) {
  MotivePerson person{track, std::move(fit), {}, {}, {}};
  for (const NamedJoint& each : kMotiveBones) {
    for (std::size_t i = 0; i < person.fit.joints.size(); ++i) {
      if (person.fit.joints[i].id != each.joint) continue;
      person.bones.push_back(i);
      person.names.push_back(each.name);
    }
  }
  person.turns.resize(person.bones.size());
  return person;
}

void append_bones(std::string& row, MotivePerson& person, std::size_t frame) {
  if (!person.track.poses[frame].skeleton[JointId::SpineBase].seen()) {
    row.append(7 * person.bones.size(), ',');
    return;
  }
  const FittedPose& pose = person.fit.poses[frame];
  const auto places = chain_positions(person.fit, pose);
  std::vector<Eigen::Quaterniond> in_world;
  for (std::size_t i = 0; i < person.fit.joints.size(); ++i)
    in_world.push_back(i == 0 ? pose.turns[0]
                              : in_world[person.fit.joints[i].parent] * pose.turns[i]);
  for (std::size_t b = 0; b < person.bones.size(); ++b) {
    const std::size_t i = person.bones[b];
    const Eigen::Quaterniond q = person.turns[b].next(in_world[i]);
    for (Eigen::Index k = 0; k < 4; ++k) append_cell(row, q.coeffs()[k], kWideDigits);
    for (Eigen::Index axis = 0; axis < 3; ++axis) append_cell(row, places[i][axis], kWideDigits);
  }
}

/// One header line: a cell for each of the seven columns of each bone.
template <class Cell>
void append_header(std::string& text, const char* begin, const std::vector<MotivePerson>& people,
                   const Cell& cell) {
  text += begin;
  for (const MotivePerson& person : people)
    for (std::size_t b = 0; b < person.bones.size(); ++b)
      for (std::size_t column = 0; column < 7; ++column) text += "," + cell(person, b, column);
  text += '\n';
}

std::string motive_head(const Take& take, std::string_view name) {
  std::string rate;
  append_fixed(rate, take.rate_hz, kTimeDigits);
  const std::string frames = std::to_string(take.frames);
  std::string plain;  // a comma would begin another cell
  for (const char c : name) plain += c == ',' || c == '"' || c == '\n' ? ' ' : c;
  return "Format Version,1.23,Take Name," + plain + ",Take Notes,,Capture Frame Rate," + rate +
         ",Export Frame Rate," + rate + ",Capture Start Time," + to_iso8601(take.start) +
         ",Total Frames in Take," + frames + ",Total Exported Frames," + frames +
         ",Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global\n\n";
}

Result<std::string> motive_columns(const Take& take, std::string_view name) {
  std::vector<MotivePerson> people;
  for (const PersonTrack& track : take.persons)
    if (auto fit = fit_skeleton(track)) people.push_back(motive_person(track, std::move(*fit)));
  if (people.empty())
    return fail(ErrorCode::Unsupported, "fused frames", "nobody in them shows a SpineBase.");
  std::string text = motive_head(take, name);
  append_header(text, ",Type", people, [](auto&&...) { return std::string("Bone"); });
  append_header(text, ",Name", people, [](const MotivePerson& person, std::size_t b, auto) {
    return "P" + std::to_string(person.fit.person.value) + ":" + std::string(person.names[b]);
  });
  append_header(text, ",ID", people, [](const MotivePerson& person, std::size_t b, auto) {
    return std::to_string(person.fit.person.value) + ":" + std::to_string(b + 1);
  });
  append_header(text, ",", people, [](const MotivePerson&, auto, std::size_t column) {
    return std::string(column < 4 ? "Rotation" : "Position");
  });
  append_header(text, "Frame,Time (Seconds)", people,
                [](const MotivePerson&, auto, std::size_t column) {
                  return std::string(1, "XYZWXYZ"[column]);
                });
  for (std::size_t f = 0; f < take.frames; ++f) {
    append_time(text, take, f);
    for (MotivePerson& person : people) append_bones(text, person, f);
    text += '\n';
  }
  return text;
}

}  // namespace

Result<std::string> wide_csv_of(const Take& take, ColumnNames names, std::string_view name) {
  switch (names) {
    case ColumnNames::Motive:
      return motive_columns(take, name);
    case ColumnNames::Pose2Sim:
      return pose2sim_columns(take);
    case ColumnNames::Chorus:
      break;
  }
  return chorus_columns(take);
}

}  // namespace chorus::exporters
