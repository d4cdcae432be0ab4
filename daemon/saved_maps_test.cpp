// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The Glint Authors
#include "daemon/saved_maps.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "driver/core/error.hpp"
#include "slam/store/test_session.hpp"

namespace glint::daemon {
namespace {

namespace fs = std::filesystem;

class SavedMapsTest : public slam::test::InDirectory {
 protected:
  SavedMapsTest() { fs::remove_all(directory_); }

  const SavedMaps maps_{directory_};
};

TEST(MapNameTest, NamesAreLettersDigitsAndAFewSigns) {
  for (const char* name : {"a", "Z", "0", "office", "Office-2.floor_3", "a..b", "map.glint"}) {
    EXPECT_TRUE(SavedMaps::is_name(name)) << name;
  }
  EXPECT_TRUE(SavedMaps::is_name(std::string(64, 'x')));
}

TEST(MapNameTest, PathsAndAllElseAreNone) {
  for (const char* name : {"",
                           ".",
                           "..",
                           "...",
                           ".hidden",
                           "-rf",
                           "_a",
                           "/",
                           "/etc/passwd",
                           "../a",
                           "a/b",
                           "a/../b",
                           "a\\b",
                           "a b",
                           " a",
                           "a\n",
                           "a\t",
                           "~",
                           "$HOME",
                           "a*",
                           "a?",
                           "a:b",
                           "b\xc3\xbcro",
                           "\xe5\x9c\xb0\xe5\x9b\xbe",
                           "a\xe2\x80\xae",
                           "a%2fb",
                           "a\x7f"}) {
    EXPECT_FALSE(SavedMaps::is_name(name)) << name;
  }
  EXPECT_FALSE(SavedMaps::is_name(std::string(65, 'x')));
  EXPECT_FALSE(SavedMaps::is_name(std::string_view("a\0b", 3)));
}

TEST_F(SavedMapsTest, WhatIsNoNameNeverBecomesAPath) {
  EXPECT_THROW(static_cast<void>(maps_.file_of("../a")), InputError);
  EXPECT_THROW(static_cast<void>(maps_.remove("..")), InputError);
  EXPECT_THROW(static_cast<void>(maps_.contains("")), InputError);
  EXPECT_EQ(maps_.file_of("a"), directory_ / "maps" / "a.glint");
}

TEST_F(SavedMapsTest, WithoutAFolderThereAreNone) {
  EXPECT_TRUE(maps_.names().empty());
  EXPECT_FALSE(maps_.contains("a"));
  EXPECT_FALSE(maps_.remove("a"));
  EXPECT_TRUE(maps_.has_place());
  EXPECT_FALSE(SavedMaps({}).has_place());
}

TEST_F(SavedMapsTest, NamesComeInOrderAndOtherFilesAreLeftOut) {
  maps_.make_place();
  for (const char* file :
       {"b.glint", "a.glint", "c.glint.77.part", ".d.glint", "e f.glint", "notes.txt"}) {
    std::ofstream(directory_ / "maps" / file) << "x";
  }
  EXPECT_EQ(maps_.names(), (std::vector<std::string>{"a", "b"}));
}

TEST_F(SavedMapsTest, RemovingTakesWhatLiesBesideItAndNoOther) {
  maps_.make_place();
  for (const char* file : {"a.glint", "a.glint-wal", "a.glint-shm", "a.b.glint"}) {
    std::ofstream(directory_ / "maps" / file) << "x";
  }
  EXPECT_TRUE(maps_.remove("a"));
  EXPECT_FALSE(maps_.remove("a"));
  EXPECT_EQ(maps_.names(), (std::vector<std::string>{"a.b"}));
  EXPECT_EQ(std::distance(fs::directory_iterator(directory_ / "maps"), {}), 1);
}

}  // namespace
}  // namespace glint::daemon
