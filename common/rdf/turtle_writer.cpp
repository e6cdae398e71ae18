#include "common/rdf/turtle_writer.h"

#include <serd/serd.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "common/rdf/utf8.h"

namespace chorus::rdf {
namespace {

/// Blank nodes nested deeper than this are written with labels, because readers may limit the
/// depth.
constexpr int kMaxInline = 16;

std::size_t append_to(const void* bytes, std::size_t size, void* text) {
  static_cast<std::string*>(text)->append(static_cast<const char*>(bytes), size);
  return size;
}

bool writable_iri(const std::string& text) {
  constexpr std::string_view kNever = "<>\"{}|^`\\";
  return is_utf8(text) && std::ranges::none_of(text, [&](char c) {
           return static_cast<unsigned char>(c) <= 0x20 || kNever.find(c) != std::string_view::npos;
         });
}

bool writable_label(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  });
}

bool writable(const Term& term) {
  switch (term.kind) {
    case TermKind::Iri:
      return writable_iri(term.value);
    case TermKind::Blank:
      return writable_label(term.value);
    case TermKind::Literal:
      return is_utf8(term.value) && term.value.find('\0') == std::string::npos &&
             writable_iri(term.datatype) && std::ranges::all_of(term.language, [](char c) {
               return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
                      (c >= '0' && c <= '9');
             });
  }
  return false;
}

Result<void> check(const Triple& triple) {
  const bool shape =
      triple.subject.kind != TermKind::Literal && triple.predicate.kind == TermKind::Iri;
  for (const Term* term : {&triple.subject, &triple.predicate, &triple.object}) {
    if (!writable(*term) || !shape) {
      return fail(ErrorCode::InvalidArgument, clean_utf8(term->value.substr(0, 80)),
                  "cannot be written in this place of a triple");
    }
  }
  return {};
}

struct FreeWriter {
  void operator()(SerdWriter* writer) const { serd_writer_free(writer); }
  void operator()(SerdEnv* env) const { serd_env_free(env); }
};

/// Writes one checked graph.
class Writing {
 public:
  Writing(const Graph& graph, const WriteOptions& options)
      : options_(options), turtle_(options.syntax == Syntax::Turtle), env_(serd_env_new(nullptr)) {
    for (const Triple& triple : graph) {
      auto [at, fresh] = by_subject_.try_emplace(triple.subject);
      if (fresh) order_.push_back(triple.subject);
      at->second.push_back(&triple);
      if (triple.object.kind == TermKind::Blank) ++uses_[triple.object];
    }
    const auto style = static_cast<SerdStyle>(SERD_STYLE_ABBREVIATED | SERD_STYLE_CURIED);
    writer_.reset(serd_writer_new(turtle_ ? SERD_TURTLE : SERD_NTRIPLES,
                                  turtle_ ? style : SerdStyle{}, env_.get(), nullptr, append_to,
                                  &text_));
  }

  std::string run() {
    for (const auto& [name, space] : turtle_ ? options_.prefixes : std::vector<Prefix>{}) {
      const SerdNode name_node = serd_node_from_string(SERD_LITERAL, bytes_of(name));
      const SerdNode space_node = serd_node_from_string(SERD_URI, bytes_of(space));
      serd_writer_set_prefix(writer_.get(), &name_node, &space_node);
    }
    for (const Term& subject : order_) {
      if (!inlined(subject)) describe(subject, 0, 0);
    }
    for (const Term& subject : order_) {  // Cycles of blank nodes to which nothing else refers.
      if (!written_.contains(subject)) describe(subject, 0, 0);
    }
    serd_writer_finish(writer_.get());
    return std::move(text_);
  }

 private:
  [[nodiscard]] bool inlined(const Term& term) const {
    if (!turtle_ || term.kind != TermKind::Blank) return false;
    const auto uses = uses_.find(term);
    return uses != uses_.end() && uses->second == 1;
  }

  void describe(const Term& subject, SerdStatementFlags flags, int depth) {
    written_.insert(subject);
    const auto found = by_subject_.find(subject);
    if (found == by_subject_.end()) return;
    for (const Triple* triple : found->second) write(*triple, flags, depth);
  }

  void write(const Triple& triple, SerdStatementFlags flags, int depth) {
    const Term& object = triple.object;
    const bool nested = inlined(object) && depth < kMaxInline && !written_.contains(object);
    if (nested) flags |= by_subject_.contains(object) ? SERD_ANON_O_BEGIN : SERD_EMPTY_O;
    const std::string subject_text = text_of(triple.subject);
    const std::string object_text = text_of(object);
    const SerdNode s = node(triple.subject, subject_text);
    const SerdNode p = serd_node_from_string(SERD_URI, bytes_of(triple.predicate.value));
    const SerdNode o = node(object, object_text);
    const SerdNode type = serd_node_from_string(SERD_URI, bytes_of(object.datatype));
    const SerdNode language = serd_node_from_string(SERD_LITERAL, bytes_of(object.language));
    serd_writer_write_statement(writer_.get(), flags, nullptr, &s, &p, &o,
                                object.datatype.empty() ? nullptr : &type,
                                object.language.empty() ? nullptr : &language);
    if (!nested || !by_subject_.contains(object)) return;
    describe(object, SERD_ANON_CONT, depth + 1);
    serd_writer_end_anon(writer_.get(), &o);
  }

  [[nodiscard]] std::string text_of(const Term& term) const {
    const bool resolve = term.kind == TermKind::Iri && !turtle_ && !options_.base.empty();
    return resolve ? resolve_iri(term.value, options_.base) : term.value;
  }

  static SerdNode node(const Term& term, const std::string& text) {
    switch (term.kind) {
      case TermKind::Iri:
        return serd_node_from_string(SERD_URI, bytes_of(text));
      case TermKind::Blank:
        return serd_node_from_string(SERD_BLANK, bytes_of(text));
      case TermKind::Literal:
        break;
    }
    SerdNode literal = serd_node_from_string(SERD_LITERAL, bytes_of(text));
    literal.flags = 0;  // No long strings: Serd's reader misreads a quote before an escape in them.
    return literal;
  }

  const WriteOptions& options_;
  const bool turtle_;
  std::string text_;
  std::map<Term, std::vector<const Triple*>> by_subject_;
  std::vector<Term> order_;
  std::map<Term, int> uses_;
  std::set<Term> written_;
  std::unique_ptr<SerdEnv, FreeWriter> env_;
  std::unique_ptr<SerdWriter, FreeWriter> writer_;
};

}  // namespace

Result<std::string> write_graph(const Graph& graph, const WriteOptions& options) {
  for (const Triple& triple : graph) {
    if (auto ok = check(triple); !ok) return pass(ok);
  }
  return Writing(graph, options).run();
}

std::string resolve_iri(const std::string& reference, const std::string& base) {
  SerdURI base_parts{};
  if (serd_uri_parse(bytes_of(base), &base_parts) != SERD_SUCCESS) return reference;
  SerdURI resolved{};
  SerdNode node = serd_node_new_uri_from_string(bytes_of(reference), &base_parts, &resolved);
  if (node.buf == nullptr) return reference;
  std::string text(reinterpret_cast<const char*>(node.buf), node.n_bytes);
  serd_node_free(&node);
  return text;
}

}  // namespace chorus::rdf
