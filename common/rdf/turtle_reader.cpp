#include "common/rdf/turtle_reader.h"

#include <serd/serd.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

#include "common/rdf/utf8.h"

namespace chorus::rdf {
namespace {

std::string_view view_of(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}
std::string_view view_of(const SerdNode* node) { return view_of(node->buf, node->n_bytes); }
std::string_view view_of(const SerdChunk& chunk) { return view_of(chunk.buf, chunk.len); }

struct FreeReader {
  void operator()(SerdReader* reader) const { serd_reader_free(reader); }
  void operator()(SerdEnv* env) const { serd_env_free(env); }
};
using Reader = std::unique_ptr<SerdReader, FreeReader>;
using Env = std::unique_ptr<SerdEnv, FreeReader>;

Env make_env(const std::string& base) {
  if (base.empty()) return Env(serd_env_new(nullptr));
  const SerdNode node = serd_node_from_string(SERD_URI, bytes_of(base));
  return Env(serd_env_new(&node));
}

/// Turns Serd's events into triples.  The expanded names of subject, predicate, object and datatype
/// have one buffer each.
class Events {
 public:
  Events(const ReadOptions& options, const TripleSink& sink)
      : sink_(sink), env_(make_env(options.base)), resolving_(!options.base.empty()) {}

  static SerdStatus on_base(void* self, const SerdNode* uri) {
    auto& events = *static_cast<Events*>(self);
    events.resolving_ = true;
    return serd_env_set_base_uri(events.env_.get(), uri);
  }

  static SerdStatus on_prefix(void* self, const SerdNode* name, const SerdNode* uri) {
    return serd_env_set_prefix(static_cast<Events*>(self)->env_.get(), name, uri);
  }

  // Serd defines the parameter list.
  static SerdStatus on_triple(void* self, SerdStatementFlags, const SerdNode*, const SerdNode* s,
                              const SerdNode* p, const SerdNode* o, const SerdNode* datatype,
                              const SerdNode* language) {
    auto& events = *static_cast<Events*>(self);
    if (events.stopped_ || events.failed())
      return SERD_ERR_UNKNOWN;  // Serd closes open lists before it stops, and reports that here.
    TripleView triple;
    if (!events.expand(s, 0, triple.subject) || !events.expand(p, 1, triple.predicate) ||
        !events.expand(o, 2, triple.object)) {
      return SERD_ERR_BAD_CURIE;
    }
    if (datatype != nullptr && datatype->type != SERD_NOTHING) {
      TermView type;
      if (!events.expand(datatype, 3, type)) return SERD_ERR_BAD_CURIE;
      if (type.value != events.xsd_string_) triple.object.datatype = type.value;
    }
    if (language != nullptr && language->type != SERD_NOTHING) {
      triple.object.language = view_of(language);
    }
    if (events.sink_(triple)) return SERD_SUCCESS;
    events.stopped_ = true;
    return SERD_ERR_UNKNOWN;  // SERD_FAILURE would not stop Serd.
  }

  /// Keeps only the first error, because later ones follow from it.
  static SerdStatus on_error(void* self, const SerdError* error) {
    auto& events = *static_cast<Events*>(self);
    if (events.message_.empty()) {
      std::array<char, 256> text{};
      std::vsnprintf(text.data(), text.size(), error->fmt, *error->args);
      events.message_ = text.data();
      while (!events.message_.empty() && events.message_.back() == '\n') events.message_.pop_back();
      events.line_ = error->line;
    }
    return SERD_SUCCESS;
  }

  [[nodiscard]] bool stopped() const { return stopped_; }
  [[nodiscard]] bool failed() const { return !undeclared_.empty(); }
  [[nodiscard]] Error error(SerdStatus status) const {
    const std::string why =
        !undeclared_.empty() ? "the prefix of '" + undeclared_ + "' is not declared"
        : !message_.empty()  ? message_
                             : reinterpret_cast<const char*>(serd_strerror(status));
    return {ErrorCode::Malformed, line_ > 0 ? "line " + std::to_string(line_) : std::string(), why};
  }
  void set_line(unsigned line) { line_ = line; }
  [[nodiscard]] bool located() const { return line_ > 0; }

 private:
  bool expand(const SerdNode* node, std::size_t slot, TermView& out) {
    switch (node->type) {
      case SERD_LITERAL:
        out = {TermKind::Literal, view_of(node), {}, {}};
        return true;
      case SERD_BLANK:
        out = {TermKind::Blank, view_of(node), {}, {}};
        return true;
      case SERD_URI:
        out = {TermKind::Iri, resolve(node, slot), {}, {}};
        return true;
      case SERD_CURIE:
        return expand_name(node, slot, out);
      default:
        return false;
    }
  }

  bool expand_name(const SerdNode* node, std::size_t slot, TermView& out) {
    SerdChunk prefix{};
    SerdChunk suffix{};
    if (serd_env_expand(env_.get(), node, &prefix, &suffix) != SERD_SUCCESS) {
      undeclared_ = std::string(view_of(node).substr(0, 80));
      return false;
    }
    buffers_[slot].assign(view_of(prefix)).append(view_of(suffix));
    out = {TermKind::Iri, buffers_[slot], {}, {}};
    return true;
  }

  std::string_view resolve(const SerdNode* node, std::size_t slot) {
    if (!resolving_ || serd_uri_string_has_scheme(node->buf)) return view_of(node);
    SerdNode resolved = serd_env_expand_node(env_.get(), node);
    if (resolved.buf == nullptr) return view_of(node);
    buffers_[slot].assign(view_of(&resolved));
    serd_node_free(&resolved);
    return buffers_[slot];
  }

  const TripleSink& sink_;
  Env env_;
  bool resolving_;
  bool stopped_ = false;
  unsigned line_ = 0;
  std::string message_;
  std::string undeclared_;
  const std::string xsd_string_ = xsd("string");
  std::array<std::string, 4> buffers_;
};

Reader make_reader(const ReadOptions& options, Events& events) {
  Reader reader(serd_reader_new(options.syntax == Syntax::Turtle ? SERD_TURTLE : SERD_NTRIPLES,
                                &events, nullptr, Events::on_base, Events::on_prefix,
                                Events::on_triple, nullptr));
  serd_reader_set_strict(reader.get(), true);  // Lax mode would continue after an error.
  serd_reader_set_error_sink(reader.get(), Events::on_error, &events);
  return reader;
}

/// Supplies the document byte by byte and counts its lines.
struct CountedText {
  std::string_view text;
  std::size_t at = 0;
  unsigned line = 1;

  static std::size_t read(void* buf, std::size_t, std::size_t, void* stream) {
    auto& self = *static_cast<CountedText*>(stream);
    if (self.at == self.text.size()) return 0;
    const char c = self.text[self.at++];
    if (c == '\n') ++self.line;
    std::memcpy(buf, &c, 1);
    return 1;
  }
  static int failed(void*) { return 0; }
};

/// Serd does not say on which line an undeclared prefix stands, so this reads the document again
/// and counts lines.
unsigned line_of_failure(std::string_view text, const ReadOptions& options) {
  const TripleSink ignore = [](const TripleView&) { return true; };
  Events events(options, ignore);
  const Reader reader = make_reader(options, events);
  CountedText source{text};
  serd_reader_read_source(reader.get(), CountedText::read, CountedText::failed, &source, nullptr,
                          1);
  return source.line;
}

}  // namespace

Result<void> read_triples(std::string_view text, const ReadOptions& options,
                          const TripleSink& sink) {
  if (auto ok = check_bytes(text, options.limits); !ok) return ok;
  // Serd 0.30 reads past the end of an empty string; a final line feed prevents that.
  const std::string terminated = std::string(text) + '\n';
  Events events(options, sink);
  const Reader reader = make_reader(options, events);
  const SerdStatus status = serd_reader_read_string(reader.get(), bytes_of(terminated));
  if (events.stopped() || (status == SERD_SUCCESS && !events.failed())) return {};
  if (!events.located()) events.set_line(line_of_failure(text, options));
  return tl::unexpected<Error>(events.error(status));
}

Term to_term(const TermView& view) {
  return {view.kind, std::string(view.value), std::string(view.datatype),
          std::string(view.language)};
}

Result<Graph> read_graph(std::string_view text, const ReadOptions& options) {
  Graph graph;
  auto ok = read_triples(text, options, [&graph](const TripleView& triple) {
    graph.push_back({to_term(triple.subject), to_term(triple.predicate), to_term(triple.object)});
    return true;
  });
  if (!ok) return pass(ok);
  return graph;
}

}  // namespace chorus::rdf
