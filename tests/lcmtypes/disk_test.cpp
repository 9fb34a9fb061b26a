#include "lcmtypes/disk.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>

#include "lcmtypes/error.h"
#include "tests/campaign/temporary_directory.h"
#include "tests/lcmtypes/synced_files.h"

namespace waverig {
namespace {

std::error_code of(int number) { return {number, std::generic_category()}; }

TEST(Disk, AFullOrBrokenOneIsNoFaultOfThePlaceThatWasNamed) {
  for (const int number : {ENOSPC, EDQUOT, EFBIG, EIO, ENOMEM, EMFILE, ENFILE}) {
    EXPECT_TRUE(is_of_the_machine(of(number))) << number;
    EXPECT_TRUE(is_of_the_machine({number, std::system_category()})) << number;
    try {
      refuse_place(of(number), "x: no room");
    } catch (const UserError&) {
      ADD_FAILURE() << number;
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "x: no room");
    }
  }
  for (const int number : {0, EACCES, ENOENT, EISDIR, ENOTDIR, EROFS, EEXIST}) {
    EXPECT_FALSE(is_of_the_machine(of(number))) << number;
    EXPECT_THROW(refuse_place(of(number), "x: not there"), UserError) << number;
  }
}

TEST(Disk, ALinkLeadsToWhatItNames) {
  const TemporaryDirectory temporary;
  namespace fs = std::filesystem;
  const fs::path folder = temporary / "folder", file = folder / "file";
  fs::create_directory(folder);
  fs::create_symlink("folder", temporary / "link");
  fs::create_symlink("link", temporary / "to link");
  fs::create_symlink("folder/file", temporary / "to nothing yet");
  fs::create_symlink("circle", temporary / "circle");
  EXPECT_EQ(led_to(folder), folder);
  EXPECT_EQ(led_to(temporary / "folder/"), folder);
  EXPECT_EQ(led_to(temporary / "to link"), folder);
  EXPECT_EQ(led_to(temporary / "to nothing yet"), file);
  EXPECT_EQ(led_to(temporary / "circle"), temporary / "circle");
  EXPECT_EQ(led_to("/dev/stdout"), "/proc/self/fd/1") << "no place, whatever is open there";
}

// A loss of power cannot be tried here; what the disk is told, and when, can.
TEST(Disk, WhatIsWholeIsOnItBeforeItHasItsNameAndTheNameAfter) {
  const TemporaryDirectory temporary;
  const auto part = temporary.write("log.part", "whole"), log = temporary / "log";
  synced_files().clear();
  rename_whole(part, log);
  EXPECT_EQ(bytes_of(log), "whole");
  EXPECT_EQ(synced_files(), (std::vector<std::string>{part, temporary.path()}));
  std::filesystem::create_directories(temporary / "run.partial");
  temporary.write("run.partial/x", "x");
  rename_whole(temporary / "run.partial", temporary / "run");
  EXPECT_EQ(bytes_of(temporary / "run/x"), "x");
  EXPECT_THROW(rename_whole(temporary / "nothing", log), std::filesystem::filesystem_error);
  EXPECT_EQ(bytes_of(log), "whole");
}

}  // namespace
}  // namespace waverig
