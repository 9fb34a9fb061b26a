#include "render/report/html.h"

#include <fmt/format.h>

#include <cmath>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "render/report/report_assets.h"
#include "render/svg_painter.h"
#include "render/ticks.h"

namespace waverig::render {
namespace {

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<unsigned>(static_cast<unsigned char>(bytes[i + k])) : 0U;
    };
    const unsigned bits = byte(0) << 16U | byte(1) << 8U | byte(2);
    for (unsigned k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63U];
  }
  return out;
}

}  // namespace

std::string html_text(std::string_view text) { return xml_escaped(text); }

std::string html_id(std::string_view text) {
  std::string id(text);
  for (char& c : id) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_' || c == '.';
    if (!plain) c = '-';
  }
  return id;
}

std::string html_link(std::string_view href, std::string_view text) {
  return fmt::format("<a href=\"{}\">{}</a>", html_text(href), html_text(text));
}

HtmlCell text_cell(std::string_view text) { return {.inner = html_text(text)}; }
HtmlCell inner_cell(std::string html, bool wraps) { return {.inner = std::move(html), .wraps = wraps}; }

HtmlCell number_cell(double value, int decimals, std::string_view href) {
  if (!std::isfinite(value)) return {.inner = "\u2013", .numeric = true, .value = value};
  const std::string text = number_text(value, decimals);
  return {.inner = href.empty() ? text : html_link(href, text), .numeric = true, .value = value};
}

void HtmlTable::add_row(std::vector<HtmlCell> cells, std::string id) {
  rows_.push_back({std::move(cells), std::move(id)});
}

std::string HtmlTable::html(Caption caption, bool sortable) const {
  // The caption stands outside, so that it does not scroll away with a wide table.
  std::string out;
  if (caption == Caption::kShown) out = fmt::format("<p class=\"caption\">{}</p>\n", html_text(caption_));
  out += fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\"><table{}>\n<thead><tr>",
      html_text(caption_), sortable ? " class=\"sortable\"" : "");
  for (std::size_t c = 0; c < heads_.size(); ++c) {
    const bool numeric = !rows_.empty() && c < rows_.front().cells.size() && rows_.front().cells[c].numeric;
    out += fmt::format("<th scope=\"col\"{}>{}</th>", numeric ? "" : " class=\"text\"", html_text(heads_[c]));
  }
  out += "</tr></thead>\n<tbody>\n";
  for (const Row& row : rows_) {
    out += row.id.empty() ? "<tr>" : fmt::format("<tr id=\"{}\">", html_text(row.id));
    for (const HtmlCell& cell : row.cells) {
      if (cell.numeric)
        out += fmt::format("<td data-value=\"{}\">{}</td>",
                           std::isfinite(cell.value) ? fmt::format("{:.9g}", cell.value) : "NaN", cell.inner);
      else
        out += fmt::format("<td class=\"text{}\">{}</td>", cell.wraps ? " wrap" : "", cell.inner);
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string html_figure(const std::filesystem::path& png, std::string_view caption) {
  const std::string bytes = content_of(png, "a PNG picture");
  if (bytes.size() < 24) throw UserError(png.string() + ": a PNG picture expected");
  const auto u32 = [&](std::size_t at) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < 4; ++k) v = v << 8U | static_cast<unsigned char>(bytes[at + k]);
    return v;
  };
  return fmt::format(
      "<figure><div class=\"view\"><button type=\"button\" title=\"Open "
      "large\"><img alt=\"{}\" width=\"{}\" height=\"{}\" "
      "src=\"data:image/png;base64,{}\"></button></div>"
      "<figcaption>{}</figcaption></figure>\n",
      html_text(caption), u32(16), u32(20), base64(bytes), html_text(caption));
}

std::string html_page(std::string_view title, std::string_view body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, "
      "initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
      "'none'; img-src data:; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n</"
      "head>\n<body>\n{}<script>\n{}</script>\n</body>\n</html>\n",
      html_text(title), kReportStyle, body, kReportScript);
}

}  // namespace waverig::render
