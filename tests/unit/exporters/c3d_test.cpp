// C3D, checked by our own decoder, written from the user guide (c3d.org), and by common/motion.
#include "common/exporters/c3d.h"

#include <gmock/gmock.h>

#include <bit>
#include <cstring>
#include <map>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/motion/c3d.h"
#include "tests/support/matchers.h"
#include "tests/unit/exporters/poses.h"

namespace chorus::exporters {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::hide;
using chorus::testing::IsOk;
using chorus::testing::VectorNear;

/// A C3D file, read word by word.  Words are counted from 1, as in the guide.
struct DecodedC3d {
  std::string bytes;
  std::map<std::string, std::string> values;  ///< "POINT:USED" -> raw bytes
  std::map<std::string, std::vector<int>> dimensions;
  std::map<std::string, int> types;

  explicit DecodedC3d(std::string all) : bytes(std::move(all)) {
    const std::size_t start = static_cast<std::size_t>(bytes.at(0) - 1) * 512;
    EXPECT_EQ(bytes.at(1), 0x50);
    EXPECT_EQ(static_cast<unsigned char>(bytes.at(start + 3)), 84) << "Intel";
    std::map<int, std::string> groups;
    std::size_t at = start + 4;
    while (bytes.at(at) != 0) {
      const int length = std::abs(static_cast<signed char>(bytes[at]));
      const int id = static_cast<signed char>(bytes[at + 1]);
      const std::string name = bytes.substr(at + 2, static_cast<std::size_t>(length));
      const std::size_t link = at + 2 + static_cast<std::size_t>(length);
      const std::size_t next = link + word_at(link);
      if (id < 0) {
        groups[-id] = name;
      } else {
        const std::string key = groups.at(id) + ":" + name;
        types[key] = static_cast<signed char>(bytes.at(link + 2));
        const int n = bytes.at(link + 3);
        for (int d = 0; d < n; ++d)
          dimensions[key].push_back(
              static_cast<unsigned char>(bytes.at(link + 4 + static_cast<std::size_t>(d))));
        const std::size_t first = link + 4 + static_cast<std::size_t>(n);
        values[key] = bytes.substr(first, next - first - 1);
        EXPECT_EQ(bytes.at(next - 1), 0) << "length of the description";
      }
      at = next;
    }
    const std::size_t blocks = static_cast<unsigned char>(bytes.at(start + 2));
    EXPECT_LE(at, start + 512 * blocks);
    EXPECT_EQ(start / 512 + blocks + 1, header_word(9)) << "the data follow the parameters";
  }

  [[nodiscard]] unsigned word_at(std::size_t at) const {
    return static_cast<unsigned char>(bytes.at(at)) | static_cast<unsigned char>(bytes.at(at + 1))
                                                          << 8;
  }
  [[nodiscard]] unsigned header_word(std::size_t n) const { return word_at(2 * (n - 1)); }
  [[nodiscard]] float real_at(std::size_t at) const {
    float value = 0;
    std::memcpy(&value, bytes.data() + at, 4);  // tests run on machines with Intel byte order
    return value;
  }
  [[nodiscard]] float real(const std::string& key) const {
    float value = 0;
    std::memcpy(&value, values.at(key).data(), 4);
    return value;
  }
  [[nodiscard]] unsigned integer(const std::string& key, std::size_t i = 0) const {
    const std::string& raw = values.at(key);
    return static_cast<unsigned char>(raw.at(2 * i)) | static_cast<unsigned char>(raw.at(2 * i + 1))
                                                           << 8;
  }
  [[nodiscard]] std::string label(std::size_t i, const std::string& key = "POINT:LABELS") const {
    const auto width = static_cast<std::size_t>(dimensions.at(key).at(0));
    std::string text = values.at(key).substr(i * width, width);
    text.erase(text.find_last_not_of(' ') + 1);
    return text;
  }
  /// x y z and the fourth word of a point.
  [[nodiscard]] std::array<float, 4> point(std::size_t frame, std::size_t i) const {
    const std::size_t at = (header_word(9) - 1) * 512 + (frame * header_word(2) + i) * 16;
    return {real_at(at), real_at(at + 4), real_at(at + 8), real_at(at + 12)};
  }
};

Take two_frames() {
  auto second = asymmetric_person();
  hide(second[JointId::HandLeft]);
  Take take = take_of({{asymmetric_person(), second}}, 30.0);
  take.persons[0].poses[0].variance[index_of(JointId::Neck)] = 1e-4 / 3;  // sqrt(3 v) = 10 mm
  take.persons[0].poses[0].variance[index_of(JointId::Head)] = 1.0;
  take.persons[0].poses[0].variance[index_of(JointId::KneeLeft)] = 1e-12;
  return take;
}

TEST(C3dExport, HeaderAndParametersSayTheSame) {
  const DecodedC3d c3d(c3d_of(two_frames()).value());
  EXPECT_EQ(c3d.bytes.size() % 512, 0u);
  EXPECT_EQ(c3d.header_word(2), 25u);
  EXPECT_EQ(c3d.integer("POINT:USED"), 25u);
  EXPECT_EQ(c3d.header_word(3), 0u) << "no analog samples";
  EXPECT_EQ(c3d.integer("ANALOG:USED"), 0u);
  EXPECT_EQ(c3d.header_word(10), 0u) << "nor in a channel";
  EXPECT_EQ(c3d.real("ANALOG:RATE"), 0.0f);
  EXPECT_EQ(c3d.header_word(4), 1u);
  EXPECT_EQ(c3d.header_word(5), 2u);
  EXPECT_EQ(c3d.integer("POINT:FRAMES"), 2u);
  EXPECT_EQ(c3d.real_at(12), -1.0f);
  EXPECT_EQ(c3d.real("POINT:SCALE"), -1.0f);
  EXPECT_EQ(c3d.real_at(20), 30.0f);
  EXPECT_EQ(c3d.real("POINT:RATE"), 30.0f);
  EXPECT_EQ(c3d.integer("POINT:DATA_START"), c3d.header_word(9));
  EXPECT_EQ(c3d.values.at("POINT:UNITS"), "mm");
  EXPECT_EQ(c3d.values.at("POINT:Y_SCREEN"), "+Y");
  EXPECT_EQ(c3d.integer("TRIAL:ACTUAL_END_FIELD", 0), 2u);
  EXPECT_EQ(c3d.values.count("POINT:LONG_FRAMES"), 0u);
  for (std::size_t j = 0; j < kJointCount; ++j) EXPECT_EQ(c3d.label(j), kJointNames[j]);
}

TEST(C3dExport, PointsAreMillimetresAndMissingOnesInvalid) {
  const DecodedC3d c3d(c3d_of(two_frames()).value());
  const auto person = asymmetric_person();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto xyzr = c3d.point(0, j);
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(xyzr[static_cast<std::size_t>(axis)], to_mm(person.joints[j].position[axis]),
                  1e-3);
    EXPECT_GE(xyzr[3], 0.0f);
  }
  EXPECT_EQ(c3d.point(0, index_of(JointId::Neck))[3], 10.0f);
  EXPECT_EQ(c3d.point(0, index_of(JointId::Head))[3], 255.0f) << "the most a byte holds";
  EXPECT_EQ(c3d.point(0, index_of(JointId::KneeLeft))[3], 1.0f) << "0 would say interpolated";
  EXPECT_EQ(c3d.point(0, index_of(JointId::KneeRight))[3], 0.0f) << "nothing known";
  EXPECT_EQ(c3d.point(1, index_of(JointId::HandLeft)), (std::array{0.0f, 0.0f, 0.0f, -1.0f}));
}

TEST(C3dExport, MoreThan65535FramesAreCountedElsewhere) {
  Take take = take_of({std::vector(70'000, Skeleton<WorldSpace>())}, 100.0);
  take.persons[0].poses[69'999].skeleton = asymmetric_person();
  const auto bytes = c3d_of(take).value();
  const DecodedC3d c3d(bytes);
  EXPECT_EQ(c3d.header_word(5), 65535u);
  EXPECT_EQ(c3d.integer("POINT:FRAMES"), 65535u);
  EXPECT_EQ(c3d.real("POINT:LONG_FRAMES"), 70'000.0f);
  EXPECT_EQ(
      c3d.integer("TRIAL:ACTUAL_END_FIELD", 0) + 65536u * c3d.integer("TRIAL:ACTUAL_END_FIELD", 1),
      70'000u);
  const auto read = motion::parse_c3d(bytes, "long.c3d");
  ASSERT_THAT(read, IsOk());
  ASSERT_EQ(read->frames.size(), 70'000u);
  EXPECT_TRUE(read->frames.back()[3].valid());
}

TEST(C3dExport, SeveralPersonsHavePrefixesAndMoreThan255PointsASecondParameter) {
  const DecodedC3d c3d(
      c3d_of(take_of(std::vector(11, std::vector{asymmetric_person()}), 30)).value());
  EXPECT_EQ(c3d.header_word(2), 275u);
  EXPECT_EQ(c3d.label(25), "P2:SpineBase");
  EXPECT_EQ(c3d.dimensions.at("POINT:LABELS")[1], 255);
  EXPECT_EQ(c3d.dimensions.at("POINT:LABELS2")[1], 20);
  EXPECT_EQ(c3d.label(0, "POINT:LABELS2"), "P11:ElbowLeft");
  EXPECT_EQ(c3d.integer("SUBJECTS:USED"), 11u);
  EXPECT_EQ(c3d.label(10, "SUBJECTS:LABEL_PREFIXES"), "P11:");
}

TEST(C3dExport, AHundredPersonsStillFitTheirParameters) {
  const std::vector persons(100, std::vector{asymmetric_person()});
  const auto bytes = c3d_of(take_of(persons, 30));
  ASSERT_THAT(bytes, IsOk());
  const auto read = motion::parse_c3d(*bytes, "crowd.c3d");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->labels.back(), "P100:ThumbRight");
  EXPECT_THAT(c3d_of(take_of(std::vector(101, std::vector{asymmetric_person()}), 30)),
              FailsWith(ErrorCode::TooLarge));
}

TEST(C3dExport, IdsTooLongForTheParametersAreRefusedInsteadOfACorruptFile) {
  Take take = take_of(std::vector(100, std::vector{asymmetric_person()}), 30);
  for (std::size_t p = 0; p < take.persons.size(); ++p)
    take.persons[p].person = PersonId{1'000'000'000'000'000'000 + p};
  const auto refused = c3d_of(take);
  ASSERT_THAT(refused, FailsWith(ErrorCode::TooLarge));
  EXPECT_THAT(to_string(refused.error()), ::testing::HasSubstr("--person"));
  take.persons.resize(60);
  const auto bytes = c3d_of(take);
  ASSERT_THAT(bytes, IsOk());
  const auto read = motion::parse_c3d(*bytes, "crowd.c3d");
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->labels.back(), "P1000000000000000059:ThumbRight");
}

TEST(C3dExport, OurOwnReaderGivesTheSameJoints) {
  const Take take = two_frames();
  const auto read = motion::parse_c3d(c3d_of(take).value(), "two.c3d");
  ASSERT_THAT(read, IsOk());
  const auto found = motion::motion_from_markers(*read);
  ASSERT_THAT(found, IsOk());
  ASSERT_EQ(found->subjects.size(), 1u);
  EXPECT_TRUE(found->unused_labels.empty());
  for (std::size_t f = 0; f < 2; ++f)
    EXPECT_THAT(found->subjects[0].motion.frames[f],
                chorus::testing::SkeletonNear(take.persons[0].poses[f].skeleton, 1e-6));
}

}  // namespace
}  // namespace chorus::exporters
