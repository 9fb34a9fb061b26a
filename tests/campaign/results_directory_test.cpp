#include "rig/campaign/results_directory.h"

#include <gtest/gtest.h>

#include <optional>

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

TEST(ResultsDirectory, WhatNobodyCouldGoOnWithLeavesNothingUnfinished) {
  const TemporaryDirectory temporary;
  { ResultsDirectory abandoned(temporary / "out", Mode::kFresh, /*resumes=*/false); }
  EXPECT_FALSE(fs::exists(temporary / "out.partial"));
  ResultsDirectory directory(temporary / "out", Mode::kFresh, /*resumes=*/false);
  EXPECT_THROW(ResultsDirectory(temporary / "out", Mode::kFresh, /*resumes=*/false), UserError);
  EXPECT_TRUE(fs::exists(directory.working())) << "another's is not taken away";
  directory.finish();
  EXPECT_TRUE(fs::exists(temporary / "out"));
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

TEST(ResultsDirectory, StandsWhereALinkLeadsAndTheLinkStays) {
  const TemporaryDirectory temporary;
  fs::create_directories(temporary / "disk/old");
  temporary.write("disk/old/results.json", "old");
  fs::create_directory_symlink("disk/old", temporary / "there");
  fs::create_directory_symlink("disk/new", temporary / "not_yet");
  for (const auto& [link, target] : {std::pair{"there", "disk/old"}, {"not_yet", "disk/new"}}) {
    ResultsDirectory directory(temporary / link, Mode::kReplace);
    EXPECT_EQ(directory.working(), temporary / (std::string(target) + ".partial"));
    std::ofstream(directory.working() / "results.json") << "new";
    directory.finish();
    EXPECT_TRUE(fs::is_symlink(temporary / link));
    EXPECT_EQ(bytes_of(temporary / target / "results.json"), "new");
  }
}

TEST(ResultsDirectory, ReplacesTheDirectoryThatOneStandsIn) {
  const TemporaryDirectory temporary;
  fs::create_directories(temporary / "here");
  temporary.write("here/results.json", "old");
  ResultsDirectory directory(temporary / "here/.", Mode::kReplace);
  std::ofstream(directory.working() / "results.json") << "new";
  directory.finish();
  EXPECT_EQ(bytes_of(temporary / "here/results.json"), "new");
}

TEST(ResultsDirectory, ReplacesNothingButResults) {
  const TemporaryDirectory temporary;
  temporary.write("recording.csv", "utime");
  fs::create_directories(temporary / "mine");
  temporary.write("mine/campaign.toml", "my own");
  for (const char* taken : {"recording.csv", "mine", "."}) {
    EXPECT_THROW(ResultsDirectory(temporary / taken, Mode::kReplace), UserError) << taken;
    EXPECT_THROW(ResultsDirectory(temporary / taken, Mode::kFresh), UserError) << taken;
  }
  EXPECT_EQ(bytes_of(temporary / "recording.csv"), "utime");
  EXPECT_EQ(bytes_of(temporary / "mine/campaign.toml"), "my own");
  fs::create_directories(temporary / "empty");
  EXPECT_NO_THROW(ResultsDirectory(temporary / "empty", Mode::kReplace).finish());
}

TEST(ResultsDirectory, ResumesOnlyTheSameSettings) {
  const TemporaryDirectory temporary;
  ResultsDirectory(temporary / "out", Mode::kFresh).claim("seed = 1\n", "1.0");
  ResultsDirectory again(temporary / "out", Mode::kResume);
  EXPECT_NO_THROW(again.claim("seed = 1\n", "1.0"));
  EXPECT_THROW(again.claim("seed = 2\n", "1.0"), UserError);
}

TEST(ResultsDirectory, ResumesOnlyWhatItsOwnVersionBegan) {
  const TemporaryDirectory temporary;
  ResultsDirectory(temporary / "out", Mode::kFresh).claim("seed = 1\n", "1.0");
  ResultsDirectory again(temporary / "out", Mode::kResume);
  try {
    again.claim("seed = 1\n", "1.0+1");
    FAIL() << "runs of two versions in one campaign";
  } catch (const UserError& refusal) {
    const std::string sentence = refusal.what();
    EXPECT_NE(sentence.find("campaign.toml:1: '# waverig 1.0': was begun by another version"),
              std::string::npos)
        << sentence;
    EXPECT_NE(sentence.find("expected '# waverig 1.0+1'"), std::string::npos) << sentence;
  }
  EXPECT_NO_THROW(again.claim("seed = 1\n", "1.0"));
}

std::string refusal(const fs::path& directory, Mode mode, bool resumes = true) {
  try {
    ResultsDirectory(directory, mode, resumes);
  } catch (const UserError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(ResultsDirectory, NamesWhatTheCommandCanDoAboutAnUnfinishedOne) {
  const TemporaryDirectory temporary;
  { ResultsDirectory killed_at_once(temporary / "out", Mode::kFresh); }
  EXPECT_NE(refusal(temporary / "out", Mode::kFresh).find("expected --resume to go on or --replace"),
            std::string::npos);
  temporary.write("out.partial/campaign.toml", "");
  EXPECT_NE(refusal(temporary / "out", Mode::kFresh, false).find("is unfinished; expected --replace"),
            std::string::npos);
}

TEST(ResultsDirectory, BelongsToOneProcessAtATime) {
  const TemporaryDirectory temporary;
  std::optional<ResultsDirectory> at_work(std::in_place, temporary / "out", Mode::kFresh);
  at_work->claim("seed = 1\n", "1.0");
  for (const Mode mode : {Mode::kFresh, Mode::kResume, Mode::kReplace}) {
    const std::string sentence = refusal(temporary / "out", mode);
    EXPECT_NE(sentence.find("another waverig is at work in"), std::string::npos) << sentence;
  }
  EXPECT_TRUE(fs::exists(temporary / "out.partial/campaign.toml"));
  at_work.reset();
  EXPECT_EQ(refusal(temporary / "out", Mode::kResume), "not refused");
}

TEST(ResultsDirectory, GoesOnWhereReplacingWasInterruptedAndKeepsTheOldUntilThen) {
  const TemporaryDirectory temporary;
  fs::create_directories(temporary / "out");
  temporary.write("out/results.json", "old");
  { ResultsDirectory(temporary / "out", Mode::kReplace).claim("seed = 1\n", "1.0"); }
  ResultsDirectory again(temporary / "out", Mode::kResume);
  again.claim("seed = 1\n", "1.0");
  std::ofstream(again.working() / "results.json") << "new";
  EXPECT_EQ(bytes_of(temporary / "out/results.json"), "old");
  again.finish();
  EXPECT_EQ(bytes_of(temporary / "out/results.json"), "new");
}

TEST(ResultsDirectory, DoesNotResumeWhatDoesNotSayItsVersion) {
  const TemporaryDirectory temporary;
  { ResultsDirectory before(temporary / "out", Mode::kFresh); }
  temporary.write("out.partial/campaign.toml", "seed = 1\n");
  EXPECT_THROW(ResultsDirectory(temporary / "out", Mode::kResume).claim("seed = 1\n", "1.0"), UserError);
}

}  // namespace
}  // namespace waverig::rig
