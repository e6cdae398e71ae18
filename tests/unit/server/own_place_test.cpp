#include "fusion-server/server/own_place.h"

#include <gtest/gtest.h>

#include <thread>

#include "common/base/file.h"
#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "tests/support/temporary_folder.h"

namespace chorus::server {
namespace {

site::CellPlace typed_place(double x) {
  site::CellPlace place;
  place.cell = site::CellId::parse("a").value();
  place.site_from_cell.linear() = about_y(0.7).toRotationMatrix();
  place.site_from_cell.translation() = Eigen::Vector3d(x, 0, 2);
  place.covariance(1, 1) = deg(1.0) * deg(1.0);
  place.covariance(3, 3) = place.covariance(5, 5) = 0.01;
  return place;
}

Eigen::Isometry3d new_from_old() {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear() = about_y(1.2).toRotationMatrix();
  out.translation() = Eigen::Vector3d(3, 0, -1);
  return out;
}

/// The worker writes in its own time.
template <class Condition>
bool comes_true(const Condition& condition) {
  for (int i = 0; i < 5000 && !condition(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

TEST(OwnPlace, OfAMovedOriginLeavesEverybodyWhereTheyAre) {
  OwnPlace own("");
  EXPECT_FALSE(own.moved(new_from_old())) << "it has no place";
  ASSERT_TRUE(own.typed(typed_place(5)));
  const auto moved = own.moved(new_from_old());
  ASSERT_TRUE(moved);
  const Eigen::Vector3d person(1, 0.9, -2);
  EXPECT_TRUE((moved->site_from_cell * (new_from_old() * person))
                  .isApprox(typed_place(5).site_from_cell * person, 1e-9));
  EXPECT_GT(moved->version, typed_place(5).version);
  // A turn of the cell moves an origin that is farther away by more.
  EXPECT_GT(moved->covariance(3, 3) + moved->covariance(5, 5), 0.02);
}

TEST(OwnPlace, IsKeptUntilTheFileSaysSomethingElse) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "site-place.json").string();
  site::CellPlace moved;
  {
    OwnPlace own(folder.path().string());
    ASSERT_TRUE(own.typed(typed_place(5)));
    moved = own.moved(new_from_old()).value();
    ASSERT_TRUE(comes_true([&] { return is_there(file); }));
  }
  OwnPlace again(folder.path().string());
  const auto kept = again.typed(typed_place(5));
  ASSERT_TRUE(kept);
  EXPECT_TRUE(kept->site_from_cell.isApprox(moved.site_from_cell, 1e-6));
  EXPECT_NEAR(again.typed(typed_place(6))->site_from_cell.translation().x(), 6.0, 1e-12);
  EXPECT_FALSE(again.typed(std::nullopt));
}

TEST(OwnPlace, OfANewlyFoundHallIsNotMovedAsThatOfTheOldOne) {
  // The origin's place is the same in every file that a command writes.
  site::CellPlace first = typed_place(5);
  first.version = 1'795'246'200'000;
  site::CellPlace second = first;
  second.version = 1'795'246'260'000;
  OwnPlace own("");
  ASSERT_TRUE(own.typed(first));
  const auto moved = own.moved(new_from_old());
  ASSERT_TRUE(moved);
  EXPECT_TRUE(own.typed(first)->site_from_cell.isApprox(moved->site_from_cell)) << "read again";
  EXPECT_TRUE(own.typed(second)->site_from_cell.isApprox(first.site_from_cell));
}

TEST(OwnPlace, IsForgottenForGoodOnceTheFileSaidSomethingElse) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "site-place.json").string();
  site::CellPlace later = typed_place(5);
  later.version = 2;
  {
    OwnPlace own(folder.path().string());
    ASSERT_TRUE(own.typed(typed_place(5)));
    ASSERT_TRUE(own.moved(new_from_old()));
    ASSERT_TRUE(comes_true([&] { return is_there(file); }));
    // Also one that is still to be written.
    ASSERT_TRUE(own.moved(new_from_old()));
    ASSERT_TRUE(own.typed(later));
    ASSERT_TRUE(comes_true([&] { return !is_there(file); }));
  }
  EXPECT_FALSE(is_there(file));
  OwnPlace again(folder.path().string());
  EXPECT_NEAR(again.typed(typed_place(5))->site_from_cell.translation().x(), 5.0, 1e-12);
}

TEST(OwnPlace, OfAnotherFileAtTheStartForgetsTheMove) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "site-place.json").string();
  {
    OwnPlace own(folder.path().string());
    ASSERT_TRUE(own.typed(typed_place(5)));
    ASSERT_TRUE(own.moved(new_from_old()));
    ASSERT_TRUE(comes_true([&] { return is_there(file); }));
  }
  OwnPlace again(folder.path().string());
  ASSERT_TRUE(again.typed(typed_place(6)));
  EXPECT_TRUE(comes_true([&] { return !is_there(file); }));
}

TEST(OwnPlace, OfADamagedFileIsThatOfTheFileOfPlaces) {
  const testing::TemporaryFolder folder;
  for (const char* text : {"", "{", "[]", R"({"typed": 1, "now": {"cells": {}}})"}) {
    folder.write("site-place.json", text);
    OwnPlace own(folder.path().string());
    EXPECT_NEAR(own.typed(typed_place(5))->site_from_cell.translation().x(), 5.0, 1e-12) << text;
  }
}

}  // namespace
}  // namespace chorus::server
