// Reads a frame from Turtle or N-Triples in any spelling, with the parser.
#include <algorithm>
#include <functional>
#include <map>
#include <unordered_map>

#include "common/base/parse.h"
#include "common/rdf/turtle_reader.h"
#include "common/resource/decimal_reader.h"
#include "common/resource/frame_facts.h"
#include "common/resource/terms.h"
#include "common/sensor/limits.h"

namespace chorus::resource {
namespace {

using rdf::TermKind;
using rdf::TermView;

/// Largest number of subjects in a document; 64 bodies of 25 joints and the frame are 1 665.
constexpr std::size_t kMaxSubjects = 4096;

/// Most cells of RDF lists: the shares of 64 bodies of 25 joints that ten sensors see, and the
/// joints of their hands.
constexpr std::size_t kMaxCells = 24'576;
/// Most values of one list: a share for each sensor; a hand has 63.
constexpr std::size_t kMostInList = kMaxSensors;

enum class Property : std::uint8_t {
  BodyIs,
  BodyId,
  Captured,
  CapturedNanoseconds,
  Contributor,
  JointIs,
  JointName,
  List,
  Name,
  Number,
  PropIs,
  Sensor,
  Sequence,
  Shares,
  Source,
  Space,
  State,
  Whole,
};

struct Verb {
  std::string_view name;
  Property property;
  std::size_t index = 0;  ///< In SubjectFacts::numbers, wholes, names or lists.
};

constexpr std::array kOwnVerbs{
    Verb{"body", Property::BodyIs},
    Verb{"bodyId", Property::BodyId},
    Verb{"captured", Property::Captured},
    Verb{"capturedNanoseconds", Property::CapturedNanoseconds},
    Verb{"contributor", Property::Contributor},
    Verb{"heldProp", Property::PropIs},
    Verb{"joint", Property::JointIs},
    Verb{"jointName", Property::JointName},
    Verb{"sensor", Property::Sensor},
    Verb{"sequence", Property::Sequence},
    Verb{"shares", Property::Shares},
    Verb{"source", Property::Source},
    Verb{"space", Property::Space},
    Verb{"state", Property::State},
};

/// The properties in a frame document, sorted by name: those above and the fields of the tables.
constexpr auto kVerbs = [] {
  std::array<Verb, kOwnVerbs.size() + kNumberNames.size + kWholeNames.size + kNameNames.size +
                       kListNames.size>
      all{};
  auto end = std::ranges::copy(kOwnVerbs, all.begin()).out;
  const auto add = [&end](const NameList& list, Property property) {
    for (std::size_t i = 0; i < list.size; ++i) *end++ = {list.names[i], property, i};
  };
  add(kNumberNames, Property::Number);
  add(kWholeNames, Property::Whole);
  add(kNameNames, Property::Name);
  add(kListNames, Property::List);
  std::ranges::sort(all, {}, &Verb::name);
  return all;
}();

/// Compares without building a string.
bool is_xsd(std::string_view datatype, std::string_view name) {
  return datatype.size() == rdf::kXsd.size() + name.size() && datatype.starts_with(rdf::kXsd) &&
         datatype.ends_with(name);
}

bool is_number(std::string_view datatype) {
  return is_xsd(datatype, "decimal") || is_xsd(datatype, "double") || is_xsd(datatype, "integer") ||
         is_xsd(datatype, "float");
}

bool is_integer(std::string_view datatype) {
  return is_xsd(datatype, "integer") || is_xsd(datatype, "unsignedLong") ||
         is_xsd(datatype, "long");
}

/// The name of one of our own individuals; empty when the term is not one.
std::string_view individual(const TermView& term) {
  if (term.kind != TermKind::Iri || !term.value.starts_with(kChorus)) return {};
  return term.value.substr(kChorus.size());
}

/// Adds a value to a list, unless it is already there.
template <class T>
void add(std::vector<T>& list, T value) {
  if (std::ranges::find(list, value) == list.end()) list.push_back(std::move(value));
}

class Collector {
 public:
  Collector() {
    constexpr std::size_t kUsual = 256;  // Subjects of a frame with a few bodies.
    facts_.reserve(kUsual);
    iris_.reserve(kUsual);
  }

  /// False when the document is refused; error() gives the reason.
  bool take(const rdf::TripleView& triple) {
    const std::string_view verb = triple.predicate.value;
    if (verb == first_ || verb == rest_) return take_cell(triple);
    const std::size_t at = subject_of(triple.subject);
    if (facts_.size() > kMaxSubjects) {
      error_ = Error{ErrorCode::TooLarge, "frame",
                     "it speaks of more than " + std::to_string(kMaxSubjects) + " things"};
      return false;
    }
    if (verb == type_) {
      if (individual(triple.object) == "Frame") facts_[at].is_frame = true;
      return true;
    }
    if (!verb.starts_with(kChorus)) return true;
    const std::string_view name = verb.substr(kChorus.size());
    const auto* const row = std::ranges::lower_bound(kVerbs, name, {}, &Verb::name);
    if (row == kVerbs.end() || row->name != name)
      return true;  // Unknown properties are ignored (proto/README.md).
    std::string_view why = store(at, *row, triple.object);
    if (why.empty()) return true;
    error_ = Error{ErrorCode::Malformed, place_of(facts_[at], name), std::string(why)};
    return false;
  }

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  /// All facts that were taken; Malformed if what has to be a list of numbers is none.
  [[nodiscard]] Result<Facts> finish() && {
    for (const auto& [whose, list] : lists_) {
      const auto& [at, verb] = whose;
      auto& read =
          verb->property == Property::Shares ? facts_[at].shares : facts_[at].lists[verb->index];
      read = numbers_of(list);
      if (read) continue;
      return fail(ErrorCode::Malformed, place_of(facts_[at], verb->name), "is no list of numbers");
    }
    return std::move(facts_);
  }

 private:
  /// A cell of an RDF list.
  struct Cell {
    std::optional<double> number;
    std::string rest;
    bool broken = false;  ///< It has two values, or one that is no number.
  };

  bool take_cell(const rdf::TripleView& triple) {
    const auto found = cells_.find(triple.subject.value);
    if (found == cells_.end() && cells_.size() == kMaxCells) {
      error_ = Error{ErrorCode::TooLarge, "frame",
                     "its lists have more than " + std::to_string(kMaxCells) + " values"};
      return false;
    }
    Cell& cell = found != cells_.end() ? found->second : cells_[std::string(triple.subject.value)];
    if (triple.predicate.value == first_) {
      cell.broken = cell.broken || !store_number(cell.number, triple.object).empty();
    } else {
      cell.broken = cell.broken || (!cell.rest.empty() && cell.rest != triple.object.value);
      cell.rest = triple.object.value;
    }
    return true;
  }

  /// The numbers of the list whose first cell is `list`; none if it is no list, or if a value in it
  /// is no number.
  [[nodiscard]] std::optional<std::vector<double>> numbers_of(const std::string& list) const {
    std::vector<double> numbers;
    for (const std::string* at = &list; *at != nil_;) {
      const auto found = cells_.find(*at);
      if (found == cells_.end()) return std::nullopt;
      const Cell& cell = found->second;
      // A longer list, which may have no end, has too many values anyway.
      if (cell.broken || !cell.number || numbers.size() > kMostInList) return std::nullopt;
      numbers.push_back(*cell.number);
      at = &cell.rest;
    }
    return numbers;
  }

  /// Stores the object; returns "" or what is wrong with it.
  std::string_view store(std::size_t at, const Verb& row, const TermView& object) {
    switch (row.property) {
      case Property::BodyIs:
        return link(at, object, &SubjectFacts::bodies);
      case Property::JointIs:
        return link(at, object, &SubjectFacts::joints);
      case Property::PropIs:
        return link(at, object, &SubjectFacts::props);
      case Property::Shares:
      case Property::List:
        return link_list(at, row, object);
      case Property::Sensor:
      case Property::Contributor:
        return list_text(at, row.property == Property::Sensor, object);
      default:
        return store_value(facts_[at], row, object);
    }
  }

  /// Like store(), for the properties that a subject has only once.
  static std::string_view store_value(SubjectFacts& facts, const Verb& row,
                                      const TermView& object) {
    switch (row.property) {
      case Property::Number:
        return store_number(facts.numbers[row.index], object);
      case Property::Whole:
        return store_integer(facts.wholes[row.index], object);
      case Property::Name:
        return store_text(facts.names[row.index], object);
      case Property::BodyId:
        return store_integer(facts.body_id, object);
      case Property::Sequence:
        return store_integer(facts.sequence, object);
      case Property::CapturedNanoseconds:
        return store_integer(facts.captured_ns, object);
      case Property::Captured:
        return store_time(facts.captured, object);
      case Property::Source:
        return store_text(facts.source, object);
      case Property::JointName:
        return store_text(facts.joint_name, object);
      case Property::Space:
        return store_named(facts.space, object, space_named, kNoSpace);
      case Property::State:
        return store_named(facts.state, object, state_named, kNoState);
      default:
        return {};
    }
  }

  static constexpr std::string_view kTwice = "is given twice, with different values";

  std::string_view link(std::size_t at, const TermView& object,
                        std::vector<std::size_t> SubjectFacts::*list) {
    if (object.kind == TermKind::Literal) return "is a literal, not a resource";
    const std::size_t to = find_or_add(object);
    std::vector<std::size_t>& links = facts_[at].*list;
    // Limited here, so that a long list costs nothing; assemble() reports the limit.
    if (links.size() <= std::max(kMaxBodies, kJointCount)) add(links, to);
    return {};
  }

  std::string_view link_list(std::size_t at, const Verb& verb, const TermView& object) {
    if (object.kind == TermKind::Literal) return "is a literal, not a list";
    const auto [list, fresh] = lists_.try_emplace({at, &verb}, object.value);
    return fresh || list->second == object.value ? std::string_view() : kTwice;
  }

  static std::string_view store_number(std::optional<double>& property, const TermView& object) {
    if (object.kind != TermKind::Literal || !is_number(object.datatype)) return "is no number";
    const auto value = read_decimal(object.value);
    if (!value) return "is no finite number";
    return set_once(property, *value) ? std::string_view() : kTwice;
  }

  template <class T>
  static std::string_view store_integer(std::optional<T>& property, const TermView& object) {
    if (object.kind != TermKind::Literal || !is_integer(object.datatype)) return "is no integer";
    const auto value = parse_signed<T>(object.value);
    if (!value) return "is no integer of 64 bits, or has the wrong sign";
    return set_once(property, *value) ? std::string_view() : kTwice;
  }

  static std::string_view store_time(std::optional<Timestamp>& property, const TermView& object) {
    if (object.kind != TermKind::Literal || !is_xsd(object.datatype, "dateTime"))
      return "is no xsd:dateTime";
    const auto value = parse_iso8601(object.value);
    if (!value) return "is no xsd:dateTime with a zone, such as 2026-11-21T07:30:00.25Z";
    return set_once(property, *value) ? std::string_view() : kTwice;
  }

  static std::string_view store_text(std::optional<std::string>& property, const TermView& object) {
    if (object.kind != TermKind::Literal || !object.datatype.empty()) return "is no string";
    return set_once(property, std::string(object.value)) ? std::string_view() : kTwice;
  }

  template <class T, class Find>
  static std::string_view store_named(std::optional<T>& property, const TermView& object, Find find,
                                      std::string_view otherwise) {
    const auto value = find(individual(object));
    if (!value) return otherwise;
    return set_once(property, *value) ? std::string_view() : kTwice;
  }

  std::string_view list_text(std::size_t at, bool sensors, const TermView& object) {
    std::vector<std::string>& list = sensors ? facts_[at].sensors : facts_[at].contributors;
    constexpr std::size_t kMoreThanEnough = 65;  // One above the limit; assemble() reports it.
    if (object.kind != TermKind::Literal || !object.datatype.empty()) return "is no string";
    if (list.size() < kMoreThanEnough) add(list, std::string(object.value));
    return {};
  }

  /// The index of the subject.  Tries the last one first, because most triples of a subject follow
  /// one another.
  std::size_t subject_of(const TermView& subject) {
    if (last_ < facts_.size() && facts_[last_].name == subject.value && last_kind_ == subject.kind)
      return last_;
    last_ = find_or_add(subject);
    last_kind_ = subject.kind;
    return last_;
  }

  std::size_t find_or_add(const TermView& term) {
    auto& index = term.kind == TermKind::Blank ? blanks_ : iris_;
    if (const auto found = index.find(term.value); found != index.end()) return found->second;
    index.emplace(std::string(term.value), facts_.size());
    facts_.emplace_back().name = std::string(term.value);
    return facts_.size() - 1;
  }

  const std::string type_ = rdf::rdf("type");
  const std::string first_ = rdf::rdf("first");
  const std::string rest_ = rdf::rdf("rest");
  const std::string nil_ = rdf::rdf("nil");
  Facts facts_;
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const {
      return std::hash<std::string_view>{}(text);
    }
  };
  template <class Value>
  using ByName = std::unordered_map<std::string, Value, Hash, std::equal_to<>>;
  using Index = ByName<std::size_t>;

  ByName<Cell> cells_;
  /// The first cells of lists, by subject and by what they are lists of.
  std::map<std::pair<std::size_t, const Verb*>, std::string> lists_;
  Index iris_;
  Index blanks_;
  std::size_t last_ = 0;
  TermKind last_kind_ = TermKind::Iri;
  std::optional<Error> error_;
};

}  // namespace

Result<FrameResource> read_rdf_frame(std::string_view text, Format format) {
  rdf::ReadOptions options;
  options.syntax = format == Format::NTriples ? rdf::Syntax::NTriples : rdf::Syntax::Turtle;
  Collector collector;
  const auto ok = rdf::read_triples(text, options, [&collector](const rdf::TripleView& triple) {
    return collector.take(triple);
  });
  if (!ok) return pass(ok);
  if (collector.error()) return tl::unexpected<Error>(*collector.error());
  const auto facts = std::move(collector).finish();
  if (!facts) return pass(facts);
  return assemble(*facts);
}

}  // namespace chorus::resource
