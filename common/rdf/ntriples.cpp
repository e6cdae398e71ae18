#include <string>
#include <string_view>

#include "common/rdf/turtle_reader.h"
#include "common/rdf/turtle_writer.h"

namespace chorus::rdf {
namespace {

/// Appends a string literal (RDF 1.1 N-Triples, production 9): escapes what must be escaped; other
/// UTF-8 stays unchanged.
void append_string(std::string& out, std::string_view text) {
  out += '"';
  for (const char c : text) {
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\r':
        out += "\\r";
        break;
      default:
        out += c;
    }
  }
  out += '"';
}

void append_term(std::string& out, const TermView& term) {
  switch (term.kind) {
    case TermKind::Iri:
      out.append("<").append(term.value).append("> ");
      return;
    case TermKind::Blank:
      out.append("_:").append(term.value).append(" ");
      return;
    case TermKind::Literal:
      break;
  }
  append_string(out, term.value);
  if (!term.language.empty()) out.append("@").append(term.language);
  if (!term.datatype.empty()) out.append("^^<").append(term.datatype).append(">");
  out += ' ';
}

}  // namespace

Result<std::string> turtle_to_ntriples(std::string_view turtle, const std::string& base,
                                       std::size_t max_bytes) {
  ReadOptions options;
  options.base = base;
  options.limits.bytes = max_bytes;
  std::string out;
  out.reserve(turtle.size() * 5);  // Full names make it about five times longer.
  const auto ok = read_triples(turtle, options, [&out](const TripleView& triple) {
    append_term(out, triple.subject);
    append_term(out, triple.predicate);
    append_term(out, triple.object);
    out += ".\n";
    return true;
  });
  if (!ok) return pass(ok);
  return out;
}

}  // namespace chorus::rdf
