#include "rig/campaign/results_directory.h"

#include <gtest/gtest.h>

#include "lcmtypes/error.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig {
namespace {
namespace fs = std::filesystem;
using Mode = ResultsDirectory::Mode;

TEST(ResultsDirectory, IsThereUnderItsOwnNameOnlyWhenFinished) {
  const TemporaryDirectory temporary;
  ResultsDirectory directory(temporary / "out", Mode::kFresh);
  EXPECT_FALSE(fs::exists(temporary / "out"));
  directory.finish();
  EXPECT_TRUE(fs::exists(temporary / "out"));
  EXPECT_FALSE(fs::exists(temporary / "out.partial"));
}

TEST(ResultsDirectory, RefusesToOverwriteAFinishedOne) {
  const TemporaryDirectory temporary;
  fs::create_directories(temporary / "out");
  temporary.write("out/results.json", "{}");
  EXPECT_THROW(ResultsDirectory(temporary / "out", Mode::kFresh), UserError);
  EXPECT_THROW(ResultsDirectory(temporary / "out", Mode::kResume), UserError);
}

TEST(ResultsDirectory, RefusesToBeginWhereAnUnfinishedOneWaits) {
  const TemporaryDirectory temporary;
  { ResultsDirectory abandoned(temporary / "out", Mode::kFresh); }
  EXPECT_THROW(ResultsDirectory(temporary / "out", Mode::kFresh), UserError);
  EXPECT_NO_THROW(ResultsDirectory(temporary / "out", Mode::kResume));
}

TEST(ResultsDirectory, KeepsTheOldResultsUntilTheNewAreWhole) {
  const TemporaryDirectory temporary;
  fs::create_directories(temporary / "out");
  temporary.write("out/results.json", "old");
  ResultsDirectory directory(temporary / "out", Mode::kReplace);
  std::ofstream(directory.working() / "results.json") << "new";
  EXPECT_EQ(bytes_of(temporary / "out/results.json"), "old");
  directory.finish();
  EXPECT_EQ(bytes_of(temporary / "out/results.json"), "new");
}

TEST(ResultsDirectory, ResumesOnlyTheSameSettings) {
  const TemporaryDirectory temporary;
  ResultsDirectory(temporary / "out", Mode::kFresh).claim("seed = 1\n");
  ResultsDirectory again(temporary / "out", Mode::kResume);
  EXPECT_NO_THROW(again.claim("seed = 1\n"));
  EXPECT_THROW(again.claim("seed = 2\n"), UserError);
}

}  // namespace
}  // namespace waverig::rig
