// What a server answers while `chorus register` runs, and the command run with it.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/unit/ctl/program_run.h"
#include "tests/unit/ctl/scripted_server.h"

namespace chorus::ctl {

inline constexpr const char* kIdle =
    R"({"verdict": "Good", "master": "s1", "session": {"state": "idle"}})";
inline constexpr const char* kRuns =
    R"({"verdict": "Good", "session": {"state": "collecting", "progress": "/sessions/7"}})";

inline std::string session(const std::string& state, const std::string& verdict, bool adopted,
                           double elapsed = 1.0) {
  return nlohmann::json{{"state", state},
                        {"verdict", verdict},
                        {"adopted", adopted},
                        {"elapsedSeconds", elapsed},
                        {"targetSeconds", 2.0},
                        {"reasons", {"the walk lasted only 2 s"}},
                        {"awaits", {"walk in front of s2"}}}
      .dump();
}

inline ScriptedServer::Texts walk(const std::string& last) {
  return {{"/registration", {kRuns, kIdle}},
          {"/sessions/7", {session("collecting", "None", false), last}}};
}

inline Outcome register_at(const ScriptedServer& server, std::vector<std::string> more = {}) {
  std::vector<std::string> words{"register", "--url", server.url()};
  words.insert(words.end(), more.begin(), more.end());
  return run_chorus(words);
}

}  // namespace chorus::ctl
