#include "fusion-server/dtrack/dtrack_commands.h"

#include <array>

namespace chorus::dtrack {
namespace {

constexpr std::string_view kOk = "dtrack2 ok";

struct Command {
  std::string_view text;
  bool whole;    ///< True: the command must equal the text; false: it must begin with it.
  bool control;  ///< True: only the connection in control may send it.
  std::string_view (*obey)(const Conversation& conversation, Device& device);
};

std::string_view ok(const Conversation& /*conversation*/, Device& /*device*/) { return kOk; }

std::string_view access(const Conversation& conversation, Device& /*device*/) {
  return conversation.in_control ? "dtrack2 set system access full"
                                 : "dtrack2 set system access none";
}

std::string_view start(const Conversation& /*conversation*/, Device& device) {
  device.measuring = true;
  return kOk;
}

std::string_view stop(const Conversation& /*conversation*/, Device& device) {
  device.measuring = false;
  return kOk;
}

std::string_view active(const Conversation& /*conversation*/, Device& device) {
  return device.measuring ? "dtrack2 set status active mea" : "dtrack2 set status active none";
}

std::string_view configuration(const Conversation& /*conversation*/, Device& /*device*/) {
  return "dtrack2 set config active_config standard";
}

constexpr std::array<Command, 7> kCommands{{
    {"dtrack2 get system access", true, false, access},
    {"dtrack2 tracking start", true, true, start},
    {"dtrack2 tracking stop", true, true, stop},
    {"dtrack2 get status active", true, false, active},
    {"dtrack2 get config active_config", true, false, configuration},
    {"dtrack2 getmsg", true, false, ok},
    {"dtrack2 set ", false, true, ok},
}};

std::string_view obey(std::string_view command, Conversation& conversation, Device& device) {
  for (const Command& known : kCommands) {
    if (known.whole ? command != known.text : !command.starts_with(known.text)) continue;
    if (known.control && !conversation.in_control) {
      ++conversation.refused;
      return "dtrack2 err 2 \"another connection is in control\"";
    }
    ++conversation.answered;
    return known.obey(conversation, device);
  }
  ++conversation.refused;
  return "dtrack2 err 1 \"unknown command\"";
}

}  // namespace

bool CommandReader::feed(std::string_view bytes) {
  // One read may bring many commands; only the last one may be incomplete.
  bytes_ += bytes;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = bytes_.find('\0', begin);
    const std::size_t length = (end == std::string::npos ? bytes_.size() : end) - begin;
    if (length > kMaxCommandBytes) return false;
    if (end == std::string::npos) return true;
    begin = end + 1;
  }
}

bool CommandReader::next(std::string& command) {
  const std::size_t end = bytes_.find('\0');
  if (end == std::string::npos) return false;
  command.assign(bytes_, 0, end);
  bytes_.erase(0, end + 1);
  return true;
}

std::string answer(std::string_view command, Conversation& conversation, Device& device) {
  return std::string(obey(command, conversation, device)) + '\0';
}

}  // namespace chorus::dtrack
