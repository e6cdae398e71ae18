#include "common/base/log.h"

#include <array>
#include <atomic>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <mutex>

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "common/base/line_writer.h"
#include "common/base/log_queue.h"
#include "common/base/shortened.h"

namespace chorus::log {
namespace {

struct LevelName {
  std::string_view name;
  Level level;
  spdlog::level::level_enum in_spdlog;
};

constexpr std::array kLevels{
    LevelName{"debug", Level::Debug, spdlog::level::debug},
    LevelName{"info", Level::Info, spdlog::level::info},
    LevelName{"warn", Level::Warn, spdlog::level::warn},
    LevelName{"error", Level::Error, spdlog::level::err},
};

/// Longest value of a field [bytes]; the reasons of a large registration need a few thousand.
constexpr std::size_t kMaxValue = 8192;
constexpr const char* kTextPattern = "%Y-%m-%dT%H:%M:%S.%eZ %v";
constexpr const char* kJsonPattern = R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ",%v})";

/// Passes formatted lines to the writer.
class QueueSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit QueueSink(LineWriter& writer) : writer_(writer) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    writer_.write(std::string(line.data(), line.size()));
  }
  void flush_() override {}

  LineWriter& writer_;
};

struct Sink {
  spdlog::logger logger{"chorus", std::make_shared<spdlog::sinks::stderr_sink_mt>()};
  std::atomic<Format> format{Format::Text};
  std::atomic<LineWriter*> writer = nullptr;  ///< Set by configure(); never destroyed.
  std::once_flag queued;

  Sink() { logger.set_pattern(kTextPattern, spdlog::pattern_time_type::utc); }
};

/// Never destroyed: objects that outlive main may still want to log.
Sink& sink() {
  static Sink& instance = *new Sink;
  return instance;
}

const LevelName& row_of(Level level) {
  for (const LevelName& row : kLevels) {
    if (row.level == level) return row;
  }
  return kLevels.back();
}

/// A JSON string; bytes that are not UTF-8 become U+FFFD, so a line can always be written.
std::string json_text(std::string_view text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

bool plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_-./:+@%,").find(c) != std::string_view::npos;
}

/// Plain words stay unquoted; a value that could be mistaken for the next field or line is quoted.
std::string as_word(std::string_view text) {
  for (const char c : text) {
    if (!plain(c)) return json_text(text);
  }
  return text.empty() ? "\"\"" : std::string(text);
}

std::string text_line(const LevelName& level, std::string_view name, Fields fields) {
  std::string line(level.name);
  line.resize(6, ' ');  // Room for the longest level name and a space.
  // Event names are our own and may contain spaces, but must not break the line.
  for (const char c : name) line += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  for (const Field& field : fields) {
    line.append(" ").append(field.key).append("=").append(
        as_word(shortened(field.value, kMaxValue)));
  }
  return line;
}

std::string json_members(const LevelName& level, std::string_view name, Fields fields) {
  std::string line = R"("level":)" + json_text(level.name) + R"(,"event":)" + json_text(name);
  for (const Field& field : fields) {
    const bool bare = field.bare && nlohmann::json::accept(field.value);  // JSON has no "nan"
    line.append(",").append(json_text(field.key)).append(":");
    line.append(bare ? field.value : json_text(shortened(field.value, kMaxValue)));
  }
  return line;
}

std::string line_of(const LevelName& level, std::string_view name, Fields fields, Format format) {
  return format == Format::Json ? json_members(level, name, fields)
                                : text_line(level, name, fields);
}

/// The line that says how many lines were dropped.  It does not go through the queue: the writer
/// puts it where they are missing.
std::string gap_line(std::uint64_t lines) {
  const Format format = sink().format.load();
  const LevelName& level = row_of(Level::Warn);
  const std::string text =
      line_of(level, "log lines dropped, nobody read them", {{"lines", lines}}, format);
  spdlog::pattern_formatter formatter(format == Format::Json ? kJsonPattern : kTextPattern,
                                      spdlog::pattern_time_type::utc);
  spdlog::memory_buf_t line;
  formatter.format({"chorus", level.in_spdlog, text}, line);
  return {line.data(), line.size()};
}

constexpr std::chrono::milliseconds kLastPatience{500};

void flush_on_crash(int signal) {
  if (const LineWriter* writer = sink().writer.load())
    writer->flush_in_signal_handler(kLastPatience);
  std::raise(signal);  // SA_RESETHAND: this time the signal ends the process
}

/// Installs the handler only if nothing else, such as a sanitizer, has installed one for the
/// signal.
void watch_for_crash(int signal) {
  struct sigaction now {};
  if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) return;
  struct sigaction ours {};
  ours.sa_handler = flush_on_crash;
  ours.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  ::sigaction(signal, &ours, nullptr);
}

void begin_queue() {
  LineWriterOptions options;
  options.gap = gap_line;
  auto* writer = new LineWriter(std::move(options));
  sink().logger.sinks() = {std::make_shared<QueueSink>(*writer)};
  sink().writer.store(writer);
  std::atexit([] { (void)flush(kLastPatience); });
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) watch_for_crash(signal);
}

}  // namespace

std::string number_text(double value) {
  std::array<char, 32> text{};  // a double's shortest form has at most 24 characters
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} ? std::string(text.data(), end) : std::string("nan");
}

void configure(Level least, Format format) {
  const bool json = format == Format::Json;
  std::call_once(sink().queued, begin_queue);
  sink().format.store(format);
  sink().logger.set_level(row_of(least).in_spdlog);
  sink().logger.set_pattern(json ? kJsonPattern : kTextPattern, spdlog::pattern_time_type::utc);
}

bool is_wanted(Level level) { return sink().logger.should_log(row_of(level).in_spdlog); }

Result<Level> parse_level(std::string_view text) {
  for (const LevelName& row : kLevels) {
    if (row.name == text) return row.level;
  }
  return fail(ErrorCode::InvalidArgument, "log level '" + std::string(text.substr(0, 32)) + "'",
              "use debug, info, warn or error");
}

Result<Format> parse_format(std::string_view text) {
  if (text == "text") return Format::Text;
  if (text == "json") return Format::Json;
  return fail(ErrorCode::InvalidArgument, "log format '" + std::string(text.substr(0, 32)) + "'",
              "use text or json");
}

void event(Level level, std::string_view name, Fields fields) {
  const LevelName& row = row_of(level);
  if (!sink().logger.should_log(row.in_spdlog)) return;
  const std::string line = line_of(row, name, fields, sink().format.load());
  sink().logger.log(row.in_spdlog, spdlog::string_view_t(line.data(), line.size()));
}

bool flush(std::chrono::milliseconds patience) {
  LineWriter* writer = sink().writer.load();
  return writer == nullptr || writer->flush(patience);
}

std::uint64_t dropped_lines() {
  const LineWriter* writer = sink().writer.load();
  return writer == nullptr ? 0 : writer->dropped();
}

}  // namespace chorus::log
