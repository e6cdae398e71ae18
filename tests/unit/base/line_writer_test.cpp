#include "common/base/line_writer.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <sstream>
#include <thread>

namespace chorus {
namespace {

using std::chrono::milliseconds;

/// A pipe that buffers `bytes` bytes; the test decides whether and when it is read.
class Pipe {
 public:
  explicit Pipe(int bytes = 4096) {
    EXPECT_EQ(::pipe(ends_.data()), 0);
    ::fcntl(ends_[1], F_SETPIPE_SZ, bytes);
  }
  ~Pipe() {
    close_reader();
    ::close(ends_[1]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  [[nodiscard]] int writer() const { return ends_[1]; }
  void close_reader() {
    if (ends_[0] >= 0) ::close(ends_[0]);
    ends_[0] = -1;
  }
  /// Reads until `text` has come.
  std::string read_until(const std::string& text) {
    std::string all;
    std::array<char, 4096> bytes{};
    while (all.find(text) == std::string::npos) {
      const ssize_t got = ::read(ends_[0], bytes.data(), bytes.size());
      if (got <= 0) break;
      all.append(bytes.data(), static_cast<std::size_t>(got));
    }
    return all;
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

LineWriterOptions options_for(const Pipe& pipe, std::size_t most_bytes = 1u << 20) {
  LineWriterOptions options;
  options.descriptor = pipe.writer();
  options.most_bytes = most_bytes;
  options.gap = [](std::uint64_t dropped) { return "missing " + std::to_string(dropped) + "\n"; };
  return options;
}

TEST(LineWriter, WritesLinesInTheirOrder) {
  Pipe pipe(65'536);
  LineWriter writer(options_for(pipe));
  for (const char* line : {"a\n", "b\n", "c\n"}) writer.write(line);
  EXPECT_TRUE(writer.flush(milliseconds(5000)));
  EXPECT_EQ(pipe.read_until("c\n"), "a\nb\nc\n");
  EXPECT_EQ(writer.dropped(), 0u);
}

TEST(LineWriter, NobodyWaitsForAReaderWhoDoesNotRead) {
  Pipe pipe;
  LineWriter writer(options_for(pipe, 10'000));
  const std::string line(99, 'x');
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 1000; ++i) writer.write(line + "\n");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  EXPECT_FALSE(writer.flush(milliseconds(50)));
  EXPECT_GE(writer.dropped(), 1000u - 10'000 / 100 - 4096 / 100);
  EXPECT_LE(writer.dropped(), 1000u - 10'000 / 100);
}

struct Told {
  std::uint64_t lines = 0;
  std::uint64_t missing = 0;
};

/// The number of complete lines, and of lines that are reported missing.
Told told_in(const std::string& text) {
  Told told;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    constexpr std::string_view kMissing = "missing ";
    if (line.starts_with(kMissing)) {
      told.missing += std::stoull(line.substr(kMissing.size()));
    } else {
      ++told.lines;
    }
  }
  return told;
}

TEST(LineWriter, TellsWhatIsMissing) {
  constexpr int kWritten = 1000;
  Pipe pipe;
  LineWriter writer(options_for(pipe, 10'000));
  for (int i = 0; i < kWritten; ++i) writer.write(std::string(99, 'x') + "\n");
  ASSERT_GT(writer.dropped(), 0u);
  std::string text;
  Told told;
  while (told.lines + told.missing < kWritten) {  // missing lines are reported at once or in parts
    text += pipe.read_until("\n");
    told = told_in(text.substr(0, text.rfind('\n') + 1));
  }
  EXPECT_EQ(told.missing, writer.dropped());
  EXPECT_EQ(told.lines, kWritten - writer.dropped());
  writer.write("again\n");
  EXPECT_EQ(pipe.read_until("again\n"), "again\n") << "told once";
}

TEST(LineWriter, AReaderThatIsGoneCostsLinesAndNothingElse) {
  Pipe pipe;
  LineWriter writer(options_for(pipe));
  pipe.close_reader();
  writer.write("a\n");
  EXPECT_TRUE(writer.flush(milliseconds(5000)));
  EXPECT_EQ(writer.dropped(), 1u);
}

TEST(LineWriter, EndsWhileItsReaderDoesNotRead) {
  Pipe pipe;
  {
    LineWriter writer(options_for(pipe));
    writer.write(std::string(100'000, '\n'));
  }
  SUCCEED() << "the destructor waits for nobody";
}

}  // namespace
}  // namespace chorus
