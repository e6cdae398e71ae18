#include "services/sensor/sensor_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/resource/node.h"
#include "tests/support/builders.h"
#include "tests/support/served.h"

namespace chorus::sensor_service {
namespace {

using chorus::testing::Answer;
using chorus::testing::get;
using chorus::testing::kFrameInterval;
using chorus::testing::kStart;
using ::testing::HasSubstr;
using ::testing::Not;

class SensorServiceTest : public ::testing::Test {
 protected:
  SensorServiceTest() { service_.add_routes(router_); }

  static ServiceOptions options(std::chrono::steady_clock::time_point* now) {
    ServiceOptions out;
    out.id = chorus::testing::sensor_id("s1");
    out.device = {"simulated", "a <test> device", {}, 30.0};
    out.history.span = kFrameInterval * 5;
    out.serving.run = "0a0b0c";
    out.steady_now = [now] { return *now; };
    return out;
  }

  static Capture capture(int index, std::vector<std::uint64_t> ids = {7}) {
    const Timestamp t = kStart + kFrameInterval * index;
    const auto pose = chorus::testing::ring_sensor(0, 6);
    std::vector<BodyFrame> bodies;
    for (const auto id : ids) {
      bodies.push_back(
          chorus::testing::body_seen_from(pose, chorus::testing::standing_person(), t, id));
    }
    Capture out;
    out.frame = chorus::testing::sensor_frame("s1", t, std::move(bodies));
    out.frame.sequence = static_cast<std::uint64_t>(index + 1);
    return out;
  }

  static std::function<Result<CameraImage>()> image(std::string bytes, int* encoded) {
    return [bytes, encoded]() -> Result<CameraImage> {
      ++*encoded;
      return CameraImage{kStart, {}, "image/png", bytes};
    };
  }

  nlohmann::json json(const std::string& path) {
    return nlohmann::json::parse(get(router_, path).body);
  }

  std::chrono::steady_clock::time_point now_{std::chrono::hours(1)};
  SensorService service_{options(&now_)};
  http::Router router_;
  std::stop_source stop_;
};

TEST_F(SensorServiceTest, BeforeTheFirstCaptureNothingIsReady) {
  EXPECT_EQ(get(router_, "/frame").status, 503);
  EXPECT_EQ(get(router_, "/skeletons/").status, 503);
  EXPECT_EQ(get(router_, "/floor-plane").status, 503);
  EXPECT_EQ(get(router_, "/frames/1").status, 404);
  EXPECT_EQ(get(router_, "/").status, 200) << "what it is, it knows";
  EXPECT_FALSE(service_.health().ready);
}

TEST_F(SensorServiceTest, ACaptureIsTheFrame) {
  service_.on_capture(capture(0));
  const auto frame = json("/frame");
  EXPECT_EQ(frame["sequence"], 1);
  EXPECT_EQ(frame["source"], "s1");
  EXPECT_EQ(frame["capturedNanoseconds"], std::to_string(to_unix_ns(kStart)));
  EXPECT_EQ(frame["bodies"][0]["bodyId"], 7);
  EXPECT_EQ(frame["bodies"][0]["joints"].size(), 25u);
  EXPECT_TRUE(service_.health().ready);
  EXPECT_THAT(get(router_, "/frame").etag, HasSubstr("1.0a0b0c"));
  EXPECT_THAT(get(router_, "/frame").head, HasSubstr("Content-Location: frames/1"));
  EXPECT_EQ(get(router_, "/frame", "").type, "text/turtle") << "the default";
  EXPECT_THAT(get(router_, "/frame", "", "arvida").body, HasSubstr("spatial"));
}

TEST_F(SensorServiceTest, FramesAreKeptThenGoneAndNeverBeforeTheyAre) {
  for (int i = 0; i < 8; ++i) service_.on_capture(capture(i));
  EXPECT_EQ(get(router_, "/frames/3").status, 410);
  EXPECT_THAT(get(router_, "/frames/3").body, HasSubstr("still here is 4"));
  for (int i = 4; i <= 8; ++i) {
    EXPECT_EQ(json("/frames/" + std::to_string(i))["sequence"], i);
  }
  EXPECT_THAT(get(router_, "/frames/5").head, HasSubstr("immutable"));
  for (const char* wrong : {"9", "-1", "x", "1e3", "99999999999999999999999"}) {
    EXPECT_EQ(get(router_, std::string("/frames/") + wrong).status, 404) << wrong;
  }
}

TEST_F(SensorServiceTest, LostFramesAreCountedAndSaid) {
  service_.on_capture(capture(0));
  service_.on_capture(capture(3));
  EXPECT_EQ(service_.counters().lost, 2u);
  EXPECT_EQ(get(router_, "/frames/3").status, 404);
  EXPECT_THAT(get(router_, "/frames/3").body, HasSubstr("lost"));
}

TEST_F(SensorServiceTest, CapturesThatCannotBeTrueAreRefusedAndCounted) {
  service_.on_capture(capture(5));
  Capture backwards = capture(6);
  backwards.frame.captured = kStart;
  service_.on_capture(std::move(backwards));
  service_.on_capture(capture(5));          // the same frame again
  service_.on_capture(capture(6, {7, 7}));  // two bodies with the same id
  std::vector<std::uint64_t> crowd(kMaxBodies + 1);
  for (std::size_t i = 0; i < crowd.size(); ++i) crowd[i] = i;
  service_.on_capture(capture(6, crowd));
  Capture renumbered = capture(7);
  renumbered.frame.sequence = 6;
  service_.on_capture(std::move(renumbered));
  EXPECT_EQ(service_.counters().refused, 5u);
  EXPECT_EQ(service_.counters().captured, 1u);
  EXPECT_EQ(json("/frame")["sequence"], 6);
  service_.on_capture(capture(6));
  EXPECT_EQ(json("/frame")["sequence"], 7) << "a refused capture does no lasting harm";
}

TEST_F(SensorServiceTest, AClockThatWasSetBackIsFollowed) {
  service_.on_capture(capture(0));
  Capture repeated = capture(1);
  repeated.frame.captured = kStart - std::chrono::milliseconds(900);
  service_.on_capture(std::move(repeated));
  EXPECT_EQ(service_.counters().refused, 1u) << "so little is the device's mistake";
  for (int i = 1; i < 4; ++i) {
    Capture back = capture(i);
    back.frame.captured -= std::chrono::seconds(2);
    service_.on_capture(std::move(back));
  }
  EXPECT_EQ(service_.counters().refused, 1u);
  EXPECT_EQ(json("/frame")["sequence"], 4);
}

TEST_F(SensorServiceTest, AClockThatWasSetBackALittleCostsOneFrame) {
  for (int i = 0; i < 20; ++i) service_.on_capture(capture(i));
  for (int i = 20; i < 24; ++i) {
    Capture back = capture(i);
    back.frame.captured -= std::chrono::milliseconds(400);
    service_.on_capture(std::move(back));
  }
  EXPECT_EQ(service_.counters().refused, 1u);
  EXPECT_EQ(service_.counters().captured, 23u);
}

TEST_F(SensorServiceTest, NotANumberBecomesNotTracked) {
  Capture broken = capture(0);
  broken.frame.bodies[0].skeleton[JointId::Head].position.x() = std::nan("");
  service_.on_capture(std::move(broken));
  EXPECT_EQ(json("/frame")["bodies"][0]["joints"]["Head"]["state"], "NotTracked");
  EXPECT_THAT(get(router_, "/frame").body, Not(HasSubstr("nan")));
}

TEST_F(SensorServiceTest, SkeletonsAreListedAndServedOneByOne) {
  service_.on_capture(capture(0, {7, 12}));
  EXPECT_EQ(json("/skeletons/")["contains"], nlohmann::json({"7", "12"}));
  EXPECT_EQ(json("/skeletons/12")["bodyId"], 12);
  EXPECT_EQ(get(router_, "/skeletons/8").status, 404);
  EXPECT_THAT(get(router_, "/skeletons/8").body, HasSubstr("7, 12"));
  EXPECT_THAT(get(router_, "/skeletons/", "text/turtle").head, HasSubstr("BasicContainer"));
}

TEST_F(SensorServiceTest, AnEmptyRoomIsAFrameToo) {
  service_.on_capture(capture(0, {}));
  EXPECT_TRUE(json("/frame")["bodies"].empty());
  EXPECT_THAT(get(router_, "/skeletons/7").body, HasSubstr("no body"));
}

TEST_F(SensorServiceTest, TheFloorPlaneChangesItsETagOnlyWhenItChanges) {
  service_.on_capture(capture(0));
  EXPECT_EQ(get(router_, "/floor-plane").status, 404);
  Capture with_floor = capture(1);
  with_floor.frame.floor = FloorPlane{Eigen::Vector3d(0.0, 0.6, 0.8), 1.25};
  service_.on_capture(std::move(with_floor));
  const Answer first = get(router_, "/floor-plane");
  EXPECT_EQ(nlohmann::json::parse(first.body)["normalZ"], 0.8);
  EXPECT_EQ(nlohmann::json::parse(first.body)["offset"], 1.25);
  service_.on_capture(capture(2));
  EXPECT_EQ(get(router_, "/floor-plane").etag, first.etag) << "kept, not forgotten";
  Capture moved = capture(3);
  moved.frame.floor = FloorPlane{Eigen::Vector3d(0.0, 1.0, 0.0), 1.25};
  service_.on_capture(std::move(moved));
  EXPECT_NE(get(router_, "/floor-plane").etag, first.etag);
  Capture of_another_program = capture(4);
  of_another_program.begins_anew = true;
  service_.on_capture(std::move(of_another_program));
  EXPECT_EQ(get(router_, "/floor-plane").status, 404) << "the floor was that of the one before";
}

TEST_F(SensorServiceTest, ImagesAreOffUntilSomebodyWantsThem) {
  int encoded = 0;
  Capture with_images = capture(0);
  with_images.depth = image("depth bytes", &encoded);
  service_.on_capture(std::move(with_images));
  for (const char* path : {"/images/", "/images/color", "/images/depth"}) {
    EXPECT_EQ(get(router_, path).status, 404);
    EXPECT_THAT(get(router_, path).body, HasSubstr("set images: true"));
  }
  EXPECT_THAT(get(router_, "/").body, Not(HasSubstr("images")));
  service_.show_images(true);
  EXPECT_THAT(get(router_, "/").body, HasSubstr("images/depth"));
  EXPECT_EQ(get(router_, "/images/depth").status, 503) << "not encoded yet, and not on this thread";
  EXPECT_EQ(encoded, 0);
  ASSERT_TRUE(service_.encode_next(stop_.get_token()));
  EXPECT_EQ(get(router_, "/images/color").status, 404) << "this device has no colour camera";
  const Answer depth = get(router_, "/images/depth", "image/*");
  EXPECT_EQ(depth.type, "image/png");
  EXPECT_EQ(depth.body, "depth bytes");
  EXPECT_THAT(depth.head, HasSubstr("</images/>; rel=\"describedby\""));
  EXPECT_THAT(get(router_, "/images/", "text/turtle").body, HasSubstr("366.3"));
  (void)get(router_, "/images/depth", "image/*");
  EXPECT_EQ(encoded, 1) << "encoded once for all clients";
  service_.show_images(false);
  EXPECT_EQ(get(router_, "/images/depth").status, 404);
}

TEST_F(SensorServiceTest, ImagesAreEncodedWhileSomebodyAsksAndElseOnceASecond) {
  service_.show_images(true);
  int encoded = 0;
  const auto captured = [&](int index) {
    Capture with_image = capture(index);
    with_image.depth = image("depth", &encoded);
    service_.on_capture(std::move(with_image));
  };
  now_ += std::chrono::hours(1);
  captured(0);
  ASSERT_TRUE(service_.encode_next(stop_.get_token()));  // the first frame is due at once
  stop_.request_stop();  // from now on encode_next() returns false where it would wait
  captured(1);
  EXPECT_FALSE(service_.encode_next(stop_.get_token())) << "nobody asked";
  now_ += std::chrono::milliseconds(1001);
  EXPECT_TRUE(service_.encode_next(stop_.get_token())) << "a second has passed";
  captured(2);
  (void)get(router_, "/images/depth", "image/*");
  EXPECT_TRUE(service_.encode_next(stop_.get_token())) << "somebody asked";
  EXPECT_FALSE(service_.encode_next(stop_.get_token())) << "the same capture is encoded once";
  EXPECT_EQ(encoded, 3);
}

TEST_F(SensorServiceTest, AnEncoderThatFailsIsAnErrorNotACrash) {
  service_.show_images(true);
  Capture broken = capture(0);
  broken.depth = []() -> Result<CameraImage> { throw std::runtime_error("no memory"); };
  broken.color = []() -> Result<CameraImage> { return fail(ErrorCode::Unavailable, "x", "later"); };
  service_.on_capture(std::move(broken));
  ASSERT_TRUE(service_.encode_next(stop_.get_token()));
  EXPECT_EQ(get(router_, "/images/depth").status, 500);
  EXPECT_EQ(get(router_, "/images/color").status, 503);
  EXPECT_EQ(get(router_, "/images/").status, 200) << "a list without images";
}

TEST_F(SensorServiceTest, AnEncoderThatThrowsAnythingIsAnErrorToo) {
  service_.show_images(true);
  Capture broken = capture(0);
  broken.depth = []() -> Result<CameraImage> { throw 7; };
  service_.on_capture(std::move(broken));
  ASSERT_TRUE(service_.encode_next(stop_.get_token()));
  EXPECT_EQ(get(router_, "/images/depth").status, 500);
}

TEST_F(SensorServiceTest, AnExceptionCostsOneCaptureAndIsCounted) {
  ServiceOptions fragile = options(&now_);
  int recorded = 0;
  fragile.record = [&](const LatestCapture&) {
    if (++recorded == 2) throw std::runtime_error("no memory");
  };
  SensorService service(fragile);
  for (int i = 0; i < 4; ++i) service.on_capture(capture(i));
  EXPECT_EQ(service.counters().failures, 1u);
  EXPECT_EQ(service.counters().captured, 4u);
  EXPECT_EQ(recorded, 4);
}

TEST_F(SensorServiceTest, ASilentDeviceIsNotHealthyUntilItSpeaksAgain) {
  service_.on_capture(capture(0));
  now_ += std::chrono::milliseconds(1900);
  EXPECT_TRUE(service_.health().ready);
  now_ += std::chrono::milliseconds(200);
  EXPECT_FALSE(service_.health().ready);
  EXPECT_THAT(service_.health().reason, HasSubstr("silent for 2 s"));
  service_.on_capture(capture(1));
  EXPECT_TRUE(service_.health().ready);
}

TEST_F(SensorServiceTest, ADeviceThatFailedIsNamed) {
  service_.on_capture(capture(0));
  service_.on_device_end(fail(ErrorCode::Io, "usb", "unplugged"));
  EXPECT_FALSE(service_.health().ready);
  EXPECT_THAT(service_.health().reason, HasSubstr("unplugged"));
}

TEST_F(SensorServiceTest, ItSaysWhatItIsToMachinesAndPeople) {
  const auto self = json("/");
  EXPECT_EQ(self["sensorId"], "s1");
  EXPECT_EQ(self["deviceKind"], "simulated");
  for (const char* path : {"frame", "skeletons/", "floor-plane", "clock", "ns", "shapes"}) {
    EXPECT_THAT(self["contains"].dump(), HasSubstr(path));
  }
  const Answer page = get(router_, "/", "text/html,application/xhtml+xml,*/*;q=0.8");
  EXPECT_EQ(page.type, "text/html");
  EXPECT_THAT(page.head, HasSubstr("text/html; charset=utf-8"));
  EXPECT_THAT(page.body, HasSubstr("a &lt;test&gt; device"));
  EXPECT_THAT(page.body, Not(HasSubstr("<test>")));
  EXPECT_EQ(get(router_, "/", "").type, "text/turtle");
}

TEST_F(SensorServiceTest, EveryWordOfItsDocumentsIsDeclared) {
  const auto node = service::self_node(self_of(options(&now_), true));
  EXPECT_THAT(resource::undeclared_terms(node), ::testing::IsEmpty());
}

/// A device that yields what worn sensors say, and perhaps bodies too.
struct Worn {
  explicit Worn(bool bodies) : service(options(bodies)) { service.add_routes(router); }
  ServiceOptions options(bool bodies) {
    ServiceOptions out;
    out.id = chorus::testing::sensor_id("suit");
    out.device = {"inertial", "a suit", {}, 100.0};
    out.device.bodies = bodies;
    out.device.orientations = true;
    out.steady_now = [this] { return now; };
    out.record_orientations = [this](const service::OrientationsPtr& one) {
      recorded += one->instants.size();
    };
    return out;
  }
  void say(std::uint64_t sequence, Duration at) {
    now = std::chrono::steady_clock::time_point(std::chrono::hours(1)) + at;
    inertial::InertialFrame instant{
        chorus::testing::sensor_id("suit"), sequence, kStart + at, {}, {}};
    instant.readings.push_back({"pelvis", instant.captured});
    service.on_orientations(std::move(instant));
  }

  std::chrono::steady_clock::time_point now{std::chrono::hours(1)};
  std::size_t recorded = 0;
  SensorService service;
  http::Router router;
};

TEST(WornSensors, AreServedLikeFramesAndAreAllThereIs) {
  Worn suit(false);
  EXPECT_EQ(get(suit.router, "/orientations").status, 503);
  EXPECT_FALSE(suit.service.health().ready);
  for (std::uint64_t i = 1; i <= 100; ++i) suit.say(i, std::chrono::milliseconds(10) * int(i));
  EXPECT_TRUE(suit.service.health().ready);
  const auto latest = nlohmann::json::parse(get(suit.router, "/orientations").body);
  EXPECT_EQ(latest["source"], "suit");
  EXPECT_LE(latest["sequence"], 51) << "fifty documents a second";
  EXPECT_GE(suit.recorded, 98u);
  EXPECT_EQ(get(suit.router, "/frame").status, 404);
  EXPECT_THAT(get(suit.router, "/").body,
              AllOf(HasSubstr("orientations"), Not(HasSubstr("/frame"))));
  EXPECT_THAT(resource::undeclared_terms(service::self_node(suit.service.description())),
              ::testing::IsEmpty());
  EXPECT_EQ(suit.service.counters().instants, 100u);
}

TEST(WornSensors, ThatRepeatThemselvesAreRefusedAndCounted) {
  Worn suit(true);
  suit.say(1, std::chrono::milliseconds(10));
  suit.say(1, std::chrono::milliseconds(20));
  suit.say(2, std::chrono::milliseconds(10));
  EXPECT_EQ(suit.service.counters().refused, 2u);
  suit.say(5, std::chrono::milliseconds(50));
  EXPECT_EQ(suit.service.counters().lost, 3u);
  EXPECT_EQ(get(suit.router, "/frame").status, 503) << "its bodies have not come yet";
}

}  // namespace
}  // namespace chorus::sensor_service
