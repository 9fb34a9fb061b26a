// A bench store is there whole or not at all.
#include "rig/bench/store.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

#include "lcmtypes/error.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig::bench {
namespace {

namespace fs = std::filesystem;
const RunInfo kInfo{"a run", "none", "test", {}, {}, 1'704'067'200'000'000, true, "running", "sequence/short.toml"};

void make(const fs::path& file, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
}

std::string complaint(const std::function<void()>& call) {
  try {
    call();
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(Store, KilledWhileItIsMadeIsThereWholeOrNotAtAll) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "bench.sqlite";
  int killed = 0;
  for (int i = 0; i < 60; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      try {
        Store::create(file, kInfo);
      } catch (...) {
        ::_exit(3);
      }
      ::_exit(0);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(250 * i));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << i;
    killed += WIFSIGNALED(status) ? 1 : 0;
    if (!fs::exists(file)) continue;
    EXPECT_EQ(complaint([&] { EXPECT_EQ(Store::open(file).info().title, kInfo.title); }), "") << i;
    fs::remove(file);
  }
  EXPECT_GT(killed, 0);
}

// As kills left it once: WAL was asked for, and nothing else was done.
TEST(Store, AFileOfNothingIsNoRunYet) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "bench.sqlite";
  make(file, "PRAGMA journal_mode = WAL;");
  ASSERT_GT(fs::file_size(file), 0U);
  EXPECT_FALSE(Store::begun(file));
  EXPECT_NE(complaint([&] { Store::open(file); }).find("no run is there"), std::string::npos);
  EXPECT_EQ(complaint([&] { Store::create(file, kInfo); }), "");
  EXPECT_EQ(Store::open(file).info().sequence, kInfo.sequence);
  fs::remove(file);
  std::ofstream(file).flush();   // and where not even that was done
  EXPECT_EQ(complaint([&] { Store::create(file, kInfo); }), "");
}

TEST(Store, WhatSomebodyElseKeepsThereIsRefusedAndLeftAlone) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path() / "bench.sqlite";
  for (const char* sql : {"CREATE TABLE mine(a); INSERT INTO mine VALUES(1);", "PRAGMA user_version = 7;"}) {
    fs::remove(file);
    make(file, sql);
    EXPECT_NE(complaint([&] { Store::create(file, kInfo); }).find("is there already"), std::string::npos) << sql;
    EXPECT_NE(complaint([&] { Store::open(file); }).find("expected a bench store of version"), std::string::npos) << sql;
  }
  fs::remove(file);
  make(file, "CREATE TABLE mine(a); INSERT INTO mine VALUES(1);");
  EXPECT_NE(complaint([&] { Store::create(file, kInfo); }), "");
  make(file, "UPDATE mine SET a = 2;");   // it is there still
  Store::create(directory.path() / "ours.sqlite", kInfo);
  EXPECT_NE(complaint([&] { Store::create(directory.path() / "ours.sqlite", kInfo); }).find("a run is there already"), std::string::npos);
}

}  // namespace
}  // namespace waverig::rig::bench
