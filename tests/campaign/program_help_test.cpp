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

}  // namespace
}  // namespace waverig
