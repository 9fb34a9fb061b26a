// FontBook: DejaVu Sans regular and bold at the sizes a figure needs, Nanum
// Gothic behind it for Hangul. Glyphs are baked on demand and drawn on whole
// pixels, so that text is the same whatever was drawn before.
#pragma once
#include <imgui.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>

namespace waverig::render {

class FontBook {
 public:
  FontBook();  // throws UserError where the font files are missing
  ~FontBook();
  FontBook(const FontBook&) = delete;
  FontBook& operator=(const FontBook&) = delete;

  // Makes sure that size and the characters of the text are baked; may move
  // everything baked before.
  void require(float size_px, bool bold);
  void require(std::string_view utf8);
  // Bakes what require() asked for. True where the atlas changed and its
  // texture must be loaded again.
  bool bake();

  const ImFont& font(float size_px, bool bold) const;
  float width_px(std::string_view utf8, float size_px, bool bold = false) const;
  ImFontAtlas& atlas() { return *atlas_; }

 private:
  struct Key {
    int size_px;
    bool bold;
    auto operator<=>(const Key&) const = default;
  };
  std::unique_ptr<ImFontAtlas> atlas_;
  std::map<Key, ImFont*> fonts_;
  std::set<ImWchar> characters_;
  std::string regular_, bold_, hangul_, hangul_bold_;  // the files, whole
  bool asked_hangul_ = false;
  ImVector<ImWchar> ranges_;
  bool stale_ = true;
};

// Calls f(code point) for each character; malformed UTF-8 gives U+FFFD, code
// points above U+FFFF too.
void for_each_character(std::string_view utf8, const std::function<void(ImWchar)>& f);

// Height of a capital letter of DejaVu Sans, in em.
inline constexpr float kCapHeight = 0.729F;

}  // namespace waverig::render
