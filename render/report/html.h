// The few pieces of HTML that reports are made of. Every text is escaped here
// and nowhere else.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace waverig::render {

std::string html_text(std::string_view text);  // escaped
std::string html_id(std::string_view text);    // letters, digits, '-', '_' and
                                               // '.'; anything else becomes '-'
std::string html_link(std::string_view href, std::string_view text);

// One cell of a table. A number carries its value for sorting; an unknown one
// is a dash and sorts last.
struct HtmlCell {
  std::string inner;  // HTML
  bool numeric = false;
  double value = 0;
  bool wraps = false;
};
HtmlCell text_cell(std::string_view text);
HtmlCell inner_cell(std::string html, bool wraps = false);
HtmlCell number_cell(double value, int decimals, std::string_view href = {});  // a link where href is given

class HtmlTable {
 public:
  // heads: column titles; numeric columns are told from the first row.
  HtmlTable(std::string caption, std::vector<std::string> heads)
      : caption_(std::move(caption)), heads_(std::move(heads)) {}
  void add_row(std::vector<HtmlCell> cells, std::string id = {});
  bool empty() const { return rows_.empty(); }
  enum class Caption { kShown, kHeard };  // kHeard: for screen readers alone, where a heading says the same
  std::string html(bool sortable = true) const { return html(Caption::kShown, sortable); }
  std::string html(Caption caption, bool sortable = true) const;

 private:
  struct Row {
    std::vector<HtmlCell> cells;
    std::string id;
  };
  std::string caption_;
  std::vector<std::string> heads_;
  std::vector<Row> rows_;
};

// A picture inside the page (base64), that opens large. Throws UserError where
// the file cannot be read.
std::string html_figure(const std::filesystem::path& png, std::string_view caption);

// A whole page: title, style, script and a policy that lets nothing come from
// outside.
std::string html_page(std::string_view title, std::string_view body);

}  // namespace waverig::render
