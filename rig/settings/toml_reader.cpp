#include "rig/settings/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

std::string shown(const toml::node& node) {
  std::ostringstream out;
  node.visit([&](const auto& n) { out << n; });
  std::string text = out.str();
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text.size() > 60 ? text.substr(0, 57) + "…" : text;
}

std::string shown(const Range& range, std::string_view kind = "number") {
  if (std::isinf(range.low) && std::isinf(range.high))
    return fmt::format("a {}{}", kind == "number" ? "finite " : "", kind);
  if (std::isinf(range.high)) return fmt::format("a {} of at least {}", kind, range.low);
  if (std::isinf(range.low)) return fmt::format("a {} of at most {}", kind, range.high);
  return fmt::format("a {} from {} to {}", kind, range.low, range.high);
}

bool inside(double value, const Range& range) {
  return std::isfinite(value) && value >= range.low && value <= range.high;
}

// How many letters apart two keys are (Levenshtein): a key that is missing was perhaps only misspelt.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j)
      diagonal = std::exchange(row[j + 1],
                               std::min({diagonal + (a[i] == b[j] ? 0U : 1U), row[j] + 1, row[j + 1] + 1}));
  }
  return row.back();
}

std::string missing(const toml::table* table, std::string_view key, std::string_view expected) {
  std::string misspelt;
  if (table != nullptr)
    for (const auto& [other, node] : *table)
      if (distance(key, other.str()) <= 2)
        misspelt = fmt::format(" (line {} has {})", node.source().begin.line, other.str());
  return fmt::format("is missing{}: expected {}", misspelt, expected);
}

}  // namespace

bool TomlTable::has(std::string_view key) const {
  return shared_->node != nullptr && shared_->node->contains(key);
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  if (shared_->node != nullptr)
    for (const auto& [key, node] : *shared_->node) names.emplace_back(key.str());
  return names;
}

const toml::node* TomlTable::find(std::string_view key) {
  shared_->asked.emplace(key);
  return shared_->node == nullptr ? nullptr : shared_->node->get(key);
}

std::string TomlTable::name_of(std::string_view key) const { return shared_->prefix + std::string(key); }

std::string TomlTable::place_of(std::string_view key) const {
  const toml::node* node = shared_->node == nullptr ? nullptr : shared_->node->get(key);
  return fmt::format("{}:{}", shared_->file, node == nullptr ? shared_->line : node->source().begin.line);
}

void TomlTable::refuse(std::string_view key, std::string_view expected) const {
  const toml::node* node = shared_->node == nullptr ? nullptr : shared_->node->get(key);
  if (node == nullptr)
    throw UserError(
        fmt::format("{}: {} {}", place_of(key), name_of(key), missing(shared_->node, key, expected)));
  throw UserError(
      fmt::format("{}: {} = {}: expected {}", place_of(key), name_of(key), shown(*node), expected));
}

namespace {

toml::array toml_of(const auto& values) {
  toml::array array;
  for (const auto& value : values) array.push_back(value);
  return array;
}

}  // namespace

template <class Value>
Value TomlTable::resolve(std::string_view key, Value value) {
  if constexpr (requires { value.begin(); } && !std::is_same_v<Value, std::string>)
    shared_->resolved->insert_or_assign(key, toml_of(value));
  else
    shared_->resolved->insert_or_assign(key, value);
  return value;
}

void TomlTable::say(std::string_view key, const std::string& value) { resolve(key, value); }

double TomlTable::number(std::string_view key, std::optional<double> fallback, Range range) {
  const toml::node* node = find(key);
  if (node == nullptr && fallback) return resolve(key, *fallback);
  if (node == nullptr || !node->is_number()) refuse(key, shown(range));
  const double value = *node->value<double>();
  if (!inside(value, range)) refuse(key, shown(range));
  return resolve(key, value);
}

std::int64_t TomlTable::integer(std::string_view key, std::optional<std::int64_t> fallback, Range range) {
  const toml::node* node = find(key);
  const auto expected = [&] { return shown(range, "whole number"); };
  if (node == nullptr && fallback) return resolve(key, *fallback);
  if (node == nullptr || !node->is_integer()) refuse(key, expected());
  const std::int64_t value = *node->value<std::int64_t>();
  if (!inside(static_cast<double>(value), range)) refuse(key, expected());
  return resolve(key, value);
}

bool TomlTable::boolean(std::string_view key, std::optional<bool> fallback) {
  const toml::node* node = find(key);
  if (node == nullptr && fallback) return resolve(key, *fallback);
  if (node == nullptr || !node->is_boolean()) refuse(key, "true or false");
  return resolve(key, *node->value<bool>());
}

std::string TomlTable::text(std::string_view key, std::optional<std::string> fallback) {
  const toml::node* node = find(key);
  if (node == nullptr && fallback) return resolve(key, *fallback);
  if (node == nullptr || !node->is_string()) refuse(key, "a text in quotes");
  return resolve(key, *node->value<std::string>());
}

std::string TomlTable::choice(std::string_view key, std::optional<std::string> fallback,
                              const std::vector<std::string>& allowed) {
  const toml::node* node = find(key);
  if (node == nullptr && fallback) return resolve(key, *fallback);
  if (node != nullptr && node->is_string()) {
    const std::string value = *node->value<std::string>();
    for (const auto& a : allowed)
      if (value == a) return resolve(key, value);
  }
  refuse(key, fmt::format("one of \"{}\"", fmt::join(allowed, "\", \"")));
}

std::vector<double> TomlTable::numbers(std::string_view key, std::optional<std::vector<double>> fallback,
                                       Range range) {
  const toml::node* node = find(key);
  const auto expected = [&] { return "a list with at least one number, each " + shown(range); };
  if (node == nullptr && fallback) return resolve(key, *fallback);
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr || array->empty()) refuse(key, expected());
  std::vector<double> values;
  for (const toml::node& element : *array) {
    if (!element.is_number() || !inside(*element.value<double>(), range)) refuse(key, expected());
    values.push_back(*element.value<double>());
  }
  return resolve(key, values);
}

std::vector<std::string> TomlTable::texts(std::string_view key,
                                          std::optional<std::vector<std::string>> fallback) {
  const toml::node* node = find(key);
  const char* expected = "a list with at least one text in quotes";
  if (node == nullptr && fallback) return resolve(key, *fallback);
  const toml::array* array = node == nullptr ? nullptr : node->as_array();
  if (array == nullptr || array->empty()) refuse(key, expected);
  std::vector<std::string> values;
  for (const toml::node& element : *array) {
    if (!element.is_string()) refuse(key, expected);
    values.push_back(*element.value<std::string>());
  }
  return resolve(key, values);
}

TomlTable TomlTable::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_table()) refuse(key, "a table");
  auto child = std::make_shared<Shared>();
  child->node = node == nullptr ? nullptr : node->as_table();
  child->file = shared_->file;
  child->prefix = name_of(key) + ".";
  child->line = node == nullptr ? shared_->line : node->source().begin.line;
  shared_->resolved->insert_or_assign(key, toml::table{});
  child->resolved = shared_->resolved->get_as<toml::table>(key);
  shared_->children.push_back(child);
  return TomlTable(std::move(child));
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  std::vector<TomlTable> result;
  const toml::node* node = find(key);
  if (node == nullptr) return result;
  const toml::array* array = node->as_array();
  if (array == nullptr) refuse(key, "a list of tables");
  shared_->resolved->insert_or_assign(key, toml::array{});
  toml::array* resolved = shared_->resolved->get_as<toml::array>(key);
  std::size_t index = 0;
  for (const toml::node& element : *array) {
    if (!element.is_table()) refuse(key, "a list of tables");
    auto child = std::make_shared<Shared>();
    child->node = element.as_table();
    child->file = shared_->file;
    child->prefix = fmt::format("{}[{}].", name_of(key), index++);
    child->line = element.source().begin.line;
    resolved->push_back(toml::table{});
    child->resolved = resolved->back().as_table();
    shared_->children.push_back(child);
    result.push_back(TomlTable(std::move(child)));
  }
  return result;
}

void TomlTable::refuse_unknown_keys() const { refuse_unknown(*shared_); }

void TomlTable::refuse_unknown(const Shared& shared) {
  if (shared.node == nullptr) return;
  for (const auto& [key, node] : *shared.node)
    if (!shared.asked.contains(key.str()))
      throw UserError(fmt::format("{}:{}: {}{} = {}: unknown key; expected one of {}", shared.file,
                                  node.source().begin.line, shared.prefix, key.str(), shown(node),
                                  fmt::join(shared.asked, ", ")));
  for (const auto& child : shared.children) refuse_unknown(*child);
}

TomlFile::TomlFile(const std::filesystem::path& path)
    : TomlFile(content_of(path, "a TOML file"), path.string()) {}

TomlFile::TomlFile(std::string_view text, const std::string& name) {
  try {
    document_ = std::make_unique<toml::table>(toml::parse(text, name));
  } catch (const toml::parse_error& error) {
    throw UserError(
        fmt::format("{}:{}: {}; expected TOML", name, error.source().begin.line, error.description()));
  }
  resolved_ = std::make_unique<toml::table>();
  auto shared = std::make_shared<TomlTable::Shared>();
  shared->resolved = resolved_.get();
  shared->node = document_.get();
  shared->file = name;
  root_.reset(new TomlTable(std::move(shared)));
}

std::string TomlFile::resolved() const {
  std::ostringstream text;
  text << *resolved_ << "\n";
  return text.str();
}

}  // namespace waverig::rig
