// chorus-bench codec: encodes and decodes one frame of six bodies, compared with plain Serd on the
// same triples.
#include <serd/serd.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/rdf/turtle_reader.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_resource.h"
#include "tests/bench/report/report.h"
#include "tests/unit/resource/frames.h"

namespace chorus::bench {
namespace {

using resource::Format;
using resource::FrameResource;
using Microseconds = std::chrono::duration<double, std::micro>;

constexpr std::size_t kBodies = 6;
constexpr int kRounds = 21;
constexpr int kRepeats = 40;

/// Keeps the compiler from removing work whose result is not used.
volatile std::size_t sink = 0;

/// The best of several rounds, each the mean of many runs, because other load can only add time.
class Stopwatch {
 public:
  explicit Stopwatch(std::function<std::size_t()> work) : work_(std::move(work)) {}
  void round() {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kRepeats; ++i) sink = sink + work_();
    best_ =
        std::min(best_, Microseconds(std::chrono::steady_clock::now() - start).count() / kRepeats);
  }
  [[nodiscard]] double best() const { return best_; }

 private:
  std::function<std::size_t()> work_;
  double best_ = std::numeric_limits<double>::infinity();
};

const std::uint8_t* bytes_of(const std::string& text) {
  return reinterpret_cast<const std::uint8_t*>(text.c_str());
}

/// The triples of a document with prefixed names, as a program that uses Serd directly would store
/// them.
class SerdGraph {
 public:
  explicit SerdGraph(const rdf::Graph& graph) : graph_(graph) {
    for (rdf::Triple& triple : graph_) {
      for (rdf::Term* term : {&triple.subject, &triple.predicate, &triple.object}) shorten(*term);
    }
  }

  [[nodiscard]] std::size_t write() const {
    SerdEnv* const env = serd_env_new(nullptr);
    SerdChunk out{};
    constexpr auto kStyle =
        static_cast<SerdStyle>(SERD_STYLE_ABBREVIATED | SERD_STYLE_CURIED | SERD_STYLE_BULK);
    SerdWriter* const writer =
        serd_writer_new(SERD_TURTLE, kStyle, env, nullptr, serd_chunk_sink, &out);
    for (const auto& [name, space] : prefixes_) {
      const SerdNode name_node = serd_node_from_string(SERD_LITERAL, bytes_of(name));
      const SerdNode space_node = serd_node_from_string(SERD_URI, bytes_of(space));
      serd_writer_set_prefix(writer, &name_node, &space_node);
    }
    for (const rdf::Triple& triple : graph_) {
      const SerdNode s = node(triple.subject);
      const SerdNode p = node(triple.predicate);
      const SerdNode o = node(triple.object);
      const SerdNode type = serd_node_from_string(SERD_URI, bytes_of(triple.object.datatype));
      serd_writer_write_statement(writer, 0, nullptr, &s, &p, &o,
                                  triple.object.datatype.empty() ? nullptr : &type, nullptr);
    }
    serd_writer_free(writer);
    const std::size_t size = out.len;
    serd_free(serd_chunk_sink_finish(&out));
    serd_env_free(env);
    return size;
  }

 private:
  void shorten(rdf::Term& term) const {
    for (const auto& [name, space] : prefixes_) {
      if (term.kind == rdf::TermKind::Iri && term.value.starts_with(space)) {
        term.value = name + ":" + term.value.substr(space.size());
        term.language = "curie";  // marks it for node(); IRIs have no language
      }
    }
  }
  static SerdNode node(const rdf::Term& term) {
    if (term.kind != rdf::TermKind::Iri) {
      const bool blank = term.kind == rdf::TermKind::Blank;
      return serd_node_from_string(blank ? SERD_BLANK : SERD_LITERAL, bytes_of(term.value));
    }
    return serd_node_from_string(term.language.empty() ? SERD_URI : SERD_CURIE,
                                 bytes_of(term.value));
  }

  rdf::Graph graph_;
  const std::vector<std::pair<std::string, std::string>> prefixes_{
      {"ch", "https://w3id.org/chorus-tracking/ns#"}, {"xsd", std::string(rdf::kXsd)}};
};

/// Parses with Serd alone and counts triples: the minimum cost for any of its users.
std::size_t parse_with_serd(const std::string& turtle) {
  std::size_t count = 0;
  const auto on_triple = [](void* handle, SerdStatementFlags, const SerdNode*, const SerdNode*,
                            const SerdNode*, const SerdNode*, const SerdNode*, const SerdNode*) {
    ++*static_cast<std::size_t*>(handle);
    return SERD_SUCCESS;
  };
  SerdReader* const reader =
      serd_reader_new(SERD_TURTLE, &count, nullptr, nullptr, nullptr, on_triple, nullptr);
  serd_reader_read_string(reader, bytes_of(turtle));
  serd_reader_free(reader);
  return count;
}

std::size_t bodies_of(const Result<FrameResource>& frame) {
  return frame ? frame->bodies.size() : 0;
}

struct Timed {
  std::string metric;
  Stopwatch ours;
  std::size_t baseline;  ///< Index of the row it is compared with; its own index if there is none.
};

}  // namespace

Result<void> run_codec(Report& report) {
  const FrameResource frame = resource::random_frame(report.seed(), {kBodies, true});
  const std::string turtle = write(frame, Format::Turtle);
  const std::string json = write(frame, Format::Json);
  const auto graph = rdf::read_graph(turtle);
  if (!graph) return pass(graph);
  const SerdGraph serd(*graph);
  std::vector<Timed> all{
      {"serd_write_us", Stopwatch([&] { return serd.write(); }), 0},
      {"serd_parse_us", Stopwatch([&] { return parse_with_serd(turtle); }), 1},
      {"write_us", Stopwatch([&] { return write(frame, Format::Turtle).size(); }), 0},
      {"parse_us", Stopwatch([&] { return bodies_of(read_frame(turtle, Format::Turtle)); }), 1},
      {"parse_any_spelling_us",
       Stopwatch([&] { return bodies_of(resource::read_rdf_frame(turtle, Format::Turtle)); }), 1},
      {"write_arvida_us", Stopwatch([&] { return write_arvida(frame).size(); }), 0},
      {"write_json_us", Stopwatch([&] { return write(frame, Format::Json).size(); }), 0},
      {"write_jsonld_us", Stopwatch([&] { return write(frame, Format::JsonLd).size(); }), 0},
      {"write_ntriples_us", Stopwatch([&] { return write(frame, Format::NTriples).size(); }), 0},
      {"parse_json_us", Stopwatch([&] { return bodies_of(read_frame(json, Format::Json)); }), 1}};
  for (int i = 0; i < (report.quick() ? 3 : kRounds); ++i) {
    for (Timed& timed : all) timed.ours.round();
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool beside = all[i].baseline != i;
    report.row("frame-6-bodies", all[i].metric, all[i].ours.best(), "us", beside ? "serd" : "",
               beside ? all[i].ours.best() / all[all[i].baseline].ours.best() : kNoRatio);
  }
  report.row("frame-6-bodies", "bytes", static_cast<double>(turtle.size()), "B");
  report.row("frame-6-bodies", "triples", static_cast<double>(graph->size()), "");
  report.note("Best of " + std::to_string(kRounds) +
              " rounds; Serd writes the same triples, and parses the same "
              "Turtle but only counts what it finds. parse_us is the template reader, "
              "parse_any_spelling_us what "
              "any other spelling costs.");
  report.condition("the template writes a frame faster than Serd",
                   all[2].ours.best() < all[0].ours.best());
  report.condition("the template reader is faster than Serd",
                   all[3].ours.best() < all[1].ours.best());
  return {};
}

}  // namespace chorus::bench
