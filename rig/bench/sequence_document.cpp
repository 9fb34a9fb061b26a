#include "rig/bench/sequence_document.h"

namespace waverig::rig::bench {
namespace {

std::map<std::string, std::string> all_texts(TomlTable table) {
  std::map<std::string, std::string> fields;
  for (const std::string& key : table.keys()) fields[key] = table.text(key, {});
  return fields;
}

RawStep read_step(TomlTable& table, int retries) {
  RawStep step;
  step.place = table.place_of("");
  for (const char* key : {"set", "read", "wait", "until", "prompt", "for", "do", "value", "near", "within",
                          "hold", "poll", "timeout", "expect", "duration", "unattended", "on_failure"})
    if (table.has(key)) step.texts[key] = table.text(key, {});
  if (table.has("record")) {
    step.ports = table.texts("record", {});
    step.texts["record"] = step.ports.front();
  }
  if (table.has("channels")) step.channels = table.texts("channels", {});
  if (table.has("in")) step.in = table.texts("in", {});
  step.count = static_cast<int>(table.integer("count", 0, {0, 1e6}));
  step.retries = static_cast<int>(table.integer("retries", retries, {0, 100}));
  step.join = table.boolean("join", false);
  step.keep = table.boolean("keep", false);
  for (TomlTable& limit : table.tables("limits")) step.limits.push_back(all_texts(limit));
  step.tags = all_texts(table.table("tags"));
  return step;
}

}  // namespace

std::vector<RawStep> read_steps(TomlTable& table, std::string_view key, int retries) {
  std::vector<RawStep> steps;
  for (TomlTable& step : table.tables(key)) steps.push_back(read_step(step, retries));
  return steps;
}

Document read_document(TomlTable& root, int retries) {
  Document document;
  TomlTable lists = root.table("lists"), tables = root.table("tables");
  for (const std::string& name : lists.keys())
    for (const std::string& item : lists.texts(name, {})) document.lists[name].push_back({item, {}});
  for (const std::string& name : tables.keys()) {
    if (document.lists.contains(name)) tables.refuse(name, "a name that no list has");
    for (TomlTable& item : tables.tables(name)) {
      Variables fields;
      for (const std::string& key : item.keys()) fields[key] = item.text(key, {});
      document.lists[name].push_back({item.text("name", {}), std::move(fields)});
    }
  }
  TomlTable blocks = root.table("blocks");
  for (const std::string& name : blocks.keys()) document.blocks[name] = read_steps(blocks, name, retries);
  return document;
}

}  // namespace waverig::rig::bench
