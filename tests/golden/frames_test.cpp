// Tests what the manifest of proto/golden states about the files in its folders perfect, good and
// bad.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "common/rdf/turtle_reader.h"
#include "common/resource/frame_facts.h"
#include "common/resource/frame_resource.h"
#include "tests/support/graph/isomorphism.h"
#include "tests/unit/resource/frames.h"

namespace chorus::resource {
namespace {

const std::string kFolder = "proto/golden/";

std::string contents(const std::string& path) {
  std::ifstream file(kFolder + path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// What the manifest says about one file.
struct Promise {
  std::string kind;
  std::map<std::string, std::string> said;
};

std::string last_part(const std::string& iri) { return iri.substr(iri.find_last_of("#/") + 1); }

std::map<std::string, Promise> manifest() {
  const auto graph = rdf::read_graph(contents("manifest.ttl"));
  EXPECT_TRUE(graph) << to_string(graph.error());
  std::map<std::string, Promise> files;
  for (const rdf::Triple& triple : graph.value_or(rdf::Graph{})) {
    Promise& promise = files[triple.subject.value];
    if (triple.predicate.value == rdf::rdf("type")) {
      promise.kind = last_part(triple.object.value);
    } else {
      promise.said[last_part(triple.predicate.value)] = triple.object.value;
    }
  }
  return files;
}

std::map<std::string, Promise> all_of(const std::string& kind) {
  std::map<std::string, Promise> found;
  for (const auto& [file, promise] : manifest()) {
    if (promise.kind == kind) found[file] = promise;
  }
  EXPECT_FALSE(found.empty()) << kind;
  return found;
}

std::string with_extension(const std::string& file, const std::string& extension) {
  return file.substr(0, file.find_last_of('.')) + extension;
}

TEST(Golden, TheManifestListsEveryFileAndNoOther) {
  std::set<std::string> listed;
  for (const auto& [file, promise] : manifest()) listed.insert(file);
  std::set<std::string> there;
  for (const std::string folder : {"perfect", "good", "bad"}) {
    for (const auto& entry : std::filesystem::directory_iterator(kFolder + folder)) {
      const std::string name = entry.path().filename();
      if (name.ends_with(".ttl") && !name.ends_with(".arvida.ttl"))
        there.insert(folder + "/" + name);
    }
  }
  EXPECT_EQ(listed, there);
}

TEST(Golden, PerfectIsWrittenBackByteForByte) {
  for (const auto& [file, promise] : all_of("Perfect")) {
    const std::string turtle = contents(file);
    const auto frame = read_frame(turtle, Format::Turtle);
    ASSERT_TRUE(frame) << file << ": " << to_string(frame.error());
    EXPECT_EQ(write(*frame, Format::Turtle), turtle) << file;
    EXPECT_EQ(write(*frame, Format::NTriples), contents(with_extension(file, ".nt"))) << file;
    EXPECT_EQ(write(*frame, Format::Json), contents(with_extension(file, ".json"))) << file;
    EXPECT_EQ(write(*frame, Format::JsonLd), contents(with_extension(file, ".jsonld"))) << file;
    EXPECT_EQ(write_arvida(*frame), contents(with_extension(file, ".arvida.ttl"))) << file;
  }
}

TEST(Golden, PerfectIsTheSameFrameInEveryFormat) {
  for (const auto& [file, promise] : all_of("Perfect")) {
    const auto turtle = read_frame(contents(file), Format::Turtle);
    ASSERT_TRUE(turtle);
    for (const auto& [extension, format] : {std::pair{".json", Format::Json},
                                            {".jsonld", Format::JsonLd},
                                            {".nt", Format::NTriples}}) {
      const auto other = read_frame(contents(with_extension(file, extension)), format);
      ASSERT_TRUE(other) << file << extension << ": " << to_string(other.error());
      EXPECT_EQ(difference(*turtle, *other), "") << file << extension;
    }
    const std::string json = contents(with_extension(file, ".json"));
    const auto parsed = read_json_frame(json);
    const auto fast = read_json_template(json);
    ASSERT_TRUE(parsed && fast) << file << ": both JSON readers know what we write";
    EXPECT_EQ(difference(*parsed, *fast), "") << file;
    rdf::ReadOptions options;
    options.base = "http://localhost/";
    const auto triples =
        rdf::read_graph(contents(with_extension(file, ".nt")), {rdf::Syntax::NTriples, {}, {}});
    EXPECT_EQ(testing::difference(*rdf::read_graph(contents(file), options), *triples), "") << file;
  }
}

TEST(Golden, GoodIsTheSameValueAsItsTwin) {
  for (const auto& [file, promise] : all_of("Good")) {
    const std::string text = contents(file);
    const auto frame = read_frame(text, Format::Turtle);
    ASSERT_TRUE(frame) << file << ": " << to_string(frame.error());
    const auto twin = read_frame(contents(promise.said.at("twin")), Format::Turtle);
    ASSERT_TRUE(twin);
    EXPECT_EQ(difference(*frame, *twin), "") << file;
    EXPECT_FALSE(read_template(text)) << file << " is no other spelling: it shows nothing";
  }
}

TEST(Golden, BadIsRefusedWithAMessage) {
  for (const auto& [file, promise] : all_of("Bad")) {
    const auto frame = read_frame(contents(file), Format::Turtle);
    ASSERT_FALSE(frame) << file;
    const std::string message = to_string(frame.error());
    EXPECT_FALSE(frame.error().message.empty()) << file;
    EXPECT_LT(message.size(), 500U) << file;
    EXPECT_NE(message.find(promise.said.at("says")), std::string::npos)
        << file << " says: " << message;
  }
}

TEST(Golden, WhatIsLongerThanTwoMegabytesIsRefused) {
  for (const Format format : kFormats) {
    const auto frame = read_frame(std::string(2'000'001, ' '), format);
    ASSERT_FALSE(frame);
    EXPECT_EQ(frame.error().code, ErrorCode::TooLarge);
  }
}

TEST(Golden, NoTruncationIsTakenForAFrame) {
  for (const auto& [extension, format] :
       {std::pair{".ttl", Format::Turtle}, {".json", Format::Json}, {".jsonld", Format::JsonLd}}) {
    const std::string whole = contents(std::string("perfect/one-body") + extension);
    for (std::size_t size = 0; size + 2 < whole.size(); size += 7) {
      const auto frame = read_frame(whole.substr(0, size), format);
      // Turtle cut off between two subjects is still a document, but never has a whole body.
      EXPECT_FALSE(frame) << extension << " cut at " << size;
    }
  }
}

TEST(Golden, AReplacedByteCrashesNothing) {
  const std::string whole = contents("perfect/one-body.ttl");
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    for (const char byte : {'"', '<', '[', '\\', '\0', '\x80', ' ', '9'}) {
      std::string changed = whole;
      changed[at] = byte;
      const auto fast = read_template(changed);
      const auto parsed = read_rdf_frame(changed, Format::Turtle);
      if (!fast) continue;
      ASSERT_TRUE(parsed) << "what the template reader takes, the parser takes; byte " << at << ": "
                          << to_string(parsed.error());
      EXPECT_EQ(difference(*fast, *parsed), "") << "byte " << at;
    }
  }
}

}  // namespace
}  // namespace chorus::resource
