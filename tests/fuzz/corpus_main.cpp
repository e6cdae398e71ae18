// The main function of a fuzz target in an ordinary build: no clang, no search for new paths.
//
//   corpus_NAME MOST_BYTES MUTATED FOLDER
//
// tries every file of FOLDER, and MUTATED inputs made from them by a generator with a fixed seed,
// none longer than MOST_BYTES.  An input that ends the program, takes more than five seconds of
// processor time or a gigabyte of memory is kept as corpus_NAME.input.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

namespace {

constexpr int kMostSeconds = 5;
constexpr rlim_t kMostMemory = rlim_t{1} << 30;
constexpr std::uint32_t kSeed = 20261127;

std::string kept_name;  // where an input that fails is written
std::string input;      // the one that is being tried

// The shadow memory of sanitizers is not ours to bound.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

/// A signal handler: only system calls.
extern "C" void keep_input(int signal) {
  const int file = open(kept_name.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0 && write(file, input.data(), input.size()) >= 0) {
    constexpr std::string_view kSays =
        "this input fails; it is kept beside the program as *.input\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, kSays.data(), kSays.size());
  }
  std::signal(signal, SIG_DFL);
  raise(signal);
}

void set_limits() {
  for (const int one : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGPROF})
    std::signal(one, keep_input);
  if (kSanitized) return;
  const rlimit memory{kMostMemory, kMostMemory};
  setrlimit(RLIMIT_DATA, &memory);
}

void try_input(std::string tried) {
  input = std::move(tried);
  const itimerval allowed{{}, {kMostSeconds, 0}};
  setitimer(ITIMER_PROF, &allowed, nullptr);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

std::vector<std::string> read_seeds(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());  // the same inputs on every machine
  std::vector<std::string> seeds;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return seeds;
}

/// Makes inputs from the seeds.  std::mt19937 gives the same numbers everywhere; distributions do
/// not, so none is used.
struct Mutator {
  const std::vector<std::string>& seeds;
  std::size_t most_bytes = 0;
  std::mt19937 generator{kSeed};

  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : generator() % bound; }

  void change_byte(std::string& text) {
    constexpr std::array<int, 12> kEdges = {0,   1,   0x7f, 0x80, 0xff, '0',
                                            '9', '"', '\n', '{',  '<',  '-'};
    if (text.empty()) return;
    char& byte = text[below(text.size())];
    byte = below(2) == 0 ? static_cast<char>(byte ^ (1 << below(8)))
                         : static_cast<char>(kEdges[below(kEdges.size())]);
  }

  void cut(std::string& text) { text.resize(below(text.size() + 1)); }
  void drop(std::string& text) { text.erase(below(text.size() + 1), 1 + below(16)); }

  void repeat(std::string& text) {
    const std::string part = text.substr(below(text.size() + 1), 1 + below(64));
    text.insert(below(text.size() + 1), part);
  }

  void splice(std::string& text) {
    const std::string& other = seeds[below(seeds.size())];
    text = text.substr(0, below(text.size() + 1)) + other.substr(below(other.size() + 1));
  }

  std::string next() {
    constexpr std::array kKinds = {&Mutator::change_byte, &Mutator::change_byte, &Mutator::drop,
                                   &Mutator::repeat,      &Mutator::splice,      &Mutator::cut};
    std::string text = seeds[below(seeds.size())];
    for (std::size_t left = 1 + below(4); left > 0; --left)
      (this->*kKinds[below(kKinds.size())])(text);
    if (text.size() > most_bytes) text.resize(most_bytes);
    return text;
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: %s MOST_BYTES MUTATED FOLDER\n", argv[0]);
    return 2;
  }
  kept_name = std::string(argv[0]) + ".input";
  const std::vector<std::string> seeds = read_seeds(argv[3]);
  if (seeds.empty()) {
    std::fprintf(stderr, "%s: no file in %s\n", argv[0], argv[3]);
    return 1;
  }
  set_limits();
  for (const std::string& seed : seeds) try_input(seed);
  Mutator mutator{seeds, std::stoul(argv[1])};
  for (unsigned long left = std::stoul(argv[2]); left > 0; --left) try_input(mutator.next());
  return 0;
}
