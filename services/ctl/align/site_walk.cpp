#include "services/ctl/align/site_walk.h"

#include "common/alignment/marked_points.h"
#include "common/client/service_client.h"
#include "services/ctl/convert/fused_frames.h"

namespace chorus::ctl {
namespace {

site::Person person_of(const resource::BodyResource& body) {
  site::Person person;
  person.body = PersonId{body.id};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Joint& joint = body.joints[i];
    if (joint.seen() && joint.state == JointState::Tracked) person.joints[i] = joint.position;
  }
  if (person.joints[index_of(JointId::SpineBase)])
    person.place = *person.joints[index_of(JointId::SpineBase)];
  if (body.carried_for) person.carried = from_seconds(*body.carried_for);
  return person;
}

}  // namespace

Result<NamedCell> read_named_cell(std::string_view text) {
  const std::size_t at = text.find('=');
  if (at == std::string_view::npos || at + 1 == text.size())
    return fail(ErrorCode::InvalidArgument, std::string(text),
                "is no cell: NAME=SOURCE is wanted, such as hall-a=http://10.0.0.5:8080/");
  const auto name = site::CellId::parse(text.substr(0, at));
  if (!name) return pass(name);
  return NamedCell{*name, std::string(text.substr(at + 1))};
}

Result<site::CellMark> read_cell_mark(std::string_view text) {
  const auto wrong = [&] {
    return fail(ErrorCode::InvalidArgument, std::string(text),
                "is no mark: NAME:X,Z=NAME:X,Z is wanted, such as a:1.5,-2=b:0,3");
  };
  const std::size_t middle = text.find('=');
  if (middle == std::string_view::npos) return wrong();
  site::CellMark mark;
  for (const bool first : {true, false}) {
    const std::string_view half = first ? text.substr(0, middle) : text.substr(middle + 1);
    const std::size_t colon = half.find(':');
    if (colon == std::string_view::npos) return wrong();
    const auto name = site::CellId::parse(half.substr(0, colon));
    const auto place = alignment::read_place(half.substr(colon + 1));
    if (!name || !place) return wrong();
    (first ? mark.first : mark.second) = *name;
    (first ? mark.x_in_first : mark.x_in_second) = Eigen::Vector3d(place->x(), 0, place->y());
  }
  return mark;
}

bool is_live(const std::string& source) {
  return source.starts_with("http://") || source.starts_with("https://");
}

Result<void> answers(const NamedCell& cell) {
  if (!is_live(cell.source)) return {};
  const auto url = http::parse_url(cell.source);
  if (!url) return pass(url);
  http::ClientRequest request;
  request.target = url->target;
  const auto answer = client::fetch_trusted(*url, request);
  if (!answer) return fail(answer.error().code, cell.source, answer.error().message);
  return {};
}

Result<site::CellWalk> walk_of(const NamedCell& cell, std::chrono::milliseconds listen) {
  site::CellWalk walk{cell.name, {}};
  const auto read = each_fused_frame(
      cell.source, listen,
      [&](const resource::FrameResource& frame, const std::string&) -> Result<void> {
        site::CellPeople people{cell.name, 1, frame.sequence, frame.captured, {}};
        for (const resource::BodyResource& body : frame.bodies)
          people.people.push_back(person_of(body));
        walk.seen.push_back(std::move(people));
        return {};
      });
  if (!read) return pass(read);
  return walk;
}

}  // namespace chorus::ctl
