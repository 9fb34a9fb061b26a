// What stands in a sequence file, before loops are unfolded: lists, and steps by block.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rig/settings/toml_reader.h"

namespace waverig::rig::bench {

using Variables = std::map<std::string, std::string>;  // of the loops around a step, by name

// One step as it stands in the file.
struct RawStep {
  std::string place;  // FILE:LINE
  std::map<std::string, std::string> texts;
  std::vector<std::string> channels, ports, in;
  std::vector<std::map<std::string, std::string>> limits;
  std::map<std::string, std::string> tags;
  bool join = false, keep = false;
  int count = 0, retries = 0;
  bool has(const std::string& key) const { return texts.contains(key); }
};

struct ListItem {
  std::string name;
  Variables fields;
};

struct Document {
  std::map<std::string, std::vector<ListItem>> lists;
  std::map<std::string, std::vector<RawStep>> blocks;
};

// retries: of a step that does not say. Throws UserError naming file, line, key, value and what was expected.
std::vector<RawStep> read_steps(TomlTable& table, std::string_view key, int retries);
Document read_document(TomlTable& root, int retries);

}  // namespace waverig::rig::bench
