// Strict reading of TOML settings: every complaint is one sentence that names file, line, key, value and what
// was expected, and a key that nobody asked for is a complaint too.
//
//   TomlFile file(path);
//   TomlTable rig = file.root().table("rig");
//   settings.radius_max_m = rig.number("radius_max_m", settings.radius_max_m, {0.05, 5.0});
//   file.root().refuse_unknown_keys();        // recursive: call it last
#pragma once
#include <toml++/toml.h>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace waverig::rig {

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

class TomlTable {
 public:
  bool has(std::string_view key) const;
  std::vector<std::string> keys() const;  // in the order of the alphabet

  // Each returns the value of the key, or the fallback where the key is absent; throws UserError where the
  // value has another type or lies outside the range.
  double number(std::string_view key, std::optional<double> fallback, Range range = {});
  std::int64_t integer(std::string_view key, std::optional<std::int64_t> fallback, Range range = {});
  bool boolean(std::string_view key, std::optional<bool> fallback);
  std::string text(std::string_view key, std::optional<std::string> fallback);
  std::string choice(std::string_view key, std::optional<std::string> fallback,
                     const std::vector<std::string>& allowed);
  std::vector<double> numbers(std::string_view key, std::optional<std::vector<double>> fallback,
                              Range range = {});
  std::vector<std::string> texts(std::string_view key, std::optional<std::vector<std::string>> fallback);

  // What the resolved text shall say of a key instead of the value that was read, e.g. where a file has been
  // copied to.
  void say(std::string_view key, const std::string& value);

  // The table of that key; an empty one where it is absent.
  TomlTable table(std::string_view key);
  // The array of tables of that key, [[key]]; empty where it is absent.
  std::vector<TomlTable> tables(std::string_view key);

  // Throws UserError at the first key of this table, or of a table taken from it, that was not asked for.
  void refuse_unknown_keys() const;

  // Throws UserError about a key's value: "FILE:LINE: key = value: expected …".
  [[noreturn]] void refuse(std::string_view key, std::string_view expected) const;
  std::string name_of(std::string_view key) const;   // dotted, from the file's root
  std::string place_of(std::string_view key) const;  // "FILE:LINE"

 private:
  friend class TomlFile;
  struct Shared {  // what was asked for, per table, for the recursive check
    const toml::table* node = nullptr;
    std::string file, prefix;
    std::uint32_t line = 1;
    toml::table* resolved = nullptr;
    std::set<std::string, std::less<>> asked;
    std::vector<std::shared_ptr<Shared>> children;
  };
  explicit TomlTable(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}
  const toml::node* find(std::string_view key);
  static void refuse_unknown(const Shared& shared);
  template <class Value>
  Value resolve(std::string_view key, Value value);

  std::shared_ptr<Shared> shared_;
};

class TomlFile {
 public:
  explicit TomlFile(const std::filesystem::path& path);      // throws UserError
  TomlFile(std::string_view text, const std::string& name);  // the text itself, for tests and stored settings
  TomlTable& root() { return *root_; }
  // Replaces a value of the root before it is read, as a command-line option does.
  void set(std::string_view key, std::int64_t value) { document_->insert_or_assign(key, value); }
  // All that was asked for so far with the value it has, fallbacks included, as TOML: reading it gives the
  // same again.
  std::string resolved() const;

 private:
  std::unique_ptr<toml::table> document_, resolved_;
  std::unique_ptr<TomlTable> root_;
};

}  // namespace waverig::rig
