#include "services/sensor/device/bridge/push_message.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/not_seen.h"
#include "common/geometry/rotation.h"
#include "common/sensor/limits.h"
#include "common/sensor/pixel_ray.h"
#include "services/sensor/device/bridge/body_checks.h"
#include "services/sensor/device/bridge/json_value.h"
#include "services/sensor/device/bridge/pushed_orientations.h"

namespace chorus::bridge {
namespace {

using Json = nlohmann::json;
using layout::Landmark;

constexpr double kMaxVariance = 1e8;  // [m^2]
constexpr double kMaxShape = 10.0;    // Limit of a coordinate in a shape [m].
constexpr JsonLimits kLimits{.bytes = 2'000'000, .nesting = 8};

/// An image defines what "right" and "down" are, whatever the axes of the pusher's points are.
Eigen::Matrix3d sensor_from_image() { return Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal(); }

/// What an element states in addition to the landmark's place.
struct Sureness {
  double confidence = 1.0;
  std::optional<JointState> state;
};

/// An element of `points` or `pixels`: [place..., confidence], or {"at": [place...], ...}.
template <std::size_t N>
struct Element {
  std::array<double, N> place{};
  Sureness sure;
  const Json* object = nullptr;  ///< The element itself, if it is a JSON object.
};

Result<JointState> read_state(const Json& value, const At& at) {
  for (const auto& [name, state] :
       {std::pair{"Tracked", JointState::Tracked}, std::pair{"Inferred", JointState::Inferred},
        std::pair{"NotTracked", JointState::NotTracked}}) {
    if (value == name) return state;
  }
  return wrong(at, "must be \"Tracked\", \"Inferred\" or \"NotTracked\"");
}

Result<Sureness> read_sureness(const Json& object, const At& at) {
  Sureness sure;
  if (const Json* confidence = find(object, "confidence")) {
    const auto number = read_number(*confidence, {0.0, 1.0}, at["confidence"]);
    if (!number) return pass(number);
    sure.confidence = *number;
  }
  if (const Json* named = find(object, "state")) {
    const auto state = read_state(*named, at["state"]);
    if (!state) return pass(state);
    sure.state = *state;
  }
  return sure;
}

template <std::size_t N>
Result<Element<N>> read_object_element(const Json& value, Bounds bounds, const At& at) {
  Element<N> element;
  element.object = &value;
  const Json* place = find(value, "at");
  if (place == nullptr) return wrong(at["at"], "is missing");
  if (const auto ok = read_numbers(*place, element.place, bounds, at["at"]); !ok) return pass(ok);
  const auto sure = read_sureness(value, at);
  if (!sure) return pass(sure);
  element.sure = *sure;
  return element;
}

template <std::size_t N>
Result<Element<N>> read_element(const Json& value, Bounds bounds, const At& at) {
  if (value.is_object()) return read_object_element<N>(value, bounds, at);
  Element<N> element;
  if (!value.is_array() || (value.size() != N && value.size() != N + 1)) {
    return wrong(at, fmt::format("must be [{}], the same with a confidence behind it, an object "
                                 "with \"at\", or null",
                                 N == 3 ? "x, y, z" : "u, v"));
  }
  for (std::size_t i = 0; i < N; ++i) {
    const auto number = read_number(value[i], bounds, at[i]);
    if (!number) return pass(number);
    element.place[i] = *number;
  }
  if (value.size() == N) return element;
  const auto confidence = read_number(value[N], {0.0, 1.0}, at[N]);
  if (!confidence) return pass(confidence);
  element.sure.confidence = *confidence;
  return element;
}

JointState state_of(const Sureness& sure, const Hello& hello) {
  return sure.state.value_or(
      layout::state_of(sure.confidence, hello.tracked_from, hello.inferred_from));
}

Result<Covariance> read_covariance(const Json& value, const Hello& hello, const At& at) {
  std::array<double, Covariance::kTerms> upper{};
  const Bounds bounds{-kMaxVariance, kMaxVariance};
  if (const auto ok = read_numbers(value, upper, bounds, at); !ok) return pass(ok);
  const Covariance covariance = Covariance(upper).turned(hello.sensor_from_pusher);
  if (covariance.plausible()) return covariance;
  return wrong(at, "must be [xx, xy, xz, yy, yz, zz] in m^2 without a negative variance");
}

/// The place in an element of `points` or `pixels`.
const Json& place_in(const Json& value) {
  const Json* at = value.is_object() ? find(value, "at") : nullptr;
  return at != nullptr ? *at : value;
}

/// Whether an element is null, or has null for a number, as NaN is read.
bool is_unseen(const Json& value) {
  const Json& place = place_in(value);
  return place.is_null() || (place.is_array() &&
                             std::ranges::any_of(place, [](const Json& x) { return x.is_null(); }));
}

/// Whether an element is [0, 0, 0], which many programs send for what they did not see.
bool is_zero(const Json& value) {
  const Json& place = place_in(value);
  return place.is_array() && place.size() >= 3 &&
         std::all_of(place.begin(), place.begin() + 3, [](const Json& x) { return x == 0; });
}

std::size_t zeros_in(const Json* points) {
  if (points == nullptr) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(*points, is_zero));
}

Result<Landmark> read_point(const Json& value, const Hello& hello, const At& at) {
  if (is_unseen(value)) return Landmark{};
  const auto element = read_element<3>(value, {-kMaxCoordinate, kMaxCoordinate}, at);
  if (!element) return pass(element);
  if (is_nowhere(element->place)) return Landmark{};
  const auto& [x, y, z] = element->place;
  Landmark landmark{hello.sensor_from_pusher * Eigen::Vector3d(x, y, z),
                    state_of(element->sure, hello)};
  if (element->object == nullptr) return landmark;
  if (const Json* covariance = find(*element->object, "covariance")) {
    const auto known = read_covariance(*covariance, hello, at["covariance"]);
    if (!known) return pass(known);
    landmark.covariance = *known;
  }
  return landmark;
}

Result<Landmark> read_pixel(const Json& value, const Hello& hello, const At& at) {
  if (is_unseen(value)) return Landmark{};
  const auto element = read_element<2>(value, {-kMaxPixels, kMaxPixels}, at);
  if (!element) return pass(element);
  std::optional<double> sigma = hello.pixel_sigma;
  if (const Json* own = element->object != nullptr ? find(*element->object, "sigma") : nullptr) {
    const auto number = read_number(*own, {0.01, 1000.0}, at["sigma"]);
    if (!number) return pass(number);
    sigma = *number;
  }
  const auto ray = ray_of({element->place[0], element->place[1]}, *hello.camera);
  if (!ray) return Landmark{};
  Landmark landmark{sensor_from_image() * *ray, state_of(element->sure, hello), Measurement::Ray};
  if (sigma)
    landmark.covariance =
        Covariance(ray_covariance(*ray, *hello.camera, *sigma)).turned(sensor_from_image());
  return landmark;
}

/// Reads the position of a landmark of `world`; its state and its error are those of its pixel.
Result<Landmark> read_shape_point(const Json& value, const Hello& /*hello*/, const At& at) {
  if (is_unseen(value)) return Landmark{};
  const auto element = read_element<3>(value, {-kMaxShape, kMaxShape}, at);
  if (!element) return pass(element);
  const auto& [x, y, z] = element->place;
  return Landmark{sensor_from_image() * Eigen::Vector3d(x, y, z), JointState::Tracked};
}

using ReadLandmark = Result<Landmark> (*)(const Json&, const Hello&, const At&);

/// Reads landmarks by name: {"LEFT_HIP": ..., ...}
Result<std::vector<Landmark>> read_named(const Json& value, ReadLandmark read, const Hello& hello,
                                         const At& at) {
  std::vector<Landmark> landmarks(hello.layout->landmarks.size());
  for (const auto& [name, one] : value.items()) {
    const auto index = landmark_named(*hello.layout, name);
    if (!index) {
      return wrong(at[name], fmt::format("{} has no such landmark; it has {}", hello.layout->name,
                                         fmt::join(hello.layout->landmarks, ", ")));
    }
    const auto landmark = read(one, hello, at[name]);
    if (!landmark) return pass(landmark);
    landmarks[*index] = *landmark;
  }
  return landmarks;
}

Result<std::vector<Landmark>> read_landmarks(const Json& value, ReadLandmark read,
                                             const Hello& hello, const At& at) {
  const std::size_t count = hello.layout->landmarks.size();
  if (value.is_object()) return read_named(value, read, hello, at);
  if (!value.is_array() || value.size() != count) {
    return wrong(at, fmt::format("must be an array of {} landmarks in the order of {}, null for "
                                 "those not seen, or an object of them by name",
                                 count, hello.layout->name));
  }
  std::vector<Landmark> landmarks;
  landmarks.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto landmark = read(value[i], hello, at[i]);
    if (!landmark) return pass(landmark);
    landmarks.push_back(*landmark);
  }
  return landmarks;
}

struct PushedBody {
  BodyFrame body;
  Skeleton<SensorSpace> shape;
  std::optional<bool> outside_picture;
};

/// The members of a body that state where its landmarks are.
struct Places {
  const Json* points = nullptr;
  const Json* pixels = nullptr;
  const Json* world = nullptr;
};

Result<Places> places_of(const Json& body, const Hello& hello, const At& at) {
  const Places places{find(body, "points"), find(body, "pixels"), find(body, "world")};
  if ((places.points == nullptr) == (places.pixels == nullptr))
    return wrong(at, "must have either \"points\" [m] or \"pixels\"");
  if (places.pixels != nullptr && !hello.camera)
    return wrong(at["pixels"], "mean nothing without \"intrinsics\" in the hello");
  if (places.world != nullptr && places.pixels == nullptr)
    return wrong(at["world"], "is the shape to \"pixels\"; \"points\" need none");
  return places;
}

/// The joints made of the landmarks, if the message has any.
Result<Skeleton<SensorSpace>> read_joints(const Json* value, ReadLandmark read, const Hello& hello,
                                          const At& at) {
  if (value == nullptr) return Skeleton<SensorSpace>{};
  const auto landmarks = read_landmarks(*value, read, hello, at);
  if (!landmarks) return pass(landmarks);
  return Skeleton<SensorSpace>{layout::joints_of(*hello.layout, *landmarks)};
}

/// Rays do not tell how the head is turned, but the shape does: networks see it as from where the
/// line of sight runs straight ahead.
void turn_head(const Skeleton<SensorSpace>& shape, Skeleton<SensorSpace>& body) {
  Joint& head = body[JointId::Head];
  const Joint& shaped = shape[JointId::Head];
  if (!head.bears() || !is_unit(shaped.orientation)) return;
  head.orientation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), head.position) *
                     shaped.orientation;
}

Result<PushedBody> read_body(const Json& value, const Hello& hello, const At& at) {
  if (!value.is_object())
    return wrong(at, "must be an object with \"id\" and \"points\" or \"pixels\"");
  const Json* id = find(value, "id");
  if (id == nullptr) return wrong(at["id"], "is missing; number the bodies, one number a person");
  const auto number = read_whole(*id, at["id"]);
  if (!number) return pass(number);
  const auto places = places_of(value, hello, at);
  if (!places) return pass(places);
  const auto joints = places->points != nullptr
                          ? read_joints(places->points, &read_point, hello, at["points"])
                          : read_joints(places->pixels, &read_pixel, hello, at["pixels"]);
  if (!joints) return pass(joints);
  if (const auto ok = check_distance(*joints, at["points"]); !ok) return pass(ok);
  const auto pixels =
      places->pixels != nullptr ? pixels_given(*places->pixels) : std::vector<Eigen::Vector2d>();
  if (const auto ok = check_pixels(pixels, at["pixels"]); !ok) return pass(ok);
  const auto shape = read_joints(places->world, &read_shape_point, hello, at["world"]);
  if (!shape) return pass(shape);
  PushedBody out{{BodyId{*number}, {}, *joints}, *shape, {}};
  if (hello.camera) out.outside_picture = outside_picture(pixels, *hello.camera);
  // The error of the focal length is common to all landmarks, so it is added to joints: the mean of
  // two landmarks must not make it smaller.
  for (Joint& joint : out.body.skeleton.joints) widen_ray(joint, hello.focal_sigma);
  turn_head(out.shape, out.body.skeleton);
  return out;
}

bool empty(const PushedBody& one) {
  return std::ranges::none_of(one.body.skeleton.joints, &Joint::given);
}

/// Reads all bodies and their shapes; leaves out those without joints.
Result<void> read_bodies(const Json& value, const Hello& hello, PushedFrame& out) {
  const At at = At{}["bodies"];
  if (!value.is_array() || value.size() > kMaxBodies)
    return wrong(
        at, fmt::format("must be an array of at most {}; [] when nobody is there", kMaxBodies));
  std::vector<BodyId> ids;
  for (std::size_t i = 0; i < value.size(); ++i) {
    auto one = read_body(value[i], hello, at[i]);
    if (!one) return pass(one);
    if (std::find(ids.begin(), ids.end(), one->body.id) != ids.end())
      return wrong(at[i]["id"], "two bodies of one frame have this id");
    ids.push_back(one->body.id);
    out.zeros += zeros_in(find(value[i], "points"));
    if (empty(*one)) continue;
    one->body.captured = out.captured;
    out.bodies.push_back(std::move(one->body));
    out.shapes.push_back(one->shape);
    if (one->outside_picture)
      out.outside_picture = out.outside_picture.value_or(true) && *one->outside_picture;
  }
  return {};
}

Result<PushedFrame> read_frame(const Json& message, const Hello& hello) {
  PushedFrame frame;
  const auto heading = read_heading(message);
  if (!heading) return pass(heading);
  frame.captured = heading->captured;
  frame.sequence = heading->sequence;
  if (const Json* floor = find(message, "floor")) {
    const auto plane = read_floor(*floor, hello.sensor_from_pusher);
    if (!plane) return pass(plane);
    frame.floor = *plane;
  }
  const Json* bodies = find(message, "bodies");
  if (bodies == nullptr) return wrong(At{}["bodies"], "is missing; [] when nobody is there");
  if (const auto ok = read_bodies(*bodies, hello, frame); !ok) return pass(ok);
  return frame;
}

Result<ClockAnswer> read_clock(const Json& message) {
  std::array<Timestamp, 3> stamps{};
  const std::array<const char*, 3> keys{"sent", "received", "answered"};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Json* value = find(message, keys[i]);
    if (value == nullptr) return wrong(At{}[keys[i]], "is missing");
    const auto stamp = read_stamp(*value, At{}[keys[i]]);
    if (!stamp) return pass(stamp);
    stamps[i] = *stamp;
  }
  return ClockAnswer{stamps[0], stamps[1], stamps[2]};
}

/// The message; NaN and the like in it count as null, which JSON does not have.
Result<Json> parsed(std::string_view text) {
  auto message = parse_json(text, kLimits);
  if (message || message.error().code != ErrorCode::Malformed) return message;
  auto again = parse_json(null_for_nan(text), kLimits);
  return again ? again : message;
}

}  // namespace

Result<PushMessage> read_push_message(std::string_view text, const Hello* hello) {
  const auto message = parsed(text);
  if (!message) return pass(message);
  const Json* type = message->is_object() ? find(*message, "type") : nullptr;
  const auto into = [](auto&& read) { return PushMessage(std::move(read)); };
  if (type != nullptr && *type == "hello") return read_hello(*message).map(into);
  if (type != nullptr && *type == "clock") return read_clock(*message).map(into);
  const bool worn = type != nullptr && *type == "orientations";
  if (type == nullptr || (*type != "frame" && !worn))
    return wrong(At{}["type"],
                 "each line is an object whose type is \"hello\", \"frame\", "
                 "\"orientations\" or \"clock\"");
  if (hello == nullptr)
    return fail(ErrorCode::Conflict, "type", "say hello before the first frame (proto/bridge.md)");
  if (worn) return read_pushed_orientations(*message).map(into);
  return read_frame(*message, *hello).map(into);
}

}  // namespace chorus::bridge
