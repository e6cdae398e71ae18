// Reads any bytes on DTrack's command channel: however they are split, they give the same commands,
// unless one is too long, and answers of limited size.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "fusion-server/dtrack/dtrack_commands.h"

namespace {

using namespace chorus::dtrack;

void require(bool holds) {
  if (!holds) std::abort();
}

struct Outcome {
  std::vector<std::string> commands;
  bool readable = true;
};

/// Feeds `step` bytes at a time until the stream cannot be read any further.
Outcome read(std::string_view bytes, std::size_t step) {
  Outcome outcome;
  CommandReader reader;
  for (std::size_t at = 0; at < bytes.size() && outcome.readable; at += step) {
    outcome.readable = reader.feed(bytes.substr(at, step));
    std::string command;
    while (outcome.readable && reader.next(command)) {
      require(command.size() <= kMaxCommandBytes);
      require(command.find('\0') == std::string::npos);
      outcome.commands.push_back(command);
    }
  }
  return outcome;
}

void check_answers(const std::vector<std::string>& commands, bool in_control) {
  Conversation conversation{in_control, 0, 0};
  Device device;
  for (const std::string& command : commands) {
    const std::string said = answer(command, conversation, device);
    require(said.size() <= kMaxCommandBytes + 1 && said.find('\0') == said.size() - 1);
    require(said.starts_with("dtrack2 "));
    require(in_control || !device.measuring);
  }
  require(conversation.answered + conversation.refused == commands.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size < 1) return 0;
  const std::string_view text(reinterpret_cast<const char*>(bytes + 1), size - 1);
  const Outcome one_by_one = read(text, 1);
  const Outcome in_steps = read(text, 1 + bytes[0]);
  // A command that is too long ends the stream; commands before it in the same read are not
  // executed.
  require(one_by_one.readable == in_steps.readable);
  if (one_by_one.readable) require(one_by_one.commands == in_steps.commands);
  check_answers(one_by_one.commands, true);
  check_answers(one_by_one.commands, false);
  return 0;
}
