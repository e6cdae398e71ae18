// Internal to common/resource: code that the frame writers share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/resource/frame_resource.h"

namespace chorus::resource {

/// The layouts of the writers and of the template readers.
enum class Style : std::uint8_t { Turtle, Json, JsonLd };

/// What is written of a joint's state: NotTracked, without anything else, unless the position is
/// finite and plausible.
[[nodiscard]] JointState writable_state(const JointResource& joint);

/// True if a prop has a name, a place and an orientation; others are not written.
[[nodiscard]] bool writable(const PropResource& prop);

/// True for 1-64 characters of [A-Za-z0-9_-].
[[nodiscard]] bool is_name(std::string_view text);

/// `text` in quotes, with the escapes that Turtle and JSON share; broken UTF-8 is replaced.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// The names of all sensors, in quotes.
[[nodiscard]] std::vector<std::string> quoted_names(const FrameResource& frame);

[[nodiscard]] std::string_view name_of(JointState state);
[[nodiscard]] std::string_view name_of(SpaceKind space);

/// Between the names of a frame and of a thing that somebody holds in it, in its IRI.
inline constexpr std::string_view kPropMark = "#prop-";

/// Upper bounds of the bytes of one body, and of one joint without its names.
inline constexpr std::size_t kBodyBytes = 16384;
inline constexpr std::size_t kJointBytes = 2048;

[[nodiscard]] std::string write_turtle(const FrameResource& frame, const Place& place);
[[nodiscard]] std::string write_json(const FrameResource& frame, bool linked, const Place& place);
[[nodiscard]] std::string write_turtle_skeleton(const FrameResource& frame,
                                                const BodyResource& body, const Place& place);
[[nodiscard]] std::string write_json_skeleton(const FrameResource& frame, const BodyResource& body,
                                              bool linked, const Place& place);
[[nodiscard]] std::string to_ntriples(const std::string& turtle, const Place& place);

}  // namespace chorus::resource
