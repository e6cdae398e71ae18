// Vocabulary and shapes.
#include <algorithm>
#include <stdexcept>

#include "tests/contract/contract_text.h"
#include "tests/contract/field_terms.h"

namespace chorus::contract {
namespace {

std::string between_marks(const std::string& text, const std::string& part) {
  const std::string begin = kBegin;
  const std::size_t from = text.find(begin);
  const std::size_t to = text.find(kEnd);
  if (from == std::string::npos || to == std::string::npos)
    throw std::runtime_error("the marks of the generated part are missing");
  return text.substr(0, from + begin.size()) + part + text.substr(to);
}

std::string joined(const std::vector<std::string>& parts, const std::string& before,
                   const std::string& comma) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : comma) + before + part;
  return text;
}

std::string range_of(const Term& term) {
  if (term.is_number()) return "xsd:decimal";
  if (term.kind == resource::FieldKind::List) return "rdf:List";
  return term.kind == resource::FieldKind::Whole ? "xsd:integer" : "xsd:string";
}

std::string paragraph(const Term& term) {
  const bool several =
      term.owners.size() > 1 || term.row.also.find("domainIncludes") != std::string_view::npos;
  std::string text = "\nch:" + term.name + " a rdf:Property, owl:" +
                     (term.kind == resource::FieldKind::List ? "Object" : "Datatype") +
                     "Property ;\n";
  text += "  rdfs:label \"" + term.label() + "\"@en ;\n";
  text += "  rdfs:comment \"" + term.comment(false) + "\"@en ;\n";
  text += (several ? "  dcam:domainIncludes " : "  rdfs:domain ") +
          joined(term.owners, "ch:", ", ") + " ;\n";
  text += "  rdfs:range " + range_of(term);
  if (!term.row.unit.empty()) text += " ;\n  qudt:hasUnit unit:" + std::string(term.row.unit);
  if (!term.row.also.empty()) text += " ;\n  " + term.also();
  return text + " ;\n  owl:versionInfo \"since " + std::string(term.row.since) + "\" .\n";
}

/// Of the list, and of the numbers in it.
std::string list_shapes(const Term& term) {
  return "<#" + term.name + "> a sh:PropertyShape ;\n  sh:path ch:" + term.name +
         " ; sh:maxCount 1 ; sh:nodeKind sh:BlankNodeOrIRI .\n<#" + term.name +
         "Numbers> a sh:PropertyShape ;\n  sh:path ( ch:" + term.name +
         " [ sh:zeroOrMorePath rdf:rest ] rdf:first ) ; sh:datatype xsd:decimal ; "
         "sh:minInclusive " +
         short_number(term.least()) + " ; sh:maxInclusive " + short_number(term.row.most) + " .\n";
}

std::string shape(const Term& term) {
  if (term.kind == resource::FieldKind::List) return list_shapes(term);
  std::string text = "<#" + term.name + "> a sh:PropertyShape ;\n  sh:path ch:" + term.name +
                     " ; sh:maxCount 1 ; sh:datatype " + range_of(term);
  if (term.kind == resource::FieldKind::Name)
    return text + " ; sh:pattern \"^[A-Za-z0-9_-]{1,64}$\" .\n";
  text += " ; sh:minInclusive " + short_number(term.least());
  if (term.row.most > 0) text += " ; sh:maxInclusive " + short_number(term.row.most);
  return text + " .\n";
}

/// That all numbers of a field are given or none.
std::string whole_or_not(const std::vector<std::string>& group) {
  const auto each = [&](const char* count) {
    std::string text = "[ sh:property ";
    for (const std::string& name : group)
      text += (&name == &group.front() ? "[ sh:path ch:" : " , [ sh:path ch:") + name + " ; " +
              count + " ]";
    return text + " ]";
  };
  return "  sh:or ( " + each("sh:maxCount 0") + "\n          " + each("sh:minCount 1") + " )";
}

std::string shape_of(const std::string& owner, const std::vector<Term>& terms) {
  std::vector<std::string> names;
  std::string groups;
  for (const Term& term : terms) {
    if (!term.of(owner)) continue;
    names.push_back("<#" + term.name + ">");
    if (term.kind == resource::FieldKind::List) names.push_back("<#" + term.name + "Numbers>");
    if (term.first() && term.group.size() > 1) groups += " ;\n" + whole_or_not(term.group);
  }
  if (names.empty()) return {};
  return "\n<#" + owner + "> sh:property " + joined(names, "", " , ") + groups + " .\n";
}

}  // namespace

std::string with_vocabulary(const std::string& text) {
  std::string part;
  for (const Term& term : field_terms()) part += paragraph(term);
  return between_marks(text, part + "\n");
}

std::string with_shapes(const std::string& text) {
  const auto terms = field_terms();
  std::string part;
  for (const char* owner : {"Frame", "Skeleton", "Joint"}) part += shape_of(owner, terms);
  part += "\n";
  for (const Term& term : terms) part += shape(term);
  return between_marks(text, part);
}

}  // namespace chorus::contract
