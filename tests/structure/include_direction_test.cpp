// Who may know whom: DESIGN of the README's architecture section, checked on every #include of the tree.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {
namespace fs = std::filesystem;

// A part of the tree: the longest of these prefixes of a path.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"lcmtypes", {}},
    {"motion/kinematics", {"lcmtypes"}},
    {"motion", {"motion/kinematics", "lcmtypes"}},
    {"estimator", {"motion/kinematics", "lcmtypes"}},
    {"estimator/evaluation", {"estimator", "motion/kinematics", "lcmtypes"}},
    {"render", {"estimator/evaluation", "estimator", "motion/kinematics", "lcmtypes"}},
    {"rig", {"render", "estimator/evaluation", "estimator", "motion", "motion/kinematics", "lcmtypes"}},
};

std::string part_of(const std::string& path) {
  std::string best;
  for (const auto& [part, allowed] : kMayInclude)
    if (path.starts_with(part + "/") && part.size() > best.size()) best = part;
  return best;
}

std::string violations(const std::string& path, std::istream& source) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s+"([^"]+)")re");
  const std::string from = part_of(path);
  std::string found, line;
  for (int number = 1; std::getline(source, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, kInclude)) continue;
    const std::string to = part_of(match[1]);
    if (!to.empty() && to != from && !kMayInclude.at(from).contains(to))
      found += path + ":" + std::to_string(number) + ": " + from + " must not include " + to + "\n";
  }
  return found;
}

TEST(Tree, IncludesOnlyInTheDirectionOfTheData) {
  const fs::path root = WAVERIG_SOURCE_DIR;
  std::string found;
  int files = 0;
  for (const auto& [part, allowed] : kMayInclude) {
    if (part.find('/') != std::string::npos) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / part)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream source(entry.path());
      found += violations(fs::relative(entry.path(), root).string(), source);
      ++files;
    }
  }
  EXPECT_GT(files, 50);
  EXPECT_EQ(found, "");
}

TEST(Tree, CheckSeesAnIncludeAgainstTheDirection) {
  std::istringstream source("#include <vector>\n#include \"rig/version.h\"\n");
  EXPECT_NE(violations("estimator/method.cpp", source), "");
  std::istringstream truth("#include \"motion/sea_state.h\"\n");
  EXPECT_NE(violations("estimator/heave/realtime.cpp", truth), "");
}

TEST(Tree, TopLevelStaysSmall) {
  const std::set<std::string> allowed = {"CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "rig",  "motion",
                                         "estimator",      "render",            "lcmtypes", "tests",    "build", "results"};
  for (const auto& entry : fs::directory_iterator(WAVERIG_SOURCE_DIR)) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name.starts_with(".") || name.starts_with("build") || allowed.contains(name)) << name;
  }
}

}  // namespace
