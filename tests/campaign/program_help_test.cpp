// What the program says of itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tests/campaign/program.h"

namespace waverig {
namespace {

// The names under "Subcommands:" of a help text.
std::vector<std::string> subcommands_in(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help);
  std::string line;
  while (std::getline(lines, line) && line != "Subcommands:") continue;
  while (std::getline(lines, line) && line.starts_with("  "))
    if (line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
  return names;
}

// Every command in its turn, those of commands too: how many.
int expect_examples(const TemporaryDirectory& temporary, const std::string& command) {
  const Outcome help = run(temporary, command + "--help");
  EXPECT_EQ(help.status, 0) << command;
  const std::size_t examples = help.out.find("Example");
  EXPECT_NE(examples, std::string::npos) << command << help.out;
  const std::string shown = help.out.substr(std::min(examples, help.out.size()));
  EXPECT_NE(shown.find("\n  waverig " + command), std::string::npos) << command << help.out;
  int commands = 1;
  for (const std::string& name : subcommands_in(help.out))
    commands += expect_examples(temporary, command + name + " ");
  return commands;
}

TEST(Program, HelpOfEveryCommandShowsExamplesOfItsOwn) {
  const TemporaryDirectory temporary;
  EXPECT_GT(expect_examples(temporary, ""), 28);
}

TEST(Program, SaysThatStdoutCouldNotBeWritten) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", kTiny);
  for (const std::string command :
       {"plan c.toml", "--help", "--version", "sweep c.toml --jobs 2 --out out"}) {
    const Outcome full = run(temporary, command + " >/dev/full 2>stderr; exit $?;");
    EXPECT_EQ(full.status, 1) << command;
    const std::string said = bytes_of(temporary / "stderr");
    EXPECT_TRUE(said.starts_with("waverig: stdout: not everything could be written")) << command << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << command << said;
  }
  EXPECT_TRUE(std::filesystem::exists(temporary / "out/report.html")) << "whole before it is told";
}

TEST(Program, WritesIntoNoResultWhatBelongsOnAClosedStdout) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep c.toml --out out").status, 0);
  const Outcome closed = run(temporary, "evaluate out --out anew >&- 2>stderr; exit $?;");
  EXPECT_EQ(closed.status, 1);
  EXPECT_EQ(bytes_of(temporary / "stderr"),
            "waverig: stdout: not everything could be written: Bad file descriptor\n");
  EXPECT_EQ(bytes_of(temporary / "anew/results.csv"), bytes_of(temporary / "out/results.csv"));
}

}  // namespace
}  // namespace waverig
