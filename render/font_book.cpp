#include "render/font_book.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include "lcmtypes/error.h"

namespace waverig::render {
namespace {

const char* const kFontFolder = "/usr/share/fonts/truetype/";  // of Debian's fonts-dejavu-core and
                                                               // fonts-nanum
constexpr float kLinePerEm = 1.164F;                           // DejaVu Sans, ascent + descent: what
                                                               // ImGui calls the size of a font

// Always baked, so that the common figure bakes once.
constexpr std::string_view kCommon =
    " !\"#$%&'()*+,-./"
    "0123456789:;<=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`"
    "abcdefghijklmnopqrstuvwxyz{|}~"
    "\u00B0\u00B1\u00B2\u00B3\u00B5\u00B7\u00D7\u2013\u2026\u2212\u221A\u2070"
    "\u00B9\u2074\u2075\u2076\u2077"
    "\u2078"
    "\u2079\u207B\u03B1\u03B2\u03B8\u03C3\u03C6\u03C8\u0394\u2264\u2265\uFFFD";

// Empty where there is no such file.
std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return {};
  std::string bytes(static_cast<std::size_t>(file.tellg()), '\0');
  file.seekg(0);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

constexpr ImWchar kReplacement = 0xFFFD;

// What DejaVu lacks: jamo, and from the radicals on. Its large font is read only where it is asked for.
bool is_east_asian(ImWchar c) { return (c >= 0x1100 && c < 0x1200) || (c >= 0x2E80 && c < kReplacement); }

}  // namespace

void for_each_character(std::string_view utf8, const std::function<void(ImWchar)>& f) {
  for (std::size_t i = 0; i < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[i]);
    const std::size_t length = lead < 0x80       ? 1
                               : lead >> 5 == 6  ? 2
                               : lead >> 4 == 14 ? 3
                               : lead >> 3 == 30 ? 4
                                                 : 0;
    unsigned code = length == 1 ? lead : length == 0 ? 0 : lead & (0xFFU >> (length + 1));
    bool good = length != 0 && i + length <= utf8.size();
    for (std::size_t k = 1; good && k < length; ++k) {
      const auto next = static_cast<unsigned char>(utf8[i + k]);
      good = next >> 6 == 2;
      code = code << 6 | (next & 0x3FU);
    }
    f(good && code <= 0xFFFF ? static_cast<ImWchar>(code) : kReplacement);
    i += good ? length : 1;
  }
}

FontBook::FontBook()
    : atlas_(std::make_unique<ImFontAtlas>()),
      regular_(content_of(std::string(kFontFolder) + "dejavu/DejaVuSans.ttf")),
      bold_(content_of(std::string(kFontFolder) + "dejavu/DejaVuSans-Bold.ttf")) {
  if (regular_.empty() || bold_.empty())
    throw UserError(std::string(kFontFolder) +
                    "dejavu: DejaVuSans.ttf and DejaVuSans-Bold.ttf expected "
                    "(Debian package fonts-dejavu-core)");
  require(kCommon);
}

FontBook::~FontBook() = default;

void FontBook::require(float size_px, bool bold) {
  stale_ |= fonts_.try_emplace({static_cast<int>(std::lround(size_px)), bold}, nullptr).second;
}

void FontBook::require(std::string_view utf8) {
  for_each_character(utf8, [this](ImWchar c) {
    stale_ |= characters_.insert(c).second;
    if (!is_east_asian(c) || asked_hangul_) return;
    asked_hangul_ = true;
    hangul_ = content_of(std::string(kFontFolder) + "nanum/NanumGothic.ttf");
    hangul_bold_ = content_of(std::string(kFontFolder) + "nanum/NanumGothicBold.ttf");
  });
}

bool FontBook::bake() {
  if (!stale_) return false;
  ranges_.clear();
  for (const ImWchar c : characters_) {
    if (c == 0) continue;  // ends a list of ranges
    if (!ranges_.empty() && ranges_.back() == c - 1) {
      ranges_.back() = c;
    } else {
      ranges_.push_back(c);
      ranges_.push_back(c);
    }
  }
  ranges_.push_back(0);
  atlas_->Clear();
  atlas_->Flags =
      ImFontAtlasFlags_NoMouseCursors | ImFontAtlasFlags_NoBakedLines | ImFontAtlasFlags_NoPowerOfTwoHeight;
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  config.OversampleH = config.OversampleV = 1;
  config.GlyphRanges = ranges_.Data;
  const auto add = [&](std::string& file, float line_px) {
    return atlas_->AddFontFromMemoryTTF(file.data(), static_cast<int>(file.size()), line_px, &config);
  };
  for (auto& [key, font] : fonts_) {
    const float em_px = static_cast<float>(key.size_px);
    config.MergeMode = false;
    font = add(key.bold ? bold_ : regular_, em_px * kLinePerEm);
    std::string& hangul = key.bold ? hangul_bold_ : hangul_;
    config.MergeMode = true;
    if (!hangul.empty()) add(hangul, em_px * kLinePerEm);
  }
  atlas_->Build();
  stale_ = false;
  return true;
}

const ImFont& FontBook::font(float size_px, bool bold) const {
  return *fonts_.at({static_cast<int>(std::lround(size_px)), bold});
}

float FontBook::width_px(std::string_view utf8, float size_px, bool bold) const {
  const ImFont& face = font(size_px, bold);
  float width = 0;
  for_each_character(utf8, [&](ImWchar c) { width += face.FindGlyph(c)->AdvanceX; });
  return width;
}

}  // namespace waverig::render
