// The files behind a run, kept in its directory.
#include "rig/bench/run_directory.h"

#include <gtest/gtest.h>

#include "lcmtypes/error.h"
#include "tests/bench/short_sequence.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig::bench {
namespace {

namespace fs = std::filesystem;

TEST(RunDirectory, KeepsTheFilesAsTheyLieToEachOtherWhereverTheyLie) {
  const ShortSequence files("scale_factor.toml");
  const fs::path root = files.file().parent_path();
  for (const char* directory : {"laboratory", "procedures"}) fs::create_directories(root / directory);
  for (const char* name : {"laboratory.toml", "unit_counts.toml", "unit_monitor.toml", "converter_unit.toml"})
    fs::rename(root / name, root / "laboratory" / name);
  fs::rename(files.file(), root / "procedures" / "mine.toml");
  fs::copy_file(root / "laboratory" / "converter_unit.toml", root / "procedures" / "unit7.toml");
  std::string text = bytes_of(root / "procedures" / "mine.toml");
  text.insert(text.find("laboratory = \"") + 14, "../laboratory/");
  std::ofstream(root / "procedures" / "mine.toml") << "unit = \"unit7.toml\"\n" << text;

  const Sequence sequence = load_sequence(root / "procedures" / "mine.toml");
  const TemporaryDirectory out;
  RunInfo info;
  info.sequence = keep_files(sequence, out.path());
  info.files = sequence.fingerprints;
  EXPECT_EQ(info.sequence, "sequence/procedures/mine.toml");
  fs::remove_all(root / "laboratory");
  const Sequence kept = kept_sequence(out.path(), info);
  EXPECT_EQ(kept.plan.size(), sequence.plan.size());
  EXPECT_EQ(kept.laboratory.unit.channels.size(), sequence.laboratory.unit.channels.size());
  std::ofstream(out / "sequence/laboratory/unit_counts.toml", std::ios::app) << "# changed\n";
  EXPECT_THROW(kept_sequence(out.path(), info), UserError);
}

}  // namespace
}  // namespace waverig::rig::bench
