#include "fusion-server/nats/people_message.h"

#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/body/bones.h"
#include "common/body/covariance.h"
#include "fusion-server/nats/json_fields.h"

namespace chorus::nats {
namespace {

using nlohmann::json;

constexpr std::uint64_t kVersion = 1;
constexpr int kPlaceDigits = 5;     // [m]: a hundredth of a millimetre
constexpr int kVarianceDigits = 9;  // [m^2]: of a standard deviation of 0.03 mm
constexpr int kShareDigits = 4;

json lengths_json(const associate::StatedBuild& lengths) {
  json all = json::array();
  for (std::size_t i = 0; i < associate::kSpans; ++i) {
    if (lengths.variance[i] > 0.0)
      all.push_back({rounded(lengths.mean[i], kPlaceDigits),
                     std::max(rounded(lengths.variance[i], kVarianceDigits), 1e-9)});
    else
      all.push_back(nullptr);
  }
  return all;
}

json joints_json(const Located& joints) {
  json all = json::object();
  for (std::size_t i = 0; i < kJointCount; ++i)
    if (joints[i]) all[std::string(kJointNames[i])] = rounded(*joints[i], kPlaceDigits);
  return all;
}

json person_json(const site::Person& person) {
  json out{{"id", person.body.value},
           {"siteCertainty", rounded(person.site_certainty, kShareDigits)},
           {"since", time_text(person.since)},
           {"place", rounded(person.place, kPlaceDigits)},
           {"velocity", rounded(person.velocity, kPlaceDigits)},
           {"joints", joints_json(person.joints)},
           {"lengths", lengths_json(person.lengths)}};
  if (person.site_id) out["siteId"] = person.site_id->str();
  if (person.named) out["named"] = time_text(*person.named);
  if (person.sides) out["sides"] = rounded(*person.sides, kShareDigits);
  if (person.carried) out["carriedFor"] = rounded(seconds(*person.carried), 3);
  const Eigen::Matrix3d& c = person.covariance;
  if (!c.isZero() && Covariance(c).plausible()) {
    json upper = json::array();
    for (const double term : {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)})
      upper.push_back(rounded(term, kVarianceDigits));
    out["covariance"] = std::move(upper);
  }
  return out;
}

void read_joints(JsonFields& fields, Located& out) {
  const json* joints = fields.find("joints");
  if (joints == nullptr) return;
  if (!joints->is_object()) return fields.complain("joints", "is no object");
  for (const auto& [name, place] : joints->items()) {
    const auto id = joint_named(name);
    const auto numbers = numbers_in(place, 3);
    if (!id || !numbers)
      return fields.complain("joints", "must have names of joints, each with three numbers");
    out[index_of(*id)] = Eigen::Vector3d((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  }
}

void read_lengths(JsonFields& fields, associate::StatedBuild& out) {
  const json* lengths = fields.find("lengths");
  if (lengths == nullptr) return;
  if (!lengths->is_array() || lengths->size() != associate::kSpans)
    return fields.complain("lengths", "must be " + std::to_string(associate::kSpans) + " pairs");
  for (std::size_t i = 0; i < associate::kSpans; ++i) {
    if ((*lengths)[i].is_null()) continue;
    const auto pair = numbers_in((*lengths)[i], 2);
    if (!pair || (*pair)[1] <= 0.0)
      return fields.complain("lengths", "must be null or [length, variance above 0]");
    out.mean[i] = (*pair)[0];
    out.variance[i] = (*pair)[1];
  }
}

void read_covariance(JsonFields& fields, Eigen::Matrix3d& out) {
  const auto upper = fields.maybe_numbers("covariance", Covariance::kTerms);
  if (!upper) return;
  std::array<double, Covariance::kTerms> terms{};
  std::copy(upper->begin(), upper->end(), terms.begin());
  const Covariance covariance(terms);
  if (!covariance.plausible()) return fields.complain("covariance", "has a negative variance");
  out = covariance.matrix();
}

/// A share of 1 that may be absent.
std::optional<double> read_share(JsonFields& fields, const char* key) {
  const auto value = fields.maybe_number(key);
  if (value && (*value < 0.0 || *value > 1.0)) fields.complain(key, "must be from 0 to 1");
  return value;
}

Result<site::Person> read_person(const json& object, const std::string& where) {
  JsonFields fields(object, where);
  site::Person person;
  person.body = PersonId{fields.count("id")};
  person.site_id = fields.maybe_site_id("siteId");
  person.site_certainty = read_share(fields, "siteCertainty").value_or(0.0);
  person.since = fields.time("since");
  person.named = fields.maybe_time("named");
  person.place = fields.vector("place");
  person.velocity = fields.vector("velocity");
  read_covariance(fields, person.covariance);
  read_joints(fields, person.joints);
  read_lengths(fields, person.lengths);
  person.sides = read_share(fields, "sides");
  const auto carried = fields.maybe_number("carriedFor");
  if (carried && *carried < 0.0) fields.complain("carriedFor", "must be at least 0");
  if (carried) person.carried = from_seconds(*carried);
  if (fields.error()) return tl::unexpected(*fields.error());
  return person;
}

Result<void> read_all(const json& list, site::CellPeople& out) {
  std::set<PersonId> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    auto person = read_person(list[i], "people." + std::to_string(i));
    if (!person) return pass(person);
    if (!seen.insert(person->body).second)
      return fail(ErrorCode::Malformed, "people", "has two people of one id");
    out.people.push_back(std::move(*person));
  }
  return {};
}

}  // namespace

std::string write_people(const site::CellPeople& people) {
  json list = json::array();
  for (const site::Person& person : people.people) {
    if (list.size() == kMostPeople) break;
    list.push_back(person_json(person));
  }
  return json{{"version", kVersion},        {"cell", people.cell.str()},
              {"boot", people.boot},        {"sequence", people.sequence},
              {"at", time_text(people.at)}, {"people", std::move(list)}}
      .dump();
}

Result<site::CellPeople> read_people(std::string_view bytes) {
  const auto parsed = parse_json(bytes, {kMostPeopleBytes, 8});
  if (!parsed) return pass(parsed);
  JsonFields fields(*parsed, "");
  site::CellPeople people;
  if (fields.count("version") != kVersion) fields.complain("version", "is not 1");
  people.cell = fields.cell("cell");
  people.boot = fields.count("boot");
  people.sequence = fields.count("sequence");
  people.at = fields.time("at");
  const json* list = fields.find("people");
  if (list == nullptr || !list->is_array() || list->size() > kMostPeople)
    fields.complain("people", "must be a list of at most " + std::to_string(kMostPeople));
  if (fields.error()) return tl::unexpected(*fields.error());
  if (auto ok = read_all(*list, people); !ok) return pass(ok);
  return people;
}

}  // namespace chorus::nats
