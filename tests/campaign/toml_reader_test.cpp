#include "rig/settings/toml_reader.h"

#include <gtest/gtest.h>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

// What reading the text complains of; empty where it does not.
std::string complaint(const std::string& text) {
  try {
    TomlFile file(text, "test.toml");
    TomlTable& root = file.root();
    root.number("mass_kg", 1.0, {0, 10});
    root.integer("count", 3);
    root.texts("names", std::vector<std::string>{"a"});
    root.numbers("periods_s", std::vector<double>{6}, {0.5, 60});
    root.choice("kind", "arm", {"arm", "sea"});
    TomlTable axis = root.table("axis");
    axis.boolean("homing", false);
    for (TomlTable& step : root.tables("step")) step.text("do", std::nullopt);
    root.refuse_unknown_keys();
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

struct BadInput {
  const char* text;
  const char* complaint;
};

class TomlReaderRefuses : public ::testing::TestWithParam<BadInput> {};

TEST_P(TomlReaderRefuses, WithFileLineKeyValueAndWhatWasExpected) { EXPECT_EQ(complaint(GetParam().text), GetParam().complaint); }

INSTANTIATE_TEST_SUITE_P(
    BadValues, TomlReaderRefuses,
    ::testing::Values(
        BadInput{"\nmass_kg = 11\n", "test.toml:2: mass_kg = 11: expected a number from 0 to 10"},
        BadInput{"mass_kg = \"1\"\n", "test.toml:1: mass_kg = '1': expected a number from 0 to 10"},
        BadInput{"mass_kg = nan\n", "test.toml:1: mass_kg = nan: expected a number from 0 to 10"},
        BadInput{"count = 3.5\n", "test.toml:1: count = 3.5: expected a whole number"},
        BadInput{"names = [1]\n", "test.toml:1: names = [ 1 ]: expected a list with at least one text in quotes"},
        BadInput{"periods_s = []\n", "test.toml:1: periods_s = []: expected a list with at least one number, each a number from 0.5 to 60"},
        BadInput{"kind = \"boat\"\n", "test.toml:1: kind = 'boat': expected one of \"arm\", \"sea\""},
        BadInput{"[axis]\nhoming = 1\n", "test.toml:2: axis.homing = 1: expected true or false"},
        BadInput{"axis = 1\n", "test.toml:1: axis = 1: expected a table"},
        BadInput{"[axis]\nhomming = true\n", "test.toml:2: axis.homming = true: unknown key; expected one of homing"},
        BadInput{"mass_g = 1\n",
                 "test.toml:1: mass_g = 1: unknown key; expected one of axis, count, kind, mass_kg, names, periods_s, step"},
        BadInput{"[[step]]\ndoo = \"x\"\n", "test.toml:1: step[0].do is missing (line 2 has doo): expected a text in quotes"},
        BadInput{"[[step]]\ndo = \"x\"\n[[step]]\n", "test.toml:3: step[1].do is missing: expected a text in quotes"}));

TEST(TomlReader, TakesWhatIsThereAndTheFallbackForWhatIsNot) {
  TomlFile file("mass_kg = 2\n", "test.toml");
  EXPECT_EQ(file.root().number("mass_kg", 1.0), 2.0);
  EXPECT_EQ(file.root().number("length_m", 0.5), 0.5);
}

TEST(TomlReader, RefusesWhatIsNoTomlWithItsLine) {
  try {
    TomlFile("a = 1\nb = = 2\n", "test.toml");
    FAIL();
  } catch (const UserError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("test.toml:2: ")) << error.what();
  }
}

TEST(TomlReader, ResolvedTextReadsBackToTheSameValues) {
  TomlFile first("[axis]\nrate = 0.1\n", "first.toml");
  TomlTable axis = first.root().table("axis");
  const double rate = axis.number("rate", 1.0), accel = axis.number("accel", 1.0 / 3);
  TomlFile second(first.resolved(), "second.toml");
  TomlTable again = second.root().table("axis");
  EXPECT_EQ(again.number("rate", std::nullopt), rate);
  EXPECT_EQ(again.number("accel", std::nullopt), accel);
  EXPECT_EQ(second.resolved(), first.resolved());
}

}  // namespace
}  // namespace waverig::rig
